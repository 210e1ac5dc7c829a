"""Several methods on one case: a row for each whatever it does, and one scale for all."""

import numpy as np
import pytest
from stand_ins import STAND_INS, only_stand_ins

from cranio_nb.errors import InputRefused
from cranio_nb.methods import catalogue
from cranio_nb.pipeline import compare, trial
from cranio_nb.pipeline.trial import Contender, attempt, attempt_apart, contenders
from cranio_nb.prosthesis import Prosthesis
from cranio_nb.stages.surface_reconstruction import extract_surface


@pytest.fixture
def stand_ins():
    with only_stand_ins():
        yield


class TestComparison:
    def test_every_contender_is_a_row_whatever_it_does(self, found):
        assert {t.contender.name: t.status for t in found.trials} == {
            "perfect": "done",
            "moved": "done",
            "refusing": "refused",
            "finding_nothing": "no patch",
            "faulty": "broken",
        }
        assert [t.message for t in found.trials[2:]] == [
            "The other side <is> open, too. Try another.",
            "Nothing was bridged.",
            "Something unforeseen went wrong in the method (IndexError).",
        ]
        assert len(found.rows) == len(found.trials)
        assert all(set(row) == set(compare.MEASURES) for row in found.rows)
        assert all(np.isnan(list(row.values())).all() for row in found.rows[2:])

    def test_the_truth_scores_as_the_truth(self, found):
        row = found.rows[0]
        assert row["dice"] == row["border_dice"] == row["volume_ratio"] == 1
        assert row["hd95"] == row["assd"] == row["overlap"] == 0
        assert [row[k] for k in ("thickness_rmse", "top_mean", "inner_mean")] == pytest.approx([0, 0, 0], abs=1e-6)
        moved = found.rows[1]
        assert moved["dice"] < 1 and moved["top_mean"] > 0.1 and np.isfinite(list(moved.values())).all()

    def test_distances_are_to_the_truth_and_share_one_scale(self, found):
        assert found.reference == "truth" and set(found.distances) == {"perfect", "moved"}
        every = np.concatenate([d for sides in found.distances.values() for d in sides.values()])
        assert np.percentile(every, 99) <= found.top and found.top % 0.5 == 0
        assert np.percentile(every, 99) > found.top - 0.5 or found.top == 0.5

    def test_without_a_truth_the_first_that_made_something_is_the_reference(self, blind):
        assert blind.reference == "moved" and set(blind.distances) == {"perfect"}
        assert all(np.isnan(row["dice"]) for row in blind.rows) and blind.rows[0]["volume"] > 0

    def test_agreement_of_each_two(self, found):
        assert set(found.pairs) == {("perfect", "moved")}
        assert found.pairs["perfect", "moved"] == pytest.approx((found.rows[1]["dice"], found.rows[1]["assd"]))

    def test_progress_names_each(self, compared_case, stand_ins):
        told = []
        compare.compare(
            compared_case,
            contenders(["refusing", "faulty"]),
            attempt=attempt,
            progress=lambda *told_now: told.append(told_now),
        )
        assert told == [("refusing", 0.0), ("faulty", 0.5)]


class TestContenders:
    def test_by_name_once_each(self):
        assert contenders(["slicewise:paper", "slicewise", "slicewise"]) == (
            Contender("slicewise", "paper"),
            Contender("slicewise"),
        )
        assert [c.name for c in contenders(["slicewise:paper"])] == ["slicewise:paper"]

    def test_all_by_default_with_the_papers_preset_where_there_is_one(self):
        names = [c.name for c in contenders()]
        assert set(catalogue.METHODS) <= set(names) and "slicewise:paper" in names

    @pytest.mark.parametrize("name", ["magic", "slicewise:best", ":paper"])
    def test_unknown_names_are_refused(self, name):
        with pytest.raises(InputRefused, match="There is no"):
            contenders([name])


def test_a_patch_that_runs_out_of_the_image_is_a_failure_and_no_refusal(compared_case, monkeypatch):
    def leaking(bone, openings=None, *, progress=None):
        patch = np.zeros(bone.shape, bool)
        patch[-1] = True
        return Prosthesis(
            extract_surface(bone.with_voxels(patch)), np.zeros(0, np.uint8), bone.with_voxels(patch), "leaking"
        )

    monkeypatch.setitem(STAND_INS, "perfect", leaking)
    with only_stand_ins():
        assert attempt(compared_case.bone, compared_case.openings, Contender("perfect")).status == "no patch"


class TestApart:
    def test_is_the_same_design_and_does_not_count_what_this_process_holds(self, compared_case):
        here = attempt(compared_case.bone, compared_case.openings, Contender("slicewise", "paper"))
        ballast = np.ones(50_000_000)  # 400 MB
        apart = attempt_apart(compared_case.bone, compared_case.openings, Contender("slicewise", "paper"))
        np.testing.assert_array_equal(apart.prosthesis.patch.voxels, here.prosthesis.patch.voxels)
        np.testing.assert_array_equal(apart.prosthesis.mesh.vertices, here.prosthesis.mesh.vertices)
        assert apart.prosthesis.parameters == here.prosthesis.parameters
        assert 20 < apart.memory < trial.peak_memory() - 100 and ballast.nbytes == 4e8

    def test_a_refusal_comes_back_as_a_sentence(self, compared_case):
        whole = compared_case.bone.with_voxels(np.zeros(compared_case.bone.shape, bool))
        apart = attempt_apart(whole, compared_case.openings, Contender("slicewise"))
        assert apart.status != "done" and apart.prosthesis is None and apart.message.endswith(".")


def test_heads_for_little_room_tell_columns_apart():
    heads = [what.short for what in compare.MEASURES.values()]
    assert len(set(heads)) == len(heads) and max(map(len, heads)) <= 5
