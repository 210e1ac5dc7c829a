"""Figures 4 and 5 of the paper: the coordinates of a balloon, and both balloons of a slice at rest.

Frames: a slice of a design, (row, col) in its own unit; its chord frame (along, out); drawn in mm.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...curves import ChordFrame
from ...methods.slicewise.slices import SlicedDesign, SliceResult
from ...vault import slicing
from ...volume import Volume
from .. import figures
from ..figures import Axes, Figure
from ..palette import BLACK, BONE, GREY, OUTER, TANGENT

_AROUND_MM = 16.0  # shown beside the chord and above and below it
_PIXEL_MM = 0.25
_ARM_MM = 13.0  # radius of the arcs of the angles
_WIDE_RAD = 1.0  # an angle that its name fits into


def figure_4(sliced: SlicedDesign, result: SliceResult, bone: Volume) -> Figure:
    """Coordinate system used to set up the outer balloon: both ends on the x axis, at 0 and at L.

    Parameters
    ----------
    sliced : SlicedDesign
    result : SliceResult
        One of ``sliced.slices`` with balloons.
    bone : Volume
        Bool mask.

    Returns
    -------
    Figure
        One axis, in mm along the chord and out of the head.
    """
    unit, (ends, *_), frame = sliced.unit, result.ends, sliced.frames[result.plane]
    chord = ChordFrame.of(ends, _centre(sliced, frame))
    length, (theta0, theta1) = unit * chord.length, chord.end_angles(ends)
    figure, panels = figures.panel_figure([["chord"]], 8.0, 3.6)
    ax = panels["chord"]
    ax.set(xlim=(-_AROUND_MM, length + _AROUND_MM), ylim=(-0.8 * _AROUND_MM, 1.1 * _AROUND_MM), aspect="equal")
    ax.spines[:].set_visible(False)
    _show_bone(ax, chord, frame, bone, unit)
    for curve, style, name in ((result.start[0], (0, (4, 2)), "start"), (result.curves[0], "-", "at rest")):
        ax.plot(*unit * chord.to_chord(curve).T, color=OUTER, ls=style, lw=1.8, label=f"outer, {name}")
    _draw_axes(ax, length)
    for x, angle, name in ((0.0, theta0, "θ₀"), (length, theta1, "θ₁")):
        _draw_angle(ax, x, angle, name)
    world = (chord.axes * [[1], [-1]]) @ frame[1:]
    figures.name_sides(ax, world)
    figures.scale_bar(ax, 10.0)
    figures.key(figure, columns=5)
    return figure


def figure_5(sliced: SlicedDesign, result: SliceResult, bone: Volume, patch: Volume) -> Figure:
    """(a) Balloon results. (b) Prosthesis patch (in blue).

    Parameters
    ----------
    sliced : SlicedDesign
    result : SliceResult
        One of ``sliced.slices``.
    bone, patch : Volume
        Bool masks.

    Returns
    -------
    Figure
    """
    figure, panels = figures.panel_figure([["a", "b"]], 7.4, 4.4)
    figures.show_frame(panels["a"], sliced)
    window = panels["a"].get_xlim(), panels["a"].get_ylim()
    for ax, shown, title in ((panels["a"], None, "(a) balloons"), (panels["b"], patch, "(b) patch")):
        ax.set(xlim=window[0], ylim=window[1], aspect="equal")
        figures.show_areas(ax, sliced, result, bone, shown)
        figures.name_sides(ax, sliced.frames[result.plane][[2, 1]])
        figures.scale_bar(ax, 20.0)
        figures.name_panel(ax, title)
    figures.draw_curves(panels["a"], sliced, result)
    figures.key(figure)
    return figure


def _centre(sliced: SlicedDesign, frame: NDArray[np.float64]) -> NDArray[np.float64]:
    """The head's centre in a slice, (row, col) in its unit."""
    origin, row, col = frame
    away = sliced.opening.head_centre - origin
    return np.array([away @ axis / (axis @ axis) for axis in (row, col)])


def _show_bone(ax: Axes, chord: ChordFrame, frame: NDArray[np.float64], bone: Volume, unit: float) -> None:
    """Show the bone of a slice in its chord frame."""
    along, out = chord.axes @ frame[1:]
    turned = np.stack([frame[0] + chord.origin @ frame[1:], out, along])
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    rows, cols = np.arange(top, bottom, -_PIXEL_MM), np.arange(left, right, _PIXEL_MM)
    mask = slicing.sample_mask(bone, turned, rows / unit, cols / unit)
    figures.fill_mask(ax, mask, (left, right, bottom, top), BONE)
    ax.fill([], [], color=BONE, label="bone")


def _draw_axes(ax: Axes, length: float) -> None:
    """Draw the axes x and y, the chord's ends on x, and its length L below."""
    arrow = {"arrowstyle": "-|>", "color": BLACK, "lw": 1.0, "shrinkA": 0, "shrinkB": 0}
    for tip, name in (((length + 0.95 * _AROUND_MM, 0.0), "x"), ((0.0, 0.95 * _AROUND_MM), "y")):
        ax.annotate("", tip, (0.0, 0.0), arrowprops=arrow)
        ax.text(tip[0] - 2.5, tip[1] - 1.0, name, fontsize=11, style="italic", va="top")
    ax.plot([0.0, length], [0.0, 0.0], ls="none", marker="o", ms=5, mfc="white", mec=BLACK, label="end of the balloon")
    low = -0.45 * _AROUND_MM
    ax.annotate("", (0.0, low), (length, low), arrowprops={"arrowstyle": "<->", "color": GREY, "lw": 1.0})
    ax.vlines([0.0, length], low, 0.0, color=GREY, lw=0.8, ls=":")
    ax.text(length / 2, low, f"L = {length:.0f} mm", ha="center", va="center", fontsize=10, backgroundcolor="white")


def _draw_angle(ax: Axes, x: float, angle: float, name: str) -> None:
    """Draw the tangent at an end of the chord, and the angle that it makes with the x axis."""
    turn = np.linspace(0.0, angle, 40)
    ax.plot(x + _ARM_MM * np.cos(turn), _ARM_MM * np.sin(turn), color=TANGENT, lw=1.2)
    tip = 1.6 * _ARM_MM * np.array([np.cos(angle), np.sin(angle)])
    arrow = {"arrowstyle": "-|>", "color": TANGENT, "lw": 1.6, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", (x + tip[0], tip[1]), (x, 0.0), arrowprops=arrow)
    ax.plot([], [], color=TANGENT, lw=1.6, label="tangent at an end")
    # within the angle where there is room, or else above it
    middle = angle / 2 if angle > _WIDE_RAD else angle + 0.4
    at = x + _ARM_MM * np.cos(middle), 1.1 * _ARM_MM * np.sin(middle)
    ax.text(*at, f"{name} = {np.degrees(angle):.0f}°", fontsize=11, color=TANGENT, ha="center", va="bottom")
