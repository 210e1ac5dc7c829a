"""The command `score` gives the numbers that `design --truth` gave, from whatever the skull is read."""

import json

import numpy as np
import pytest
from cli_runs import assert_refused, cranio

from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.volume import Volume


def measured(out):
    """Scores that `design --truth` put into design.json."""
    return json.loads((out / "design.json").read_text())["measures"]["score"]


def scored(patch, truth, skull, *more):
    """Scores that `score --json` prints."""
    result = cranio("score", patch, truth, "--skull", skull, "--json", *more)
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def test_of_a_ct_they_are_exactly_those_of_the_design(done, home):
    assert scored(done / "patch.nii.gz", home / "truth.nii.gz", home / "ct") == measured(done)


def test_at_a_threshold_they_are_exactly_those_of_the_design(home, tmp_path):
    truth, asked = home / "truth.nii.gz", ("--threshold", 700)
    made = cranio("design", home / "ct", "--method", "hull", *asked, "--truth", truth, "--out", tmp_path / "out")
    assert made.exit_code == 0, made.output
    patch = tmp_path / "out" / "patch.nii.gz"
    assert scored(patch, truth, home / "ct", *asked) == measured(tmp_path / "out")
    assert scored(patch, truth, home / "ct")["border_dice"] != measured(tmp_path / "out")["border_dice"]


@pytest.fixture(scope="module")
def with_island(case, home, tmp_path_factory):
    """A mask whose hole holds a loose splinter, which no design takes for bone; as 0 and 1, and as labels 0 and 7."""
    folder = tmp_path_factory.mktemp("island")
    bone, inside = case.bone.copy(), np.argwhere(case.implant)
    middle = inside[np.linalg.norm(inside - inside.mean(axis=0), axis=1).argmin()]
    bone[tuple(slice(i - 1, i + 1) for i in middle)] = True
    assert (bone & case.implant).any()
    write_nifti(Volume(bone, case.affine), folder / "skull.nii.gz")
    write_nifti(Volume(7 * bone.astype(np.uint8), case.affine), folder / "labels.nii.gz")
    return folder


@pytest.mark.parametrize(("name", "asked"), [("skull", ()), ("labels", ("--mask",))])
def test_of_a_mask_with_a_loose_island_they_are_exactly_those_of_the_design(name, asked, with_island, home, tmp_path):
    skull, truth = with_island / f"{name}.nii.gz", home / "truth.nii.gz"
    made = cranio("design", skull, "--method", "hull", *asked, "--truth", truth, "--out", tmp_path / "out")
    assert made.exit_code == 0, made.output
    found = scored(tmp_path / "out" / "patch.nii.gz", truth, skull, *asked)
    assert found == measured(tmp_path / "out") and found["overlap"] == 0


def test_the_truth_scores_as_the_truth(home):
    found = scored(home / "truth.nii.gz", home / "truth.nii.gz", home / "ct")
    assert found["dice"] == found["border_dice"] == found["volume_ratio"] == 1
    assert found["hd95"] == found["assd"] == found["rmse"] == 0


def test_the_table_names_each_measure_with_its_unit(done, home):
    shown = cranio("score", done / "patch.nii.gz", home / "truth.nii.gz", "--skull", home / "ct").stdout
    rows = {line.split()[0]: line.split()[2:] for line in shown.splitlines() if len(line.split()) > 1}
    assert rows["hd95"] == ["mm"] and rows["dice"] == [] and rows["overlap"] == ["voxels"]


def test_another_grid_is_refused(case, done, home, tmp_path):
    write_nifti(Volume(case.implant[:-1], case.affine), tmp_path / "truth.nii.gz")
    assert_refused(cranio("score", done / "patch.nii.gz", tmp_path / "truth.nii.gz", "--skull", home / "ct"), 3)
