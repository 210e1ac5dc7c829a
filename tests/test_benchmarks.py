"""What the benchmarks on many skulls share, and the list of cuts."""

import argparse
from pathlib import Path

import numpy as np
import pytest
from benchmark_scripts import script
from studies import columns

pytest.importorskip("pyarrow", reason="the extra `study` is not installed")

from cranio_nb.errors import InputRefused
from cranio_nb.pipeline.trial import Contender
from data_synth import DEFECTS

cohort = script("cohort")
defects = script("defects")
skullfix = script("skullfix")


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


class TestPrint:
    def test_says_mean_sd_and_worst_and_each_fault(self, cohort, capsys):
        ends, names = ["done", "done", "broken"], ["one", "one", "two"]
        rows = columns(
            3, dice=[0.5, 0.7, np.nan], contender=names, status=ends, code=["", "", "Oops"], message="It broke."
        )
        cohort.print_summary(rows, ("dice",))
        said = capsys.readouterr().out
        assert "-- one: 2 done, 0 failed, 0 refused" in said and "0.600     0.100     0.500" in said
        assert "a, two: broken (Oops): It broke." in said


def test_skullfix_cases_are_the_folders_with_both_masks(skullfix, tmp_path):
    for name in ("001", "000"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "defective.nrrd").touch()
    found = skullfix.cases(tmp_path)
    assert [case.source["truth"] for case in found] == ["000/implant.nrrd", "001/implant.nrrd"]
    assert all(case.source["mask"] for case in found)


class TestCuts:
    def test_follow_one_rule_over_all_skulls(self, defects):
        skulls = [Path(f"{n:03d}.nrrd") for n in range(30)]
        made = defects.cuts(skulls)
        assert len(made) == 76 and len({case.name for case in made}) == 76
        assert {case.source["path"] for case in made} == {s.name for s in skulls}
        assert {case.facts["defect"] for case in made} == set(DEFECTS) - {"partial", "round"}
        sized = {(case.facts["defect"], case.facts["asked_mm"]) for case in made[:60]}
        assert sized == {(p, s) for p in defects.PLACES for s in defects.SIZES}
        assert [case.name for case in defects.cuts(skulls)] == [case.name for case in made]

    def test_plot_names_its_axes_with_units(self, defects):
        places, ends = ["frontal", "frontal", "vertex"], ["done", "done", "no patch"]
        sizes, names = [40.0, 40.0, 60.0], ["one", "two", "two"]
        rows = columns(3, dice=[0.9, 0.9, np.nan], assd=0.5, hd95=1.0, contender=names, defect=places, asked_mm=sizes)
        axes = defects.figure(rows | {"status": np.array(ends, object)}).axes
        assert [ax.get_ylabel() for ax in axes[::2]] == ["DSC", "ASSD (mm)", "HD95 (mm)"]
        assert all("(mm)" in ax.get_xlabel() for ax in axes[::2])
        assert axes[0].lines[1].get_ydata()[1] == pytest.approx(0.9) and axes[0].lines[3].get_ydata()[2] == 0
