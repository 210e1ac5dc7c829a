"""NIfTI and NRRD files: the same world as the DICOM series, and no guess where the file does not say."""

from collections.abc import Callable
from itertools import permutations, product
from pathlib import Path

import numpy as np
import pytest
from dicom_series import SPACING, STEP, head, save, series
from image_files import (
    LPS_TO_RAS,
    SMALL,
    assert_head,
    file_refusal,
    patch_header,
    rewrite_header,
    stored_head,
    write_nifti,
    write_nrrd,
)

from cranio_nb.readers import read_ct
from cranio_nb.volume import same_grid


def test_dicom_nifti_and_nrrd_stand_at_the_same_place(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    dicom, _ = read_ct(save(tmp_path / "scan", series(head(SMALL))))
    others = [
        write_nifti(tmp_path / "a.nii", voxels, lps),
        write_nifti(tmp_path / "a.nii.gz", voxels, lps),
        write_nrrd(tmp_path / "a.nrrd", voxels, lps),
        write_nrrd(tmp_path / "b.nrrd", voxels, lps, encoding="raw"),
        write_nrrd(tmp_path / "c.nrrd", voxels, lps, encoding="bzip2"),
        write_nrrd(tmp_path / "d.nrrd", voxels.astype(">i2"), lps),
    ]
    for path in others:
        volume, report = read_ct(path)
        assert volume.voxels.dtype == np.int16 and report.kind == "ct"
        assert same_grid(dicom, volume, tol=1e-3)
        np.testing.assert_array_equal(dicom.voxels, volume.voxels)
        np.testing.assert_allclose(report.stored_affine, lps, atol=1e-4)
        np.testing.assert_array_equal(volume.reorder(report.order.inverse).voxels, voxels)


@pytest.mark.parametrize("kind", ["nifti", "nrrd"])
@pytest.mark.parametrize("axes", list(permutations(range(3))))
@pytest.mark.parametrize("flips", list(product((1, -1), repeat=3)))
def test_every_axis_order_keeps_every_place(
    kind: str, axes: tuple[int, ...], flips: tuple[int, ...], tmp_path: Path
) -> None:
    voxels, lps = stored_head()
    swapped = voxels.transpose(axes)[tuple(slice(None, None, f) for f in flips)]
    affine = np.eye(4)
    affine[:3, :3] = lps[:3, axes] * flips
    affine[:3, 3] = lps[:3, 3] + lps[:3, axes] @ np.where(np.array(flips) < 0, np.array(swapped.shape) - 1, 0)
    write = write_nifti if kind == "nifti" else write_nrrd
    path = tmp_path / ("a.nii" if kind == "nifti" else "a.nrrd")
    volume, report = read_ct(write(path, np.ascontiguousarray(swapped), affine))
    assert_head(volume)
    np.testing.assert_array_equal(volume.reorder(report.order.inverse).voxels, swapped)


def test_single_fourth_axis_is_dropped_and_others_are_refused(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    assert_head(read_ct(write_nifti(tmp_path / "a.nii", voxels[..., None], lps))[0])
    assert file_refusal(write_nifti(tmp_path / "b.nii", np.stack([voxels] * 2, axis=-1), lps)).code == "BadShape"
    assert file_refusal(write_nifti(tmp_path / "c.nii", voxels[..., 0], lps)).code == "BadShape"
    directions = np.vstack([np.full(3, np.nan), lps[:3, :3].T])
    path = write_nrrd(tmp_path / "a.nrrd", voxels[None], lps, space_directions=directions)
    assert_head(read_ct(path)[0])
    path = write_nrrd(tmp_path / "b.nrrd", np.stack([voxels] * 2), lps, space_directions=directions)
    assert file_refusal(path).code == "BadShape"


AFFINE_FAULTS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "nan": lambda a: np.where(np.eye(4) == 1, np.nan, a),
    "zero": lambda a: a * [0, 1, 1, 1],
    "flat": lambda a: a[:, [0, 0, 2, 3]],
    "giant": lambda a: a * [50, 1, 1, 1],
}


@pytest.mark.parametrize("name", AFFINE_FAULTS)
def test_broken_affines_are_refused(name: str, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    affine = AFFINE_FAULTS[name](lps)
    path = write_nifti(tmp_path / "a.nii", voxels, lps)
    patch_header(path, **dict(zip(("srow_x", "srow_y", "srow_z"), LPS_TO_RAS[:3, :3] @ affine[:3], strict=True)))
    assert file_refusal(path).code == "BadGeometry"
    path = write_nrrd(tmp_path / "a.nrrd", voxels, lps)
    rewrite_header(path, "space directions", " ".join(f"({x},{y},{z})" for x, y, z in affine[:3, :3].T))
    assert file_refusal(path).code in {"BadGeometry", "CorruptFile"}


def test_sheared_planes_are_shifted_back(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    sheared = lps.copy()
    sheared[:3, 2] += [0, SPACING[0], 0]
    for path in (write_nifti(tmp_path / "a.nii", voxels, sheared), write_nrrd(tmp_path / "a.nrrd", voxels, sheared)):
        volume, report = read_ct(path)
        assert "Sheared" in {f.code for f in report.findings}
        axes = volume.affine[:3, :3] / volume.spacing
        np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-6)
        np.testing.assert_allclose(volume.reorder(report.order.inverse).affine, report.stored_affine, atol=1e-6)
        # a shift by whole pixels leaves every value: find each by its place
        index = np.argwhere(np.ones(voxels.shape, bool))
        at = np.rint(volume.to_voxel(index @ sheared[:3, :3].T + sheared[:3, 3])).astype(int)
        np.testing.assert_array_equal(volume.voxels[tuple(at.T)], voxels.ravel())


def test_no_orientation_is_refused_unless_allowed(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    nifti = write_nifti(tmp_path / "a.nii", voxels, lps)
    patch_header(nifti, sform_code=0, qform_code=0)
    no_space = write_nrrd(tmp_path / "a.nrrd", voxels, lps, space=None)
    scanner = write_nrrd(tmp_path / "b.nrrd", voxels, lps, space="scanner-xyz")
    for path in (nifti, no_space, scanner):
        error = file_refusal(path)
        assert error.code == "NoOrientation" and "no_orientation" in error.remedy
        volume, report = read_ct(path, allow=("no_orientation",))
        np.testing.assert_allclose(sorted(volume.spacing), sorted((STEP, *SPACING)), atol=1e-6)
        assert next(f for f in report.findings if f.code == "NoOrientation").severity == "warning"


@pytest.mark.parametrize("origin", [1e300, 1e30, 2e4])
def test_an_origin_beyond_any_scanner_is_refused(origin: float, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    far = lps.copy()
    far[1, 3] = origin
    assert file_refusal(write_nrrd(tmp_path / "a.nrrd", voxels, far)).code == "BadGeometry"


@pytest.mark.parametrize("planes", [2, 7])
def test_a_few_planes_are_no_head(planes: int, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    for name, cut in (("a", voxels[:, :, :planes]), ("b", voxels[:planes])):
        assert file_refusal(write_nifti(tmp_path / f"{name}.nii", cut, lps)).code == "TooFewSlices"


def test_planes_too_far_apart_are_refused_as_slices_are(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    assert (
        file_refusal(write_nifti(tmp_path / "a.nii", voxels, lps @ np.diag([1, 1, 4, 1]))).code == "SlicesTooFarApart"
    )
