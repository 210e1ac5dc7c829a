"""Figures 4 and 5: the chord lies on the x axis, its angles are those of the tangents, both parts show one slice."""

import numpy as np
import pytest

from cranio_nb.drawing import paper_figures
from cranio_nb.drawing.palette import OUTER, TANGENT


def test_figure_4_has_its_ends_at_0_and_at_l(round_head):
    """The outer ends of a circle lie 2 R sin a apart, and both tangents lean by about a."""
    figure = paper_figures.figure_4(round_head.sliced, round_head.result, round_head.bone)
    ax = figure.axes[0]
    length = 2 * 38 * 1.5 * np.sin(0.6)
    ring = next(line for line in ax.lines if line.get_label() == "end of the balloon").get_xydata()
    np.testing.assert_allclose(ring, [[0, 0], [length, 0]], atol=1e-9)
    texts = {text.get_text() for text in ax.texts}
    lean = np.degrees(0.6 - 1.2 / 40 / 2)  # of the first chord of an arc of 40 steps
    assert {f"L = {length:.0f} mm", f"θ₀ = {lean:.0f}°", f"θ₁ = {180 - lean:.0f}°"} <= texts


def test_figure_4_has_the_arch_above_the_chord_and_the_sides_turned_with_it(round_head):
    ax = paper_figures.figure_4(round_head.sliced, round_head.result, round_head.bone).axes[0]
    arch = next(line for line in ax.lines if line.get_label() == "outer, at rest")
    assert arch.get_color() == OUTER and arch.get_ydata().max() == pytest.approx(57 * (1 - np.cos(0.6)), abs=1e-6)
    # the gap is at the patient's left: out of the head is left, along the chord from front to back
    edges = {text.get_position(): text.get_text() for text in ax.texts}
    assert [edges[at] for at in ((0.5, 0.985), (0.5, 0.015), (0.015, 0.5), (0.985, 0.5))] == ["L", "R", "A", "P"]


def test_figure_4_arcs_end_on_their_tangents(round_head):
    ax = paper_figures.figure_4(round_head.sliced, round_head.result, round_head.bone).axes[0]
    arcs = [line.get_xydata() for line in ax.lines if line.get_color() == TANGENT and len(line.get_xdata()) == 40]
    leans = [np.arctan2(*(arc[-1] - [x, 0])[::-1]) for arc, x in zip(arcs, (0.0, 114 * np.sin(0.6)), strict=True)]
    np.testing.assert_allclose(leans, [0.585, np.pi - 0.585], atol=1e-6)


def test_figure_5_shows_balloons_and_patch_of_one_slice(round_head, letters):
    head = round_head
    figure = paper_figures.figure_5(head.sliced, head.result, head.bone, head.lost)
    curves, patch = figure.axes
    assert letters(figure) == ["(a)", "(b)"]
    assert curves.get_xlim() == patch.get_xlim() and curves.get_ylim() == patch.get_ylim()
    assert len(curves.images) == 1 and len(patch.images) == 2
    named = [text.get_text() for text in figure.legends[0].get_texts()]
    assert {"bone", "patch", "outer, start", "outer, at rest", "inner, start", "inner, at rest"} <= set(named)
