"""Tilted and uneven scans: after reading, every landmark stands where it stood in the patient."""

from pathlib import Path

import numpy as np
import pytest
from dicom_series import AXIAL, ORIGIN, save, series
from scipy import ndimage

from cranio_nb.readers import read_ct
from cranio_nb.readers.regrid import even_heights, find_missing_gaps, resample_planes, slide_slices
from cranio_nb.volume import Volume

SHAPE = (30, 44, 40)  # slices, rows, columns
PIXEL, STEP = 1.1, 1.6  # mm
BALLS = np.array([[-8.0, -9.0, -12.0], [9.0, 2.0, -3.0], [-4.0, 10.0, 4.0], [6.0, -6.0, 11.0]])  # mm from the middle


def tilted(degrees: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """HU of four soft balls on slices tilted about x and stacked along z, their orientation and first position."""
    angle = np.radians(degrees)
    cols, rows = np.array([1.0, 0, 0]), np.array([0.0, np.cos(angle), -np.sin(angle)])
    up = np.array([0.0, 0, 1])
    k, i, j = np.meshgrid(*[np.arange(n) - (n - 1) / 2 for n in SHAPE], indexing="ij")
    world = i[..., None] * PIXEL * rows + j[..., None] * PIXEL * cols + k[..., None] * STEP * up
    glow = sum(np.exp(-(((world - ball) / 3.0) ** 2).sum(axis=-1)) for ball in BALLS)
    return np.rint(glow * 2000 - 1000).astype(np.int16), np.concatenate([cols, rows]), world[0, 0, 0]


def read_tilted(folder: Path, degrees: float) -> tuple[Volume, set[str]]:
    hu, iop, origin = tilted(degrees)
    datasets = series(hu, orientation=iop, origin=origin, spacing=(PIXEL, PIXEL), step=STEP, direction=(0, 0, 1))
    volume, report = read_ct(save(folder, datasets))
    assert report.corner_error <= 0.05
    return volume, {finding.code for finding in report.findings}


def centroids(volume: Volume) -> np.ndarray:
    """World centroids of the balls, in mm, from the lowest to the highest."""
    weight = np.clip(volume.voxels.astype(float) + 940, 0, None)
    labels, count = ndimage.label(volume.voxels > -600)
    assert count == len(BALLS)
    labels = ndimage.grey_dilation(labels, size=5)
    found = volume.to_world(ndimage.center_of_mass(weight, labels, range(1, count + 1)))
    return found[np.argsort(found[:, 2])]


@pytest.mark.parametrize("degrees", [*np.arange(-30, 30.1, 2.5), -0.5, 0.5, 18.5, -18.5])
def test_tilted_scan_keeps_its_landmarks(degrees: float, tmp_path: Path) -> None:
    volume, codes = read_tilted(tmp_path / "scan", float(degrees))
    assert ("GantryTilt" in codes) == (abs(degrees) > 0.5)
    # the lattice itself samples the balls obliquely, so their own centroids wander by some hundredths of a mm
    assert np.linalg.norm(centroids(volume) - BALLS, axis=1).max() < 0.1
    if abs(degrees) > 0.5:
        axes = volume.affine[:3, :3] / volume.spacing
        np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-9)
        assert abs(volume.spacing[0] - STEP * np.cos(np.radians(degrees))) < 1e-6


def test_opposite_tilts_are_mirror_images(tmp_path: Path) -> None:
    (hu, iop, origin), (_, other_iop, other_origin) = tilted(17.0), tilted(-17.0)
    common = {"spacing": (PIXEL, PIXEL), "step": STEP, "direction": (0, 0, 1)}
    one, _ = read_ct(save(tmp_path / "a", series(hu, orientation=iop, origin=origin, **common)))
    back = series(hu[:, ::-1], orientation=other_iop, origin=other_origin, **common)
    other, _ = read_ct(save(tmp_path / "b", back))
    np.testing.assert_array_equal(one.voxels, other.voxels[:, ::-1])


