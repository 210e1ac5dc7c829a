"""The helpers of the benchmarks: nothing is designed twice, and means are what they say."""

import argparse
import math
from pathlib import Path

import numpy as np
import pytest
from benchmark_scripts import script

from cranio_nb.errors import InputRefused
from cranio_nb.pipeline.compare import MEASURES
from cranio_nb.pipeline.trial import Contender, Trial, attempt
from cranio_nb.volume import Volume
from data_synth import DEFECTS, phantom_case

cohort = script("cohort")
defects = script("defects")


def load(defect):
    case = phantom_case("tiny", defect, 0)
    return Volume(case.bone, case.affine), Volume(case.implant, case.affine)


def no_skull(_):
    raise ValueError("There is no bone in this scan.")


PAPER = Contender("slicewise", "paper")


@pytest.fixture
def cases(cohort):
    return [cohort.Case(name, load, (name,), {"place": name}) for name in ("unilateral", "burr_hole")]


@pytest.fixture
def counted():
    """An attempt that counts; burr holes are refused."""
    tried = []

    def run(bone, openings, contender):
        tried.append(contender.name)
        if len(tried) % 2:
            return attempt(bone, openings, contender)
        return Trial(contender, "refused", None, "TooSmall", "It is too small, or so.", 0.0, 0.0, 0.0)

    return run, tried


class TestResuming:
    def test_what_is_done_is_not_done_again(self, cohort, cases, counted, tmp_path):
        run, tried = counted
        path = tmp_path / "new" / "rows.csv"
        first = cohort.run_cohort(cases, [PAPER], path, attempt=run)
        assert [row["status"] for row in first] == ["done", "refused"] and len(tried) == 2
        before = path.read_bytes()
        again = cohort.run_cohort(cases, [PAPER], path, attempt=run)
        assert len(tried) == 2 and path.read_bytes() == before
        assert [cohort.key_of(row) for row in again] == [cohort.key_of(row) for row in first]
        assert again[0]["dice"] == first[0]["dice"] > 0.3 and again[0]["place"] == "unilateral"

    @pytest.mark.parametrize("other", ["options", "version", "case"])
    def test_other_options_versions_and_cases_are_new(self, other, cohort, cases, counted, tmp_path, monkeypatch):
        run, tried = counted
        path, asked = tmp_path / "rows.csv", PAPER
        cohort.run_cohort(cases[:1], [asked], path, attempt=run)
        if other == "version":
            monkeypatch.setattr(cohort, "version_of", lambda method: "0+changed")
        if other == "options":
            asked = Contender("slicewise", "paper", {"n_snaxels": 31})
        rows = cohort.run_cohort(cases[1:] if other == "case" else cases[:1], [asked], path, attempt=run)
        assert len(tried) == 2 and len(rows) == 1 and len(cohort.read_rows(path)) == 2

    def test_a_case_that_cannot_be_made_is_a_row(self, cohort, tmp_path):
        bad = [cohort.Case("bad", no_skull, (0,), {})]
        (row,) = cohort.run_cohort(bad, [PAPER], tmp_path / "rows.csv")
        assert (row["status"], row["message"]) == ("no patch", "There is no bone in this scan.")

    def test_a_file_of_another_kind_is_left_alone(self, cohort, cases, tmp_path):
        (tmp_path / "mine.csv").write_text("a,b\n1,2\n")
        with pytest.raises(SystemExit, match="other columns"):
            cohort.run_cohort(cases, [PAPER], tmp_path / "mine.csv")
        assert (tmp_path / "mine.csv").read_text() == "a,b\n1,2\n"

    def test_version_follows_the_source(self, cohort):
        release, digest = cohort.version_of("slicewise").split("+")
        assert release and len(digest) == 8


def row(status="done", **values):
    return {"status": status, **dict.fromkeys(MEASURES, math.nan), **values}


class TestSummary:
    def test_mean_deviation_and_worst_in_closed_form(self, cohort):
        rows = [row(dice=d, hd95=h, volume_ratio=v) for d, h, v in ((0.9, 1.0, 1.1), (0.8, 4.0, 0.7), (0.7, 1.0, 1.2))]
        found = cohort.summary(rows)
        assert found["dice"] == pytest.approx((0.8, math.sqrt(0.02 / 3), 0.7))
        assert found["hd95"] == pytest.approx((2.0, math.sqrt(2.0), 4.0))
        assert found["volume_ratio"] == pytest.approx((1.0, math.sqrt(0.14 / 3), 0.7))
        assert np.isnan(found["assd"]).all()

    def test_a_failure_counts_as_no_overlap_and_a_refusal_not_at_all(self, cohort):
        rows = [row(dice=0.8, hd95=2.0), row("no patch"), row("broken"), row("refused")]
        found = cohort.summary(rows)
        assert found["dice"] == pytest.approx((0.8 / 3, math.sqrt(2 / 9) * 0.8, 0.0))
        assert found["hd95"] == (2.0, 0.0, 2.0)
        assert cohort.counts(rows) == "1 done, 2 failed, 1 refused"


class TestContenders:
    def test_options_go_to_those_that_have_them(self, cohort):
        asked = argparse.Namespace(methods=["slicewise", "slicewise:paper"], options={"directions": 2}, prior="file")
        assert cohort.contenders_of(asked) == [
            Contender("slicewise", "default", {"directions": 2}),
            Contender("slicewise", "paper", {"directions": 2}),
        ]

    @pytest.mark.parametrize("options", [{"direction": 2}, {"directions": "many"}], ids=str)
    def test_options_that_no_method_has_are_refused(self, options, cohort):
        asked = argparse.Namespace(methods=["slicewise"], options=options, prior=None)
        with pytest.raises((SystemExit, InputRefused), match="direction"):
            cohort.contenders_of(asked)


class TestCuts:
    def test_follow_one_rule_over_all_skulls(self, defects):
        skulls = [Path(f"{n:03d}.nrrd") for n in range(30)]
        made = defects.cuts(skulls)
        assert len(made) == 76 and len({case.name for case in made}) == 76
        assert {case.arguments[0] for case in made} == {str(s) for s in skulls}
        assert {case.facts["place"] for case in made} == set(DEFECTS) - {"partial", "round"}
        sized = {(case.facts["place"], case.facts["asked_mm"]) for case in made[:60]}
        assert sized == {(p, s) for p in defects.PLACES for s in defects.SIZES}
        assert [case.name for case in defects.cuts(skulls)] == [case.name for case in made]

    def test_plot_names_its_axes_with_units(self, defects):
        rows = [
            row(dice=0.9, assd=0.5, hd95=1.0, contender=name, place="frontal", asked_mm="40") for name in ("one", "two")
        ]
        axes = defects.figure([*rows, row("no patch", contender="two", place="vertex", asked_mm="60")]).axes
        assert [ax.get_ylabel() for ax in axes[::2]] == ["DSC", "ASSD (mm)", "HD95 (mm)"]
        assert all("(mm)" in ax.get_xlabel() for ax in axes[::2])
        assert axes[0].lines[1].get_ydata()[1] == pytest.approx(0.9) and axes[0].lines[3].get_ydata()[2] == 0
