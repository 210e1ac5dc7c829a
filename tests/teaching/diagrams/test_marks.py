"""What the drawings are made of: one scale both ways, arrows reach from place to place, white stays white."""

import numpy as np
import pytest
from PIL import Image

from cranio_nb.curves import ChordFrame
from cranio_nb.drawing.palette import BLACK, WHITE, rgb_of
from cranio_nb.teaching.diagrams import marks


@pytest.fixture
def ax():
    return marks.plane(marks.sheet(2.0), (0.1, 0.0, 0.6, 0.9), (-3.0, 5.0), 24.0)


def test_a_unit_is_equally_long_both_ways(ax):
    (x0, y0), (x1, y1) = ax.transData.transform([[0.0, 6.0], [1.0, 7.0]])
    assert x1 - x0 == pytest.approx(y1 - y0)


def test_an_arrow_reaches_from_its_tail_to_its_tip(ax):
    marks.arrow(ax, (1.0, 6.0), (4.0, 8.0), BLACK)
    (drawn,) = ax.texts
    assert drawn.xyann == (1.0, 6.0) and drawn.xy == (4.0, 8.0)
    assert drawn.arrow_patch.shrinkA == drawn.arrow_patch.shrinkB == 0


def test_an_arrow_without_length_is_none(ax):
    marks.arrow(ax, (1.0, 6.0), (1.0, 6.0), BLACK)
    assert not ax.texts


def test_an_angle_opens_from_the_x_axis(ax):
    marks.angle(ax, (1.0, 6.0), 2.0, 2.5, BLACK)
    arc = ax.lines[0].get_xydata() - [1.0, 6.0]
    assert np.hypot(*arc.T) == pytest.approx(2.0)
    assert np.arctan2(*arc[[0, -1]].T[::-1]) == pytest.approx([0.0, 2.5])


def test_the_bone_lies_where_the_chord_frame_has_it(ax):
    bone = np.zeros((40, 40), bool)
    bone[12, 30] = True
    frame = ChordFrame(np.array([10.0, 28.0]), np.array([[0.0, 1.0], [1.0, 0.0]]), 5.0)
    x, y = frame.to_chord([12.0, 30.0])  # (2, 2): below the plane
    ax.set(xlim=(-3, 7), ylim=(-3, 7))
    marks.bone_behind(ax, bone, frame)
    (image,) = ax.images
    left, right, bottom, top = image.get_extent()
    seen = np.asarray(image.get_array())[..., 3] > 0
    rows, cols = np.nonzero(seen)
    middle = (
        left + (cols.mean() + 0.5) / seen.shape[1] * (right - left),
        top - (rows.mean() + 0.5) / seen.shape[0] * (top - bottom),
    )
    assert middle == pytest.approx((x, y), abs=0.1)
    assert seen.sum() == 16  # one px of 4 x 4 samples


def test_the_sides_of_a_chord_frame_follow_its_axes():
    frame = ChordFrame(np.zeros(2), np.array([[1.0, 0.0], [0.0, 1.0]]), 5.0)  # along the rows: back; out: left
    assert marks.chord_sides(frame).tolist() == [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]


def test_few_colours_keep_the_ground_white():
    shades = np.full((64, 64, 3), 255, np.uint8)
    shades[:, :32] = np.linspace(0, 255, 64).astype(np.uint8)[:, None, None]
    shades[:, 40:44] = 253  # what fades into the ground
    few = marks.few_colours(Image.fromarray(shades), 8).convert("RGB")
    assert few.getpixel((60, 5)) == few.getpixel((41, 5)) == rgb_of(WHITE) and len(few.getcolors()) <= 8
