"""The command `phantom`: cases with a truth, made or cut."""

import json

import numpy as np
from cli_runs import assert_refused, cranio

from cranio_nb.readers import read_ct


def test_phantom_and_cutting_a_mask(closed_skull, tmp_path):
    assert cranio("phantom", tmp_path / "a", "--size", "tiny", "--defect", "frontal", "--seed", "3").exit_code == 0
    assert json.loads((tmp_path / "a" / "truth.json").read_text())["defect"] == "frontal"
    assert cranio("phantom", tmp_path / "b", "--from", closed_skull, "--defect", "frontal").exit_code == 0
    cut, truth = (read_ct(tmp_path / "b" / f"{name}.nii.gz", mask=True)[0] for name in ("mask", "truth"))
    whole = read_ct(closed_skull)[0]
    assert truth.voxels.any() and not (cut.voxels & truth.voxels).any()
    np.testing.assert_array_equal(cut.voxels | truth.voxels, whole.voxels)
    assert cranio("phantom", tmp_path / "c", "--defect", "everywhere").exit_code == 2
    assert_refused(cranio("phantom", tmp_path / "c", "--from", tmp_path / "none"), 3)
    assert not (tmp_path / "c").exists()
