"""Stacks of slices, straight and tilted: every landmark keeps its place in the patient."""

from pathlib import Path

import numpy as np
import pytest
from dicom_series import AXIAL, ORIGIN, assert_same_places, head, read_folder, refusal, save, series, truth
from scipy import ndimage

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from cranio_nb.readers.dicom.geometry import axes_of, build_stack
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


def test_jitter_below_the_tolerance_is_not_resampled(tmp_path: Path) -> None:
    hu, *_ = tilted(0.0)
    heights = np.arange(SHAPE[0]) * STEP + np.random.default_rng(1).uniform(-0.008, 0.008, SHAPE[0])
    volume, report = read_ct(save(tmp_path / "scan", series(hu, heights=heights, orientation=AXIAL)))
    np.testing.assert_array_equal(volume.voxels, hu)
    planes = volume.to_world(np.arange(SHAPE[0])[:, None] * (1, 0, 0))[:, 2] - ORIGIN[2]
    assert report.corner_error == pytest.approx(np.abs(planes - heights).max(), abs=1e-6)
    assert 1e-3 < report.corner_error <= 0.05
    assert "UnevenSpacing" not in {f.code for f in report.findings}


def test_oblique_stack_keeps_every_place(tmp_path: Path) -> None:
    rotation = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    iop = tuple(rotation[:, :2].T.ravel())
    volume, _ = read_ct(save(tmp_path / "scan", series(head((9, 22, 26)), orientation=iop)))
    assert_same_places(volume, head((9, 22, 26)), truth(iop))


def test_directions_of_a_slice_are_made_exactly_orthogonal() -> None:
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    cols, rows, normal = axes_of(np.round(np.concatenate([turn[0], turn[1]]), 4))  # as a header rounds them
    axes = np.stack([cols, rows, normal])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(axes[:2], turn[:2], atol=1e-3)
    assert normal[np.abs(normal).argmax()] > 0


@pytest.mark.parametrize("wrong", [[1, 0, 0, 0.1, 1, 0], [1.1, 0, 0, 0, 1, 0], [0] * 6, [np.nan, 0, 0, 0, 1, 0]])
def test_directions_that_are_none_are_refused(wrong: list[float]) -> None:
    with pytest.raises(InputRefused) as caught:
        axes_of(np.array(wrong, float))
    assert caught.value.code == "BadGeometry"


def test_a_stack_knows_its_heights_and_its_lean(tmp_path: Path) -> None:
    datasets = series(head((9, 22, 26)), direction=(0, 0.2, 1))
    headers = read_folder(save(tmp_path / "scan", datasets))
    stack = build_stack(headers[::-1])
    np.testing.assert_allclose(stack.heights, 1.5 * np.arange(9), atol=1e-9)
    np.testing.assert_allclose(stack.shear, [0, 0.2, 0], atol=1e-9)
    np.testing.assert_allclose(stack.origin, ORIGIN, atol=1e-9)
    assert stack.corner_errors(stack.heights).max() < 1e-9
    np.testing.assert_allclose(stack.corner_errors(stack.heights + 1), np.sqrt(1 + 0.2**2), atol=1e-9)


@pytest.mark.parametrize("at", [0, 3, 11])
def test_the_slice_that_lacks_something_is_named_by_its_place_in_the_folder(at: int, tmp_path: Path) -> None:
    datasets = series(head((12, 20, 24)))
    del datasets[at].PixelSpacing
    assert str(refusal(save(tmp_path / "scan", datasets))).startswith(f"Slice {at} (in file order) has no PixelSpacing")
