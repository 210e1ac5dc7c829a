"""Figures 8 to 10: parts, one scale for all, colours that mean distances, the farthest node ringed."""

import numpy as np
import pytest
from shapes import ball

from cranio_nb.drawing import figures, paper_figures

LEFT = np.array([1.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def skull():
    return ball(radius=30.0)


@pytest.fixture(scope="module")
def plug():
    return ball((28.0, 0.0, 0.0), 6.0)


def widths(panels):
    return {round(float(np.ptp(ax.get_xlim())), 6) for ax in panels}


def test_figure_8_has_the_open_skull_and_three_views_of_the_repaired_one(skull, plug, letters):
    figure = paper_figures.figure_8(skull, plug, LEFT)
    assert letters(figure) == ["(a)", "(b)", "(c)", "(d)"] and len(widths(figure.axes)) == 1
    titles = [ax.get_title(loc="left") for ax in figure.axes]
    assert "repaired" not in titles[0] and len({title for title in titles if "repaired" in title}) == 3
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["skull", "prosthesis"]


def test_figure_9_rings_the_farthest_node_of_each_map(plug, letters):
    """Seen from the left the front is at the left of the picture, and above is above."""
    distances = np.zeros(len(plug.vertices))
    distances[np.argmax(plug.vertices[:, 2])] = 4.0
    names = ("(a) top", "(b) inner", "(c) another's")
    maps = [paper_figures.DistanceMap(name, plug, plug, distances, LEFT) for name in names]
    figure = paper_figures.figure_9(maps, top_mm=5.0)
    assert letters(figure) == ["(a)", "(b)", "(c)"]
    for ax in figure.axes[:3]:
        ring = next(line for line in ax.lines if line.get_marker() == "o" and len(line.get_xdata()))
        assert ring.get_xydata()[0] == pytest.approx((0, -6), abs=0.6)
    bar = figure.axes[-1]
    assert bar.get_ylabel() == "distance (mm)" and bar.get_ylim() == (0, 5)


def test_figure_10_outlines_the_missing_bone_on_both_patches(skull, plug, letters):
    flat = ball((25.0, 0.0, 0.0), 4.0)
    figure = paper_figures.figure_10(skull, flat, plug, plug, LEFT)
    assert letters(figure) == ["(a)", "(b)"] and len(figure.axes) == 4
    edge_on = [ax for ax in figure.axes if ax.collections]
    assert [ax.get_title(loc="left")[:3] for ax in edge_on] == ["(a)", "(b)"] and len(widths(edge_on)) == 1
    for ax in edge_on:  # seen from the front: the patient's left is to the right
        places = np.concatenate([path.vertices for path in ax.collections[0].get_paths()])
        assert (places.min(axis=0), places.max(axis=0)) == (
            pytest.approx((22, -6), abs=0.6),
            pytest.approx((34, 6), abs=0.6),
        )
    assert figures.png(figure).startswith(b"\x89PNG")
