"""The command `phantom`: cases with a truth, made or cut."""

import json
from dataclasses import replace

import numpy as np
import pytest
from cli_runs import assert_refused, cranio

from cranio_nb.prior.study import read_intact_skulls
from cranio_nb.readers import read_ct
from data_synth import face_case, phantom_case, scan, write_dicom


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


@pytest.fixture(scope="module", params=["dome", "dome with a hole", "face", "face with a hole"])
def head(request, tmp_path_factory):
    """A CT of a head, and whether it is intact."""
    folder, is_intact = tmp_path_factory.mktemp("heads"), "hole" not in request.param
    if request.param.startswith("dome"):
        case = phantom_case("tiny", "unilateral", 0)
        hu = scan(replace(case.head, cutters=()), case.affine, case.hu.shape, seed=0)[0] if is_intact else case.hu
    else:
        case = face_case("tiny", 1, holes=0 if is_intact else "unilateral")
        hu = case.hu
    write_dicom(folder / "ct", hu, case.affine)
    return folder / "ct", is_intact


def test_all_commands_agree_on_what_is_intact(head, tmp_path):
    path, is_intact = head
    looked = cranio("inspect", path)
    designed = cranio("design", path, "--method", "hull", "--out", tmp_path / "designed")
    cut = cranio("phantom", tmp_path / "cut", "--from", path)
    skipped = []
    told = {"skipped": lambda name, why: skipped.append(why), "warned": lambda name, why: None}
    learned = list(read_intact_skulls([path], threshold=400.0, **told))
    assert looked.exit_code == designed.exit_code == (4 if is_intact else 0), looked.output
    assert cut.exit_code == (0 if is_intact else 3) and (tmp_path / "cut").exists() == is_intact
    assert len(learned) == is_intact and len(skipped) == (not is_intact)
    if not is_intact:
        assert "not intact" in cut.stderr and "not intact" in skipped[0] and "Opening 1" in skipped[0]
