"""Views and distance maps: from where, with the sides named, at the scale and in the colours they claim."""

import numpy as np
import pytest
from shapes import ball

from cranio_nb.drawing import figures
from cranio_nb.mesh import Mesh


def test_three_views_show_the_opening():
    views = figures.views_of([(0.9, 0.1, 0.4)])
    assert list(views) == ["facing the opening", "from the left", "from above"]
    np.testing.assert_allclose(views["facing the opening"], (0.9, 0.1, 0.4))
    assert list(figures.views_of([(1, 0, 0), (-0.9, 0, 0.1), (-0.9, 0, 0.1)]))[1] == "from the right"
    three = figures.views_of([(0.8, 0, 0.6), (-0.4, 0.8, 0.4), (0, -1, 0)])
    assert set(three) == {"facing the opening", "from the front", "from the back"}


def test_distance_map_has_the_colours_of_its_scale():
    mesh = ball()
    figure = figures.distance_figure(mesh, mesh, np.full(len(mesh.vertices), 1.0), (0, -1, 0), top_mm=2.0)
    shown = np.asarray(figure.axes[0].images[0].get_array())
    middle = shown[shown.shape[0] // 2, shown.shape[1] // 2]
    np.testing.assert_allclose(middle, figures.colour_scale(2.0).to_rgba(1.0)[:3], atol=0.01)
    assert "mm" in figure.axes[0].texts[-1].get_text()


def test_view_names_the_patients_sides():
    figure = figures.view_figure(figures.skull_view(ball(radius=30), (0, -1, 0)), ball((0, -25, 0), 8))
    places = {t.get_text(): t.get_position() for t in figure.axes[0].texts}
    assert places["L"][0] > places["R"][0] and "S" in places and "50 mm" in places
    bar = figure.axes[0].lines[-1].get_xdata()
    assert np.ptp(bar) * 0.6 == pytest.approx(50)


@pytest.mark.parametrize("place", [(0, -40, 0), (0, -40, 29), (55, 0, 0)], ids=["within", "at the rim", "far out"])
def test_a_prosthesis_is_seen_whole_wherever_it_stands(place):
    """A blue ball of 8 mm before or beside the skull has its own area in the picture, at 0.6 mm for each pixel."""
    view = figures.skull_view(ball(radius=30), (0, -1, 0))
    rgb = np.asarray(figures.view_figure(view, ball(place, 8)).axes[0].images[0].get_array())
    blue = (rgb[..., 2] > rgb[..., 0] + 0.1).sum() * 0.6**2
    assert blue == pytest.approx(np.pi * (8 + 0.6 / 2) ** 2, rel=0.06)  # a pixel counts that it touches


def test_without_a_skull_the_prosthesis_stands_alone():
    nothing = Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.intp))
    figure = figures.view_figure(figures.skull_view(nothing, (0, -1, 0)), ball(radius=8))
    assert figure.axes[0].images[0].get_array().shape[1] == pytest.approx((16 + 2) / 0.6 + 2 * 14, abs=2)


def test_the_farthest_node_is_ringed():
    """A ball from the front: its leftmost node is seen at the right edge of the ball, half-way up."""
    mesh = ball()
    distances = np.zeros(len(mesh.vertices))
    distances[np.argmax(mesh.vertices[:, 0])] = 3.0
    figure = figures.distance_figure(mesh, mesh, distances, (0, -1, 0), top_mm=2.0, px_mm=0.2)
    ring = next(line for line in figure.axes[0].lines if line.get_marker() == "o")
    shown = np.asarray(figure.axes[0].images[0].get_array())
    rows, cols = np.nonzero((shown < 1).any(axis=-1))
    assert ring.get_xdata()[0] == pytest.approx(cols.max(), abs=1.5)
    assert ring.get_ydata()[0] == pytest.approx((rows.min() + rows.max()) / 2, abs=1.5 / 0.2)
