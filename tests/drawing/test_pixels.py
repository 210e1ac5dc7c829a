"""Grey values, tints and windows against closed forms."""

import numpy as np
import pytest

from cranio_nb.drawing.palette import BONE, rgb_of
from cranio_nb.drawing.pixels import Window, plain, tinted, windowed


def test_a_grey_window_is_black_and_white_at_its_ends():
    level = windowed(np.array([[-51.0, -50.0, 50.0, 150.0, 151.0]]), 50, 200)
    np.testing.assert_array_equal(level[0, :, 0], [0, 0, 127, 255, 255])


def test_a_tint_changes_what_is_masked_and_nothing_else():
    before = np.random.default_rng(0).integers(0, 255, (5, 7, 3), np.uint8)
    mask = np.arange(35).reshape(5, 7) % 3 == 0
    kept = before.copy()
    after = tinted(before, mask, BONE)
    np.testing.assert_array_equal(before, kept)
    np.testing.assert_array_equal(after[~mask], before[~mask])
    assert (after[mask] == rgb_of(BONE)).all()
    np.testing.assert_array_equal(tinted(before, mask, BONE, 0.0), before)


def test_a_plain_picture_is_of_one_colour():
    assert plain((2, 3, 9)).shape == (2, 3, 3)
    assert (plain((2, 3), BONE) == rgb_of(BONE)).all()


@pytest.mark.parametrize("box", [(0, 0, 200, 100), (10, 20, 100, 300)])
def test_a_window_holds_what_it_is_around_in_its_middle(box):
    window = Window.around(box, (10, 30), (20, 60))
    (x0, y0), (x1, y1) = window.px([10, 30]), window.px([20, 60])
    x, y, width, height = box
    assert x - 1e-9 <= x0 < x1 <= x + width + 1e-9 and y - 1e-9 <= y0 < y1 <= y + height + 1e-9
    assert (x0 + x1) / 2 == pytest.approx(x + width / 2) and (y0 + y1) / 2 == pytest.approx(y + height / 2)
    assert (x1 - x0) / 30 == pytest.approx((y1 - y0) / 10) == window.zoom


def test_a_whole_slice_touches_two_edges():
    window = Window.whole((0, 0, 240, 160), (40, 60))
    np.testing.assert_allclose(window.px([[-0.5, -0.5], [39.5, 59.5]]), [[0, 0], [240, 160]])
