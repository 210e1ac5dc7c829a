"""What several panels draw: histograms count every voxel in range, colours follow the distance."""

import numpy as np
import pytest

from cranio_nb.drawing.canvas import Canvas
from cranio_nb.drawing.canvas_axes import Chart
from cranio_nb.drawing.pixels import Window
from cranio_nb.mesh import Mesh
from cranio_nb.teaching.widgets import parts
from cranio_nb.volume import Volume


def test_a_histogram_counts_what_lies_in_its_range(ct):
    edges, counts = parts.count_hu(ct.voxels)
    low, high = parts.HU_RANGE
    assert (edges[0], edges[-1]) == (low, high) and len(edges) == len(counts) + 1
    assert counts.sum() == np.count_nonzero((ct.voxels >= low) & (ct.voxels <= high))


def test_colours_stop_at_the_upper_end_and_unknown_is_white():
    shown = parts.coloured(np.array([[0.0, 1.0, 2.0, 50.0, np.nan]], np.float32), 2.0)[0]
    assert (shown[2] == shown[3]).all() and (shown[4] == 255).all()
    brightness = shown[:3].sum(axis=1, dtype=int)
    assert (np.diff(brightness) > 0).all()


@pytest.mark.parametrize("towards", [(1, 0, 0), (0, 1, 0), (0.3, -0.5, 0.8)])
def test_a_pixel_fits_a_ball_of_any_direction(towards):
    rng = np.random.default_rng(0)
    points = rng.normal(size=(5000, 3))
    ball = Mesh(10 * points / np.linalg.norm(points, axis=1, keepdims=True), np.zeros((0, 3), int))
    assert parts.pixel_to_fit(ball, towards, 100) == pytest.approx(0.2, rel=0.01)


def test_the_window_holds_what_is_shown_in_any_slice():
    mask = np.zeros((2, 90, 70), bool)
    mask[0, 5, 40], mask[1, 80, 3] = True, True
    (x, y), (u, v) = parts.left_window(mask).px([[5, 40], [80, 3]])
    assert 24 < y < v < parts.HEIGHT - 24 and 24 < u < x < parts.LEFT - 24


def test_the_scale_runs_from_its_lower_to_its_upper_end():
    canvas = Canvas(220, 60)
    parts.draw_colour_scale(canvas, (10, 5), 200, 3.0)
    ends = canvas.array()[12, [12, 208]].astype(int)
    wanted = parts.coloured(np.array([[0.0, 3.0]], np.float32), 3.0)[0]
    assert np.abs(ends - wanted).max() < 12


def test_the_letters_of_a_slice_follow_its_affine():
    """A grid whose columns run to the patient's right and whose rows run to the front has R, L, P and A changed."""
    pictures = {}
    for name, sign in (("upright", 1.0), ("turned", -1.0)):
        affine = np.array([[0, 0, sign, 0], [0, sign, 0, 0], [1.0, 0, 0, 0], [0, 0, 0, 1]])
        canvas = Canvas(120, 120)
        grid = Volume(np.zeros((1, 60, 60), bool), affine)
        parts.annotate_slice(canvas, Window.whole((0, 0, 120, 120), (60, 60)), grid, 0)
        pictures[name] = canvas.array()
    wanted = Canvas(120, 120)
    wanted.sides((0, 0, 120, 120), (-1, 0, 0), (0, -1, 0))
    top, right = np.s_[:24, 50:70], np.s_[50:70, 96:]
    for edge in (top, right):
        np.testing.assert_array_equal(pictures["turned"][edge], wanted.array()[edge])
        assert (pictures["upright"][edge] != wanted.array()[edge]).any()


def test_the_ends_of_an_axis_have_the_letters_of_the_sides_it_leads_to():
    """Turned round, the axis has its two letters exchanged."""
    chart, ink = Chart((0, 0, 200, 120), (0, 1), (0, 1)), {}
    for way in (1, -1):
        canvas = Canvas(200, 120)
        parts.name_ends(canvas, chart, (0, way, 0))
        x, y, width, height = map(round, chart.area)
        row = canvas.array()[y + height - 22 : y + height - 2] < 128
        ink[way] = [int(row[:, at : at + 20].sum()) for at in (x, x + width - 20)]
    assert ink[1] == ink[-1][::-1] and ink[1][0] != ink[1][1] and all(ink[1])
