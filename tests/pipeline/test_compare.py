"""Several methods on one case: a row for each whatever it does, and one scale for all."""

import numpy as np
import pytest
from stand_ins import only_stand_ins

from cranio_nb.pipeline import compare
from cranio_nb.pipeline.trial import attempt, contenders


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


def test_heads_for_little_room_tell_columns_apart():
    heads = [what.short for what in compare.MEASURES.values()]
    assert len(set(heads)) == len(heads) and max(map(len, heads)) <= 5
