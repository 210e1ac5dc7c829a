"""The panel of gap ends says what the stage finds."""

from types import SimpleNamespace

import numpy as np
import pytest

from cranio_nb.curves import ChordFrame, GapEnds
from cranio_nb.drawing.canvas import Canvas
from cranio_nb.drawing.palette import BLACK, rgb_of
from cranio_nb.drawing.pixels import Window
from cranio_nb.stages import feature_extraction
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets import feature_extraction as panel_module


def middle_plane(opening):
    return int(np.median(np.flatnonzero(opening.voxels.any((1, 2)))))


def test_the_features_line_counts_the_points_of_the_stage(static, skull, opening):
    bone, plane, px = skull(), middle_plane(opening), float(skull().spacing[1])
    panel = widgets.features(bone, plane, opening=opening).set(skip_mm=5.0, reach_mm=12.0)
    seen = feature_extraction.extract_features(bone.voxels[plane])
    ends = feature_extraction.find_gap_ends(seen, opening.voxels[plane], skip_px=5 / px, reach_px=12 / px)
    width = np.hypot(*np.diff(ends[0].points, axis=0)[0]) * px
    assert f"{width:.1f} mm apart" in panel.view.line
    # angles of the outer ends, with the middle of the grid, which lies in the head, for the inside
    frame = ChordFrame.of(ends[0], np.array(bone.shape[1:]) / 2)
    theta0, theta1 = np.degrees(frame.end_angles(ends[0]))
    assert f" apart, theta0 {theta0:.1f}, theta1 {theta1:.1f} degrees; " in panel.view.line


@pytest.mark.parametrize("longer", [0.5, 1.0, 1.6])
def test_in_a_circle_the_angles_to_expect_are_those_of_the_longer_gap(skull, longer):
    radius, lean = 100.0, np.radians(25)
    way = np.linspace(-lean, lean, 51)
    arc = radius * np.column_stack([np.sin(way), np.cos(way)])
    angles = np.degrees([lean, np.pi - lean])
    case = SimpleNamespace(true_curves=lambda plane: (arc,), true_angles=lambda plane: (angles,))
    part = panel_module.Slices(skull(), None, case)
    theta0, theta1 = part.expected(0, longer * 2 * radius * np.sin(lean))
    assert theta0 == pytest.approx(np.degrees(np.arcsin(longer * np.sin(lean)))) and theta0 + theta1 == 180
    assert panel_module.Slices(skull(), None, None).expected(0, 50.0) is None


def test_the_line_says_what_to_expect_where_the_truth_is_known(static, skull, opening):
    plane = middle_plane(opening)
    arc, angles = np.array([[0.0, 0.0], [0.0, 60.0]]), np.array([10.0, 170.0])
    case = SimpleNamespace(true_curves=lambda plane: (arc,), true_angles=lambda plane: (angles,))
    panel = widgets.features(skull(), plane, opening=opening, case=case).set(skip_mm=5.0, reach_mm=12.0)
    assert panel.view.line.count("(expect ") == 2


def test_a_slice_without_a_gap_says_so(static, skull, opening):
    line = widgets.features(skull(), 2, opening=opening).view.line
    assert line.startswith("Slice 2: ") and "carry" not in line


def test_the_line_drawn_is_the_line_fitted_through_the_mean_of_the_points():
    # points along a row, the end of the gap 10 px beside their line
    points = np.column_stack([np.full(31, 20.0), np.arange(10.0, 41)])
    ends = GapEnds(np.array([[30.0, 50.0]]), np.array([[0.0, 1.0]]))
    canvas = Canvas(100, 60)
    fit = panel_module.Fit(ends, (points,))
    panel_module._draw_ends(canvas, Window((0, 0, 100, 60), (0, 60), (0, 100)), [fit], 1.0, 0.1)
    black = (canvas.array() == rgb_of(BLACK)).all(axis=-1)
    rows, cols = np.nonzero(black[:, :42])
    assert set(rows) <= {19, 20} and cols.min() <= 11 and cols.max() >= 39
