"""Stacks of slices, straight and tilted: every landmark keeps its place in the patient."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from dicom_series import AXIAL, ORIGIN, assert_same_places, head, read_folder, refusal, save, series, truth
from scipy import ndimage

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from cranio_nb.readers.dicom.geometry import axes_of, build_stack, check_geometry, sort_by_height
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


def header(height: float = 0.0, **changes: object) -> SimpleNamespace:
    """An axial slice of 4 rows and 5 columns, 100 mm from the origin along the height, as a header says it."""
    place = {"position": np.array([-3.0, 7.0, 100.0 + height]), "orientation": np.array(AXIAL, float)}
    spacing = {"spacing": np.array([0.5, 2.0]), "rows": 4, "cols": 5, "file": 0, "frame": 0, "frames": 1}
    return SimpleNamespace(**(place | spacing | changes))


def refused(call: Callable[..., object], *given: object) -> InputRefused:
    """The refusal of a geometry, which says what to do."""
    with pytest.raises(InputRefused) as caught:
        call(*given)
    assert caught.value.code == "BadGeometry" and "Export" in caught.value.remedy
    return caught.value


def test_directions_may_be_off_by_the_rounding_of_a_header_and_no_more() -> None:
    for off, place in ((1.9e-3, 1), (0.95e-3, 0), (0.95e-3, 4)):  # the square of a length is off by twice as much
        right, wrong = np.array(AXIAL, float), np.array(AXIAL, float)
        right[place] += off
        wrong[place] += 1.2 * off
        assert axes_of(right)[2].tolist() == [0, 0, 1]
        assert "ImageOrientationPatient" in refused(axes_of, wrong).message


@pytest.mark.parametrize("turn", [(1, 0, 0, 0, 1, 0), (1, 0, 0, 0, -1, 0), (0, 1, 0, 0, 0, -1), (0, 0, 1, 1, 0, 0)])
def test_the_normal_points_to_the_left_the_back_or_the_top(turn: tuple[int, ...]) -> None:
    cols, rows, normal = axes_of(np.array(turn, float))
    np.testing.assert_array_equal([*cols, *rows], turn)
    np.testing.assert_array_equal(normal, np.abs(np.cross(cols, rows)))
    assert not np.signbit(normal).any()


@pytest.mark.parametrize("tag", ["ImagePositionPatient", "ImageOrientationPatient", "PixelSpacing"])
def test_the_first_slice_whose_geometry_is_absent_or_no_number_is_named(tag: str) -> None:
    name = {"ImagePositionPatient": "position", "ImageOrientationPatient": "orientation", "PixelSpacing": "spacing"}[
        tag
    ]
    broken = getattr(header(), name).copy()
    broken[-1] = np.nan
    for value, what in ((None, "has no"), (broken, "has an unreadable")):
        headers = [header(file=k, **({name: value} if k >= 2 else {})) for k in range(4)]
        assert refused(check_geometry, headers).message == f"Slice 2 (in file order) {what} {tag}."
        frames = [header(frame=k, frames=9, **({name: value} if k >= 5 else {})) for k in range(9)]
        assert refused(check_geometry, frames).message == f"Slice 5 (in file order) {what} {tag}."


def test_slices_lie_within_ten_metres_and_have_pixels_from_a_twentieth_to_ten_millimetres() -> None:
    for at in (-1e4, 1e4):
        check_geometry([header(position=np.array([0, at, 0]))])
        found = refused(check_geometry, [header(), header(file=1, position=np.array([0, 1.001 * at, 0]))])
        assert "Slice 1 " in found.message and "more than 10000 mm" in found.message
    check_geometry([header(spacing=np.array([0.05, 10.0])), header(spacing=np.array([10.0, 0.05]))])
    for spacing in ([0.049, 1.0], [1.0, 0.049], [10.1, 1.0], [1.0, 10.1]):
        found = refused(check_geometry, [header(), header(file=1, spacing=np.array(spacing))])
        assert "Slice 1 " in found.message and "outside 0.05 to 10.0 mm" in found.message


def test_slices_are_sorted_by_their_height_and_equal_ones_keep_their_order() -> None:
    headers = [header(2.5 * (k % 3), file=k) for k in range(99)]
    ordered, heights = sort_by_height(headers)
    assert [one.file for one in ordered] == sorted(range(99), key=lambda k: (k % 3, k))
    assert heights.tolist() == 33 * [0] + 33 * [2.5] + 33 * [5]


def test_slices_at_one_place_are_no_stack() -> None:
    assert "All 3 slices" in refused(build_stack, [header(z) for z in (0.0, 0.0, 0.9e-3)]).message
    assert build_stack([header(z) for z in (0.0, 1.1e-3)]).extent == pytest.approx(1.1e-3, rel=1e-6)


def test_a_stack_lies_where_its_slices_lie() -> None:
    stack = build_stack([header(z) for z in (6.0, 0.0, 1.0, 3.0)])  # of any steps
    np.testing.assert_allclose(stack.origin, [-3, 7, 100], atol=1e-9)
    assert stack.heights.tolist() == [0, 1, 3, 6] and stack.extent == 6
    assert [one.position[2] for one in stack.headers] == [100, 101, 103, 106]
    assert (*stack.along_cols, *stack.along_rows) == AXIAL and stack.normal.tolist() == [0, 0, 1]
    assert stack.spacing.tolist() == [0.5, 2]
    assert stack.shear.tolist() == [0, 0, 0]  # of an upright stack: exactly
    np.testing.assert_allclose(stack.corner_errors(stack.heights), 0, atol=1e-9)
    np.testing.assert_allclose(
        stack.corner_errors(stack.heights + np.array([0, 0.5, -2, 0])), [0, 0.5, 2, 0], atol=1e-9
    )


@pytest.mark.parametrize(
    ("changes", "off"),
    [
        ({"spacing": np.array([0.5, 2.01])}, 0.04),  # 4 steps along the columns
        ({"spacing": np.array([0.513, 2.0])}, 0.039),  # 3 steps along the rows
        ({"spacing": np.array([0.51, 2.01])}, np.hypot(0.04, 0.03)),
        ({"rows": 5}, 0.5),
        ({"cols": 7}, 4.0),
        ({"orientation": np.array([0, 1.0, 0, 1, 0, 0])}, np.hypot(8, 8)),
    ],
)
def test_the_corner_farthest_off_counts(changes: dict[str, object], off: float) -> None:
    stack = build_stack([header(z) for z in (0.0, 1.0, 2.0)])
    other = replace(stack, headers=(*stack.headers[:2], header(2.0, **changes)))  # type: ignore[arg-type]
    np.testing.assert_allclose(other.corner_errors(stack.heights), [0, 0, off], atol=1e-9)


def test_the_slice_farthest_off_the_line_is_named_with_its_distance() -> None:
    spacing = np.array([0.5, 2.0 + 0.0124])  # 0.0496 mm at the fourth step
    build_stack([header(0.0), header(1.0), header(2.0, spacing=spacing)])
    spacing = np.array([0.5, 2.0 + 0.0151])  # 0.0604 mm
    found = refused(build_stack, [header(0.0), header(2.0, spacing=spacing), header(1.0)])
    assert found.message.startswith("Slice 2 lies 0.06 mm off")


@pytest.mark.parametrize(
    ("lean", "heights"), [(0.01, (0.0, 1.0, 2.0)), (1e-5, (0.0, 50.0, 100.0)), (5e-7, (0, 1, 100))]
)
def test_a_lean_that_moves_the_highest_slice_is_kept(lean: float, heights: tuple[float, ...]) -> None:
    stack = build_stack([header(z, position=np.array([-3, 7 + lean * z, 100 + z])) for z in heights])
    np.testing.assert_allclose(stack.shear, [0, lean, 0], atol=1e-12)


def test_a_single_slice_is_said_to_be_one(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head())[:1])
    assert refusal(folder).message == "The series holds a single slice."
