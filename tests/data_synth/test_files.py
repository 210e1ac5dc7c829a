"""Case folders and scans on disk: what is written is read back."""

import json

import nibabel
import nrrd
import numpy as np
import pytest

from data_synth import cut_case, phantom_case
from data_synth.files import read_scan, write_case


def test_a_case_of_a_ct_comes_back_from_its_folder(tmp_path):
    case = phantom_case("tiny", "burr_hole", 2)
    write_case(tmp_path / "case", case)
    hu, affine, is_mask = read_scan(tmp_path / "case" / "ct")
    np.testing.assert_array_equal(hu, case.hu)
    np.testing.assert_allclose(affine, case.affine, atol=1e-9)
    truth, grid, truth_is_mask = read_scan(tmp_path / "case" / "truth.nii.gz")
    np.testing.assert_array_equal(truth, case.implant)
    np.testing.assert_allclose(grid, case.affine, atol=1e-4)
    assert truth_is_mask and not is_mask
    record = json.loads((tmp_path / "case" / "truth.json").read_text())
    assert record["bone_mm3"] == pytest.approx(case.bone.sum() * case.voxel_volume)


def test_a_case_of_a_mask_has_a_mask_and_no_ct(tmp_path):
    whole = phantom_case("tiny", "burr_hole", 2)
    case = cut_case(whole.complete, whole.affine, "unilateral", is_mask=True)
    write_case(tmp_path / "case", case)
    assert sorted(path.name for path in (tmp_path / "case").iterdir()) == ["mask.nii.gz", "truth.json", "truth.nii.gz"]
    np.testing.assert_array_equal(read_scan(tmp_path / "case" / "mask.nii.gz")[0], case.bone)


@pytest.mark.parametrize(("space", "signs"), [("LPS", (1, 1)), ("RAS", (-1, -1)), ("left-anterior-superior", (1, -1))])
def test_nrrd_and_nifti_give_one_world(space, signs, tmp_path):
    voxels = np.random.default_rng(1).integers(-1000, 2000, (5, 6, 7)).astype(np.int16)
    ras = np.diag([-0.5, -0.7, 2.0, 1.0])
    ras[:3, 3] = 4, -8, 16
    nibabel.save(nibabel.Nifti1Image(voxels, ras), tmp_path / "a.nii.gz")
    own = np.diag([*signs, 1, 1]) @ np.diag([-1, -1, 1, 1]) @ ras
    fields = {"space": space, "space directions": own[:3, :3].T, "space origin": own[:3, 3]}
    nrrd.write(str(tmp_path / "a.nrrd"), voxels, fields)
    (one, affine, _), (other, other_affine, _) = (read_scan(tmp_path / name) for name in ("a.nii.gz", "a.nrrd"))
    np.testing.assert_array_equal(one, other)
    np.testing.assert_allclose(affine, other_affine, atol=1e-6)
