"""The command `inspect`: how a scan was read, and its openings."""

import json

import nibabel
import numpy as np
from cli_runs import cranio

from data_synth import phantom_case


def test_inspect_tells_reading_and_openings(home):
    table = cranio("inspect", home / "ct")
    assert table.exit_code == 0 and "SeriesChosen" in table.stdout and "left" in table.stdout
    record = json.loads(cranio("inspect", home / "ct", "--json").stdout)
    (opening,) = record["openings"]
    assert record["load"]["kind"] == "ct" and record["problem"] is None
    truth = json.loads((home / "truth.json").read_text())
    first, end = truth["planes"]
    assert abs(opening["planes"][0] - first) <= 1 and abs(opening["planes"][1] - (end - 1)) <= 1
    assert 45 < opening["width"] <= opening["length"] < 70


def test_a_closed_skull_is_described_before_it_is_refused(closed_skull):
    result = cranio("inspect", closed_skull, "--json")
    record = json.loads(result.stdout)
    assert result.exit_code == 4 and record["problem"] == "NoOpening" and record["openings"] == []
    assert record["load"]["kind"] == "mask"


def test_a_label_chooses_the_skull(tmp_path):
    case = phantom_case("tiny", "unilateral", 1)
    labels = (case.bone + 2 * case.implant).astype("u1").transpose(2, 1, 0)
    affine = np.diag([-1.0, -1, 1, 1]) @ case.affine[:, [2, 1, 0, 3]]
    nibabel.save(nibabel.Nifti1Image(labels, affine), tmp_path / "labels.nii.gz")
    assert cranio("inspect", tmp_path / "labels.nii.gz").exit_code == 3
    assert cranio("inspect", tmp_path / "labels.nii.gz", "--mask").exit_code == 3
    found = cranio("inspect", tmp_path / "labels.nii.gz", "--label", "1", "--json")
    assert found.exit_code == 0 and len(json.loads(found.stdout)["openings"]) == 1
