"""Good DICOM folders: every voxel keeps its value and its place, however the series is written or taken."""

import random
from itertools import permutations, product
from pathlib import Path

import numpy as np
import pytest
from dicom_series import ORIGIN, SHAPE, SPACING, STEP, assert_same_places, head, save, save_changed, series, truth

from cranio_nb.readers import read_ct
from cranio_nb.volume import same_grid
from data_synth.fault_edits import set_elements

SMALL = (9, 22, 26)


def test_series_is_read_exactly(tmp_path: Path) -> None:
    volume, report = read_ct(save(tmp_path / "scan", series(head())))
    np.testing.assert_array_equal(volume.voxels, head())
    np.testing.assert_allclose(volume.affine, truth(), atol=1e-9)
    assert volume.voxels.dtype == np.int16 and volume.voxels.flags.c_contiguous
    assert (report.source, report.kind, report.shape) == ("DICOM", "ct", SHAPE)
    np.testing.assert_allclose(report.spacing, (STEP, *SPACING))
    assert report.corner_error < 1e-6
    assert [f.severity for f in report.findings] == ["info"]


def test_bead_on_the_left_has_the_largest_x(tmp_path: Path) -> None:
    volume, _ = read_ct(save(tmp_path / "scan", series(head())))
    bead = volume.to_world(np.argwhere(volume.voxels > 1400))
    bone = volume.to_world(np.argwhere(volume.voxels > 300))
    assert bead[:, 0].min() > np.median(bone[:, 0]) + 10


def test_progress_counts_the_slices(tmp_path: Path) -> None:
    seen: list[tuple[int, int]] = []
    read_ct(save(tmp_path / "scan", series(head())), progress=lambda done, total: seen.append((done, total)))
    assert seen == [(k + 1, SHAPE[0]) for k in range(SHAPE[0])]


def all_orientations() -> list[tuple[float, ...]]:
    """The 48 ways in which slices can lie along the axes of the patient: 24 for each side of the stack."""
    axes = np.eye(3)
    made = [
        (*(s * axes[i]), *(t * axes[j])) for i, j in permutations(range(3), 2) for s, t in product((1, -1), (1, -1))
    ]
    return [tuple(float(v) for v in iop) for iop in made]


@pytest.mark.parametrize("upside_down", [False, True])
@pytest.mark.parametrize("orientation", all_orientations())
def test_every_orientation_keeps_every_place(orientation: tuple[float, ...], upside_down: bool, tmp_path: Path) -> None:
    hu, iop = head(SMALL), np.array(orientation)
    direction = np.cross(iop[:3], iop[3:]) * (-1 if upside_down else 1)
    datasets = series(hu, orientation=orientation, direction=direction)
    volume, _ = read_ct(save(tmp_path / "scan", datasets))
    affine = truth(orientation)
    affine[:3, 0] = direction * STEP
    assert_same_places(volume, hu, affine)
    largest = np.abs(volume.affine[:3, :3]).argmax(axis=0)
    assert list(largest) == [2, 1, 0] and all(volume.affine[w, a] > 0 for a, w in enumerate(largest))


def test_moving_the_patient_moves_the_volume_alone(tmp_path: Path) -> None:
    still, _ = read_ct(save(tmp_path / "a", series(head(SMALL))))
    shift = np.array([31.4, -15.9, 265.3])
    moved, _ = read_ct(save(tmp_path / "b", series(head(SMALL), origin=np.array(ORIGIN) + shift)))
    np.testing.assert_array_equal(still.voxels, moved.voxels)
    np.testing.assert_allclose(moved.affine[:3, 3] - still.affine[:3, 3], shift, atol=1e-9)


def test_names_numbers_and_subfolders_do_not_matter(tmp_path: Path) -> None:
    datasets = series(head())
    shuffled = datasets[:]
    random.Random(5).shuffle(shuffled)
    set_elements(slice(None), InstanceNumber=None)(shuffled)
    save(tmp_path / "Schädel 頭 череп" / ("deep" * 20) / "c", shuffled[:10])
    save(tmp_path / "Schädel 頭 череп", shuffled[10:])
    for path in list(tmp_path.rglob("*.dcm")):
        path.rename(path.with_suffix(""))
    volume, _ = read_ct(tmp_path)
    np.testing.assert_array_equal(volume.voxels, head())
    np.testing.assert_allclose(volume.affine, truth(), atol=1e-9)


def test_mask_in_dicom_is_recognised(tmp_path: Path) -> None:
    bone = (head() > 300).astype(np.int16)
    folder = save(tmp_path / "scan", series(bone, intercept=0))
    volume, report = read_ct(folder)
    assert volume.voxels.dtype == bool and report.kind == "mask"
    np.testing.assert_array_equal(volume.voxels, bone == 1)


def test_two_readings_are_the_same(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head(SMALL)))
    (a, _), (b, _) = read_ct(folder), read_ct(folder)
    assert same_grid(a, b) and np.array_equal(a.voxels, b.voxels)


@pytest.mark.parametrize(("stated", "warned"), [(12.0, True), (-12.0, True), (0.0, False), (0.5, False)])
def test_a_tilt_that_only_the_tag_states_is_a_warning(stated: float, warned: bool, tmp_path: Path) -> None:
    _, report = read_ct(save_changed(tmp_path, set_elements(slice(None), GantryDetectorTilt=stated)))
    assert ("TiltUnclear" in {f.code for f in report.findings}) == warned


def test_a_tilt_that_the_positions_show_is_corrected_without_a_warning(tmp_path: Path) -> None:
    lean = np.radians(12.0)
    tilted = (1.0, 0.0, 0.0, 0.0, np.cos(lean), -np.sin(lean))
    datasets = series(head(), orientation=tilted, direction=(0, 0, 1))
    set_elements(slice(None), GantryDetectorTilt=12.0)(datasets)
    _, report = read_ct(save(tmp_path / "scan", datasets))
    assert [f.code for f in report.findings if f.severity != "info"] == ["GantryTilt"]
