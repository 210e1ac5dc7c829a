"""What every figure has, and that none touches a global state."""

import io
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from cranio_nb.drawing import figures
from cranio_nb.drawing.figures import axes


def test_pictures_leave_no_global_state():
    modules = "cranio_nb.drawing.figures, cranio_nb.output.design_page, cranio_nb.output.comparison_page"
    code = f"import sys, {modules}; sys.exit('matplotlib.pyplot' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], timeout=60, check=False).returncode == 0


def test_a_figure_is_one_axis_over_all_of_it():
    figure, ax = figures.new_figure(3.0, 2.0)
    assert figure.axes == [ax] and ax.get_position().bounds == (0, 0, 1, 1)
    width, height = Image.open(io.BytesIO(figures.png(figure))).size
    assert (width, height) == (3 * figures.DPI, 2 * figures.DPI)


def test_equal_figures_are_equal_files():
    first, second = (figures.png(figures.colour_bar_figure(2.0, "Distance (mm)")) for _ in range(2))
    assert first == second


@pytest.mark.parametrize("limits", [(0, 100), (100, 0)])
def test_a_scale_bar_is_as_long_as_it_says(limits):
    _, ax = figures.new_figure(2, 2)
    ax.set_xlim(limits)
    figures.scale_bar(ax, 20.0)
    low, high = sorted(ax.lines[-1].get_xdata())
    assert high - low == pytest.approx(20) and 0 <= low and high <= 100
    assert ax.texts[-1].get_text() == "20 mm"


def test_pixels_are_shown_one_for_one():
    rgb = np.random.default_rng(0).integers(0, 255, (44, 66, 3), np.uint8)
    figure, _ = axes.show_pixels(rgb)
    shown = np.asarray(Image.open(io.BytesIO(figures.png(figure))).convert("RGB"))
    np.testing.assert_array_equal(shown, rgb)


def test_sides_are_named_at_their_edges():
    _, ax = figures.new_figure(2, 2)
    axes.name_sides(ax, np.array([[1.0, 0, 0], [0, 0, -1.0]]))
    places = {text.get_text(): text.get_position() for text in ax.texts}
    assert places == {"L": (0.985, 0.5), "R": (0.015, 0.5), "S": (0.5, 0.985), "I": (0.5, 0.015)}


def test_a_mask_is_filled_where_it_is_and_clear_elsewhere():
    _, ax = figures.new_figure(2, 2)
    mask = np.array([[True, False], [False, False]])
    axes.fill_mask(ax, mask, (0, 2, 2, 0), "#0000FF", alpha=0.5)
    np.testing.assert_array_equal(ax.images[0].get_array()[0, 0], [0, 0, 1, 0.5])
    assert not ax.images[0].get_array()[~mask].any()


def test_the_colour_scale_ends_at_its_top():
    scale = figures.colour_scale(4.0)
    low, high, beyond = scale.to_rgba([0.0, 4.0, 40.0])
    assert tuple(high) == tuple(beyond) and high[0] > 0.9 and low[2] > low[0]
    bar = figures.colour_bar_figure(4.0, "Distance (mm)")
    assert bar.axes[0].get_xlabel() == "Distance (mm)" and bar.axes[0].get_xlim() == (0, 4)
