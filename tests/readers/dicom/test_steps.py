"""Even, uneven and missing slices: which steps the volume gets, and which scans get none."""

from pathlib import Path

import numpy as np
import pytest
from dicom_series import STEP, head, refusal, save, series

from cranio_nb.readers import read_ct
from data_synth.fault_edits import drop


def test_slices_too_far_apart_are_refused(tmp_path: Path) -> None:
    assert refusal(save(tmp_path / "scan", series(head(), step=6.0))).code == "SlicesTooFarApart"


def test_uneven_slices_too_far_apart_are_refused(tmp_path: Path) -> None:
    heights = np.cumsum([3.0] * 12 + [7.0] * 12)
    assert refusal(save(tmp_path / "scan", series(head(), heights=heights))).code == "SlicesTooFarApart"


def test_slices_too_uneven_are_refused(tmp_path: Path) -> None:
    heights = np.cumsum([0.5] * 12 + [2.5] * 12)
    assert refusal(save(tmp_path / "scan", series(head(), heights=heights))).code == "UnevenSpacing"


def test_missing_slice_is_interpolated_when_allowed(tmp_path: Path) -> None:
    hu = head()
    hu[...] = hu[12]  # the same in every plane, so that interpolation must be exact
    datasets = series(hu)
    drop(11)(datasets)
    volume, report = read_ct(save(tmp_path / "scan", datasets), allow=("gap_fill",))
    np.testing.assert_array_equal(volume.voxels, hu)
    filled = next(f for f in report.findings if f.code == "GapsFilled")
    assert filled.severity == "warning" and filled.values["planes_from_below"] == [11]


def test_positions_in_centimetres_are_remarked_upon(tmp_path: Path) -> None:
    _, report = read_ct(save(tmp_path / "scan", series(head(), step=STEP / 10)))
    assert next(f for f in report.findings if f.code == "SmallSteps").severity == "warning"


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
