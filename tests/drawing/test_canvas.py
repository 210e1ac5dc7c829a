"""What is drawn on a canvas is where it was put, in the colour that was named."""

import numpy as np
import pytest

from cranio_nb.drawing.canvas import Canvas, round_length
from cranio_nb.drawing.palette import BLACK, BLUE, rgb_of
from cranio_nb.drawing.pixels import Window
from cranio_nb.drawing.shading import view_axes


def places(canvas, colour=BLUE):
    """(x, y) of the pixels of a colour."""
    return np.argwhere((canvas.array() == rgb_of(colour)).all(axis=2))[:, ::-1]


def test_a_slice_is_where_its_window_says():
    rgb = np.zeros((40, 60, 3), np.uint8)
    rgb[10, 20] = 255
    canvas, window = Canvas(240, 160), Window.whole((0, 0, 240, 160), rgb.shape)
    canvas.show(rgb, window)
    y, x = np.argwhere(canvas.array()[..., 0] > 128).mean(axis=0)
    np.testing.assert_allclose(window.px([10, 20]), [x + 0.5, y + 0.5], atol=0.6)


def test_a_box_is_filled_to_its_edges():
    canvas = Canvas(60, 40)
    canvas.area((10, 5, 20, 8), BLUE)
    found = places(canvas)
    assert (found.min(axis=0) == (10, 5)).all() and (found.max(axis=0) == (29, 12)).all() and len(found) == 160


@pytest.mark.parametrize("size", [(0, 5), (5, -1)])
def test_a_box_without_size_is_not_drawn(size):
    canvas = Canvas(20, 20)
    canvas.area((5, 5, *size), BLUE)
    assert (canvas.array() == 255).all()


def test_dashes_are_as_long_as_they_say():
    canvas = Canvas(100, 20)
    canvas.line([(0, 10), (100, 10)], BLUE, width=4, dash=(10, 10))
    drawn = (canvas.array()[10] == rgb_of(BLUE)).all(axis=1)
    assert drawn.sum() == pytest.approx(50, abs=5) and np.count_nonzero(np.diff(drawn.astype(int))) == 9


def test_a_disc_has_its_radius():
    canvas = Canvas(60, 60)
    canvas.dots([(30, 30)], BLUE, radius=20)
    found = places(canvas)
    assert len(found) == pytest.approx(np.pi * 20**2, rel=0.05)
    np.testing.assert_allclose(found.mean(axis=0), (30, 30), atol=0.6)


def test_an_arrow_ends_at_its_tip():
    canvas = Canvas(100, 40)
    canvas.arrow((10, 20), (80, 20), BLUE)
    found = np.argwhere((canvas.array() < 250).any(axis=2))[:, ::-1]
    assert found[:, 0].max() == pytest.approx(80, abs=1.5) and found[:, 0].min() == pytest.approx(10, abs=1.5)


def test_pixels_are_placed_one_for_one_and_a_copy_is_apart():
    rgb = np.random.default_rng(0).integers(0, 255, (7, 9, 3), np.uint8)
    canvas = Canvas(30, 20)
    before = canvas.copy()
    canvas.place(rgb, 5, 6)
    np.testing.assert_array_equal(canvas.array()[6:13, 5:14], rgb)
    assert (before.array() == 255).all()
    before.inlay(canvas, 0, 0)
    np.testing.assert_array_equal(before.array(), canvas.array())


def test_a_scale_bar_is_as_long_as_asked():
    canvas = Canvas(120, 40)
    canvas.scale_bar(10, 30, 80, "20 mm")
    bar = np.flatnonzero((canvas.array()[30] == rgb_of(BLACK)).all(axis=1))
    assert np.ptp(bar) + 1 == pytest.approx(78, abs=2)


def test_a_legend_shows_each_colour():
    canvas = Canvas(200, 120)
    canvas.legend(5, 5, [(BLUE, kind, kind) for kind in ("line", "dash", "dot", "area")])
    rows = np.unique(places(canvas)[:, 1] // 18)
    assert len(rows) >= 4


@pytest.mark.parametrize(("longest", "length"), [(0.9, 0.5), (7.0, 5.0), (10.0, 10.0), (49.0, 20.0)])
def test_round_lengths(longest, length):
    assert round_length(longest) == length


def test_the_letters_are_those_of_the_view():
    shown, wanted = Canvas(100, 80), Canvas(100, 80)
    shown.sides((0, 0, 100, 80), *view_axes((1, 0, 0))[:2])  # from the left: the face is at the left
    for at, letter in (((88, 40), "P"), ((12, 40), "A"), ((50, 68), "I"), ((50, 12), "S")):
        wanted.text(*at, letter, size=14, anchor="mm", halo=True)
    assert (shown.array() == wanted.array()).all()
