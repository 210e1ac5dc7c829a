"""How B and S part the outer from the inner boundary of a slice (the paper, section 2), in a whole slice and close by.

Frame: slice (row, col) px, drawn with columns to the right and rows down, in px.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import spatial

from ...curves import Points, SliceFeatures
from ...drawing.described import Described
from ...drawing.figures import Axes, Figure
from ...drawing.figures.axes import fill_mask
from ...drawing.palette import BLACK, BONE, INNER, MEASURE, OUTER, PALE, TITLE_PT, WHITE
from . import marks

_HEIGHT_IN = 4.4
_LEFT = 0.47  # of the drawing, for the whole slice
_CLOSE_PX = 22  # columns shown close by
_MARGIN_PX = 13
_WHOLE_SLICE = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # columns lead left, rows back
_NAMES = ("outer = B \N{MINUS SIGN} S", "inner = B \N{INTERSECTION} S")


def boundary_sets(seen: SliceFeatures, bone: NDArray[np.bool_], *, px: float) -> Described:
    """Draw boundary, skeleton and hull of a slice, and the two boundaries they give.

    Parameters
    ----------
    seen : SliceFeatures
        Of the slice.
    bone : ndarray of bool, shape (R, C)
        The bone of a slice; rows lead to the back, columns to the patient's left.
    px : float
        Size of a pixel, mm.

    Returns
    -------
    Described
    """
    figure = marks.sheet(_HEIGHT_IN)
    spine = np.vstack(seen.skeleton)
    whole = _upright(figure, (0.0, 0.0, _LEFT, 1.0), *_around(seen.boundary, _LEFT))
    draw_sets(whole, bone, seen, size=1.6)
    marks.sides(whole, _WHOLE_SLICE)
    marks.word(
        whole,
        seen.boundary.mean(axis=0)[::-1],
        "S: the filled hull\nof the skeleton",
        bbox={"fc": "none", "ec": "none"},
    )
    marks.scale(whole, 50 / px, "50 mm")
    at = corner_of_window(spine, bone.shape)
    close = _upright(figure, (_LEFT + 0.01, 0.0, 0.99 - _LEFT, 1.0), at, _CLOSE_PX)
    draw_sets(close, bone, seen, size=9.5)
    _frame_window(whole, close)
    _name_sets(close, seen, spine)
    whole.text(0.01, 0.98, "a slice", transform=whole.transAxes, fontsize=TITLE_PT, weight="bold", va="top")
    close.text(0.02, 0.98, "close by", transform=close.transAxes, fontsize=TITLE_PT, weight="bold", va="top")
    alt = (
        "An open ring of bone with the convex hull of its middle line, and a piece of it close by: boundary pixels "
        "outside the hull are the outer boundary, those within it the inner one."
    )
    return marks.finished(figure, alt, f"boundary: {len(seen.outer)} px outer, {len(seen.inner)} px inner")


def corner_of_window(spine: Points, shape: tuple[int, int]) -> Points:
    """Where the part shown close by begins: around what lies farthest to the right and to the front.

    Parameters
    ----------
    spine : ndarray, shape (K, 2)
        (row, col) px.
    shape : tuple of int
        Rows and columns of the slice.

    Returns
    -------
    ndarray, shape (2,)
        First row and column, px.
    """
    row, col = spine[np.argmin(spine.sum(axis=1))]
    high = _CLOSE_PX * _HEIGHT_IN / ((0.99 - _LEFT) * marks.WIDTH_IN)
    corner = np.array([row - high / 2, col - _CLOSE_PX / 2])
    return np.clip(np.rint(corner), 0, np.array(shape) - [high, _CLOSE_PX]) - 0.5


def _upright(figure: Figure, box: tuple[float, float, float, float], corner: Points, width: float) -> Axes:
    """A plane whose rows run down from a corner."""
    ax = marks.plane(figure, box, corner[::-1], width)
    ax.invert_yaxis()
    return ax


def _around(points: Points, share: float) -> tuple[Points, float]:
    """Upper left corner and width, px, of a plane around points, in a part of the drawing of some width."""
    low, high = points.min(axis=0) - _MARGIN_PX, points.max(axis=0) + _MARGIN_PX
    aspect = _HEIGHT_IN / (share * marks.WIDTH_IN)
    width = max(high[1] - low[1], (high[0] - low[0]) / aspect)
    return (low + high) / 2 - np.array([aspect, 1.0]) * width / 2, float(width)


def draw_sets(ax: Axes, bone: NDArray[np.bool_], seen: SliceFeatures, *, size: float) -> None:
    """Draw bone, filled hull, its edge, spine, and both boundaries, in one plane.

    Parameters
    ----------
    ax : Axes
        In px: columns to the right, rows down.
    bone : ndarray of bool, shape (R, C)
    seen : SliceFeatures
    size : float
        Of a pixel's mark, points.
    """
    spine = np.vstack(seen.skeleton)
    limits = ax.get_xlim(), ax.get_ylim()
    rows, cols = bone.shape
    fill_mask(ax, bone, (-0.5, cols - 0.5, rows - 0.5, -0.5), BONE)
    corners = spine[spatial.ConvexHull(spine).vertices]
    ax.fill(*corners.T[::-1], fc=PALE, ec="none", alpha=0.6)
    ax.fill(*corners.T[::-1], fc="none", ec=MEASURE, lw=1.4, ls=(0, (4, 2)))
    for points, colour, marker in ((seen.outer, OUTER, "s"), (seen.inner, INNER, "o")):
        ax.plot(*points.T[::-1], ls="none", marker=marker, ms=size, mfc=colour, mec=WHITE, mew=0.04 * size)
    ax.plot(*spine.T[::-1], ls="none", marker=".", ms=0.9 * size, mfc=BLACK, mec="none")
    ax.set(xlim=limits[0], ylim=limits[1], aspect="auto")


def _frame_window(whole: Axes, close: Axes) -> None:
    """Frame what is shown close by, in the whole slice and in the part itself."""
    (left, right), (bottom, top) = close.get_xlim(), close.get_ylim()
    box = np.array([[left, top], [right, top], [right, bottom], [left, bottom], [left, top]])
    marks.polyline(whole, box, BLACK, lw=1.2)
    marks.polyline(close, box, BLACK, lw=2.4)


def _name_sets(ax: Axes, seen: SliceFeatures, spine: Points) -> None:
    """Write what is what in the part shown close by."""
    corner, wide = np.array([min(ax.get_ylim()), min(ax.get_xlim())]), abs(np.ptp(ax.get_xlim()))
    names = ((seen.outer, _NAMES[0], (0.13, 0.2), OUTER), (seen.inner, _NAMES[1], (0.93, 0.7), INNER))
    for points, name, place, colour in (*names, (spine, "skeleton", (0.72, 0.86), BLACK)):
        at = corner + np.array(place) * wide
        to = points[np.argmin(np.hypot(*(points - at).T))]
        marks.pointer(ax, at[::-1], to[::-1], name, colour=colour)
