"""NIfTI files: scaling, units, forms and offsets as the standard has them, or refused."""

from pathlib import Path

import nibabel as nib
import numpy as np
import pytest
from image_files import LPS_TO_RAS, assert_head, file_refusal, patch_header, stored_head, write_nifti

from cranio_nb.readers import read_ct


def test_scaling_is_applied_or_reported(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nifti(tmp_path / "a.nii", (voxels + 1024).astype(np.uint16), lps)
    patch_header(path, scl_slope=1.0, scl_inter=-1024.0)
    assert_head(read_ct(path)[0])
    path = write_nifti(tmp_path / "b.nii", voxels, lps)
    patch_header(path, scl_slope=np.inf, scl_inter=0.0)
    volume, report = read_ct(path)
    assert_head(volume)
    assert "BadScaling" in {f.code for f in report.findings}


@pytest.mark.parametrize(("unit", "factor"), [(1, 1e-3), (3, 1e3)])
def test_units_are_honoured(unit: int, factor: float, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    scaled = np.diag([factor, factor, factor, 1]) @ lps
    assert_head(read_ct(write_nifti(tmp_path / "a.nii", voxels, scaled, xyzt_units=unit))[0])


def test_metres_taken_for_millimetres_are_refused(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    assert (
        file_refusal(write_nifti(tmp_path / "a.nii", voxels, np.diag([1e-3, 1e-3, 1e-3, 1]) @ lps)).code
        == "BadGeometry"
    )


def test_other_kinds_of_voxels_are_refused(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    assert file_refusal(write_nifti(tmp_path / "a.nii", voxels.astype("c8"), lps)).code == "UnsupportedPixels"
    colours = np.zeros(voxels.shape, [("R", "u1"), ("G", "u1"), ("B", "u1")])
    assert file_refusal(write_nifti(tmp_path / "b.nii", colours, lps)).code == "UnsupportedPixels"


@pytest.mark.parametrize("slope", [1e20, -1e30, 2.0**53, 3e38])
@pytest.mark.parametrize("kind", ["i2", "i4", "u1"])
def test_huge_scalings_are_no_hu(slope: float, kind: str, tmp_path: Path) -> None:
    """Whole numbers beyond the range of integers neither fail nor wrap around into it."""
    voxels, lps = stored_head()
    path = write_nifti(tmp_path / "a.nii", (voxels.clip(-128, 127) & 127).astype(kind), lps)
    patch_header(path, scl_slope=slope, scl_inter=slope)
    assert "no CT holds such" in str(file_refusal(path))


def test_unknown_codes_of_voxels_and_offsets_of_no_number_are_refused(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    for change in ({"datatype": 102}, {"datatype": -7}, {"vox_offset": np.nan}, {"vox_offset": np.inf}):
        path = write_nifti(tmp_path / "a.nii", voxels, lps)
        patch_header(path, **change)
        error = file_refusal(path)
        assert error.code == "CorruptFile" and "NIfTI file is damaged" in str(error)


def test_pixdim_of_zero_is_refused(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nifti(tmp_path / "a.nii", voxels, lps)
    patch_header(path, pixdim=[1, 0, 0.9, 1.5, 1, 1, 1, 1])
    assert file_refusal(path).code == "BadGeometry"


def test_disagreeing_forms_are_reported(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    image = nib.Nifti1Image(voxels, LPS_TO_RAS @ lps)
    moved = LPS_TO_RAS @ lps
    moved[0, 3] += 30
    image.set_qform(moved, code=1)
    image.set_sform(LPS_TO_RAS @ lps, code=1)
    nib.save(image, tmp_path / "a.nii")
    volume, report = read_ct(tmp_path / "a.nii")
    assert_head(volume)
    assert "TwoOrientations" in {f.code for f in report.findings}


def test_header_alone_and_offset_past_the_end_are_refused(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nifti(tmp_path / "a.nii", voxels, lps)
    patch_header(path, vox_offset=1e6)
    assert file_refusal(path).code == "CorruptFile"
    patch_header(path, vox_offset=-100)
    assert file_refusal(path).code == "CorruptFile"
    path.write_bytes(path.read_bytes()[:352])
    patch_header(path, vox_offset=352)
    assert file_refusal(path).code == "CorruptFile"
