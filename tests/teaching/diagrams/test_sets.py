"""The drawn B and S: blue pixels lie outside the drawn hull, orange ones within it, and both make the boundary."""

import numpy as np
import pytest
from skimage.measure import points_in_poly

from cranio_nb.drawing.palette import INNER, OUTER
from cranio_nb.stages.feature_extraction import extract_features
from cranio_nb.teaching.diagrams import boundary_sets, marks
from cranio_nb.teaching.diagrams.sets import corner_of_window, draw_sets


@pytest.fixture
def bone(ring):
    return ring(60, 68, half_gap=22.0, towards=90.0)


def test_the_two_sets_part_the_boundary_at_the_hull(bone):
    seen = extract_features(bone)
    ax = marks.plane(marks.sheet(3.0), (0, 0, 1, 1), (0, 0), 201.0)
    draw_sets(ax, bone, seen, size=2.0)
    drawn = {line.get_markerfacecolor(): line.get_xydata() for line in ax.lines}
    hull = ax.patches[0].get_xy()
    inside = {colour: points_in_poly(drawn[colour], hull) for colour in (OUTER, INNER)}
    assert not inside[OUTER].any() and inside[INNER].mean() > 0.99  # a pixel may lie on the edge
    together = {tuple(point) for colour in (OUTER, INNER) for point in drawn[colour][:, ::-1]}
    assert together == {tuple(point) for point in seen.boundary}


def test_the_window_lies_in_the_slice_and_shows_bone(bone):
    spine = extract_features(bone).skeleton[0]
    row, col = np.ceil(corner_of_window(spine, bone.shape)).astype(int)
    assert row >= 0 and col >= 0 and bone[row : row + 20, col : col + 20].any()


def test_the_line_counts_both(bone):
    seen = extract_features(bone)
    line = boundary_sets(seen, bone, px=1.0).line
    assert line == f"boundary: {len(seen.outer)} px outer, {len(seen.inner)} px inner"
