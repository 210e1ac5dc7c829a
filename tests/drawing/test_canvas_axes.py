"""A chart puts values where its axes say."""

import numpy as np
import pytest

from cranio_nb.drawing.canvas import Canvas
from cranio_nb.drawing.canvas_axes import Chart
from cranio_nb.drawing.palette import BLUE, rgb_of

BOX = (0, 0, 270, 266)  # its plotted area is 200 x 200


def blue(canvas):
    return np.argwhere((canvas.array() == rgb_of(BLUE)).all(axis=2))[:, ::-1]


def test_values_are_laid_out_evenly_and_kept_inside():
    chart = Chart(BOX, (0, 10), (-1, 1))
    x, y, width, height = chart.area
    np.testing.assert_allclose(
        chart.px([[0, -1], [5, 0], [10, 1]]), [[x, y + height], [x + 100, y + 100], [x + 200, y]]
    )
    np.testing.assert_allclose(chart.px([[-5, 9]]), [[x, y]])
    assert (width, height) == (200, 200)


def test_a_logarithmic_axis_gives_each_power_the_same_room():
    chart = Chart(BOX, (0, 1), (1e-4, 1), log=True)
    assert np.diff(chart.px([[0, 10.0**-n] for n in range(5)])[:, 1]) == pytest.approx([50] * 4)


def test_bars_are_as_high_as_their_counts():
    chart, canvas = Chart(BOX, (0, 4), (0, 10)), Canvas(270, 266)
    counts = np.array([1.0, 4.0, 0.0, 10.0])
    chart.bars(canvas, np.arange(5.0), counts, BLUE)
    assert len(blue(canvas)) == pytest.approx(counts.sum() / 10 * 200 * 50, rel=0.03)


def test_lines_are_at_their_values():
    chart, canvas = Chart(BOX, (0, 4), (0, 10)), Canvas(270, 266)
    chart.upright(canvas, 1.0, BLUE)
    assert np.median(blue(canvas)[:, 0]) == pytest.approx(chart.px([[1, 0]])[0, 0], abs=1)
    canvas = Canvas(270, 266)
    chart.level(canvas, 5.0, BLUE)
    assert np.ptp(blue(canvas)[:, 0]) == pytest.approx(200, abs=2)


@pytest.mark.parametrize("log", [False, True])
def test_a_frame_is_drawn_with_its_ticks(log):
    plain, framed = Canvas(270, 266), Canvas(270, 266)
    Chart(BOX, (0, 4), (0.01, 10), log=log).frame(framed, "Energy", "step")
    dark = (framed.array() < 128).all(axis=2)
    x, y, _, height = Chart(BOX, (0, 4), (0.01, 10)).area
    assert dark[y : y + height, x - 1 : x + 2].any(axis=1).all() and (plain.array() == 255).all()