def test_nothing_is_lost_at_the_rim_of_a_tilted_scan(tmp_path: Path) -> None:
    hu, iop, origin = tilted(25.0)
    hu[:, 0], hu[:, -1] = 700, 700
    datasets = series(hu, orientation=iop, origin=origin, spacing=(PIXEL, PIXEL), step=STEP, direction=(0, 0, 1))
    volume, _ = read_ct(save(tmp_path / "scan", datasets))
    before, after = (hu + 1024.0).sum(), (volume.voxels + 1024.0).sum()
    assert abs(after / before - 1) < 1e-3


def test_uneven_steps_keep_the_volume_of_an_ellipsoid(tmp_path: Path) -> None:
    radii, heights = np.array([26.0, 22.0, 19.0]), np.cumsum([-27.5] + [1.25] * 22 + [2.5] * 11)
    y, x = np.meshgrid(np.arange(-25, 25.1, 0.8), np.arange(-25, 25.1, 0.8), indexing="ij")
    squared = (heights[:, None, None] / radii[0]) ** 2 + (y / radii[1]) ** 2 + (x / radii[2]) ** 2
    inside = np.clip((1 - np.sqrt(squared)) * radii.mean() / 1.6 + 0.5, 0, 1)
    hu = np.rint(inside * 1500 - 1000).astype(np.int16)
    datasets = series(hu, heights=heights, spacing=(0.8, 0.8))
    volume, report = read_ct(save(tmp_path / "scan", datasets))
    finding = next(f for f in report.findings if f.code == "UnevenSpacing")
    assert finding.severity == "corrected" and (finding.values["min_mm"], finding.values["max_mm"]) == (1.25, 2.5)
    assert volume.spacing[0] <= 1.25
    measured = ((volume.voxels + 1000.0) / 1500).sum() * volume.voxel_volume
    assert measured == pytest.approx(4 / 3 * np.pi * radii.prod(), rel=0.01)


def test_jitter_below_the_tolerance_is_not_resampled(tmp_path: Path) -> None:
    hu, *_ = tilted(0.0)
    heights = np.arange(SHAPE[0]) * STEP + np.random.default_rng(1).uniform(-0.008, 0.008, SHAPE[0])
    volume, report = read_ct(save(tmp_path / "scan", series(hu, heights=heights, orientation=AXIAL)))
    np.testing.assert_array_equal(volume.voxels, hu)
    planes = volume.to_world(np.arange(SHAPE[0])[:, None] * (1, 0, 0))[:, 2] - ORIGIN[2]
    assert report.corner_error == pytest.approx(np.abs(planes - heights).max(), abs=1e-6)
    assert 1e-3 < report.corner_error <= 0.05
    assert "UnevenSpacing" not in {f.code for f in report.findings}


def test_whole_pixel_slides_are_exact() -> None:
    voxels = np.arange(1, 25).reshape(2, 3, 4).astype(np.int16)
    upright, origin = slide_slices(voxels, np.array([[0.0, 0.0], [2.0, -1.0]]), fill=-9)
    np.testing.assert_array_equal(origin, [0, -1])
    assert upright.shape == (2, 5, 5)
    np.testing.assert_array_equal(upright[0, :3, 1:], voxels[0])
    np.testing.assert_array_equal(upright[1, 2:, :4], voxels[1])
    assert (upright == -9).sum() == 2 * (25 - 12)


def test_planes_are_interpolated_linearly() -> None:
    heights = np.array([0.0, 1.0, 4.0])
    voxels = (100 * heights[:, None, None] * np.ones((3, 2, 2))).astype(np.int16)
    wanted = even_heights(heights, 1.0)
    np.testing.assert_allclose(wanted, np.arange(5.0))
    np.testing.assert_array_equal(resample_planes(voxels, heights, wanted)[:, 0, 0], 100 * wanted)


def test_gaps_tell_missing_slices_from_two_slice_distances() -> None:
    run = list(range(1, 14))
    assert find_missing_gaps(np.delete(np.arange(14.0), 6), [None] * 13) == [5]
    assert find_missing_gaps(np.cumsum([2.5] * 7 + [5.0] * 6), run) == []
    assert find_missing_gaps(np.cumsum([2.5] * 7 + [5.0] * 6), [*run[:7], *range(9, 21, 2)]) == [6, 7, 8, 9, 10, 11]
