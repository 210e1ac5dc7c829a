"""The canvas of the panels: grey windows, places of pixels, round lengths."""

import numpy as np
import pytest

from cranio_nb.drawing.canvas import Canvas, Window, round_length, windowed


def test_a_grey_window_is_black_and_white_at_its_ends():
    level = windowed(np.array([[-51.0, -50.0, 50.0, 150.0, 151.0]]), 50, 200)
    np.testing.assert_array_equal(level[0, :, 0], [0, 0, 127, 255, 255])


def test_a_canvas_puts_a_slice_where_its_window_says():
    rgb = np.zeros((40, 60, 3), np.uint8)
    rgb[10, 20] = 255
    canvas, window = Canvas(240, 160), Window.whole((0, 0, 240, 160), rgb.shape)
    canvas.show(rgb, window)
    y, x = np.argwhere(canvas.array()[..., 0] > 128).mean(axis=0)
    np.testing.assert_allclose(window.px([10, 20]), [x + 0.5, y + 0.5], atol=0.6)


@pytest.mark.parametrize(("longest", "length"), [(0.9, 0.5), (7.0, 5.0), (10.0, 10.0), (49.0, 20.0)])
def test_round_lengths(longest, length):
    assert round_length(longest) == length
