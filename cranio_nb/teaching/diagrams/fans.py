"""Slices that are not axial: planes through a line inside the head, and the curves they carry across the hole.

Frames: the world in mm (LPS); the cut in mm from the head's centre, to the right and up.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...drawing.described import Described
from ...drawing.figures import Figure
from ...drawing.palette import BLACK, BONE, MEASURE, OUTER, PATCH, TITLE_PT, WHITE, faded
from ...methods.slicewise.slices import SlicedDesign, SliceResult
from ...prosthesis import Prosthesis
from ...volume import Volume
from . import marks
from .head import draw_head
from .rays import fill_cut

_HEIGHT_IN = 4.1
_HALF = 0.47  # of the drawing, for the cut
_EVERY = 6  # from one slice drawn to the next
_BEYOND = 1.12  # of the way to the outer curve, up to which a page is drawn
_MARGIN_MM = 16.0


def slice_fans(bone: Volume, prosthesis: Prosthesis) -> Described:
    """Draw the first fan of a design from its edge, and the outer curves of all its fans on the head.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    prosthesis : Prosthesis
        Of the slice method, by fans.

    Returns
    -------
    Described
    """
    fans = [one for one in prosthesis.working if isinstance(one, SlicedDesign)]
    figure = marks.sheet(_HEIGHT_IN)
    shown = _draw_cut(figure, bone, prosthesis, fans[0])
    head = draw_head(figure, (_HALF, 0, 1 - _HALF, 1), bone, fans[0].opening.direction)
    for i, fan in reversed(list(enumerate(fans))):
        style = {"lw": 2.4} if i == 0 else {"lw": 1.0}
        for one in fan.slices[::_EVERY]:
            if len(one.curves):
                colour = OUTER if i == 0 else faded(OUTER)
                marks.polyline(head.ax, head.place(in_world(fan, one)), colour, **style)
    head.ax.text(0.02, 0.98, "on the head", transform=head.ax.transAxes, fontsize=TITLE_PT, weight="bold", va="top")
    alt = (
        "Left: a cut through the head, in which the slices of one fan are seen from their edges, as lines from one "
        "point inside the head through the hole. Right: the hole with the curves that cross it, those of the same fan "
        "broad, and those of the other directions thin."
    )
    line = f"{len(fans)} directions; the first fan has {len(fans[0].slices)} slices, {shown} of them drawn"
    return marks.finished(figure, alt, line)


def in_world(fan: SlicedDesign, one: SliceResult) -> NDArray[np.float64]:
    """The outer curve of a slice.

    Parameters
    ----------
    fan : SlicedDesign
    one : SliceResult
        With curves.

    Returns
    -------
    ndarray, shape (n, 3)
        World mm.
    """
    origin, row, col = fan.frames[one.plane]
    return np.asarray(origin + fan.unit * (one.curves[0] @ np.stack([row, col])))


def axes_across(hinge: NDArray[np.float64]) -> NDArray[np.float64]:
    """Axes of the cut that a line of the head crosses at right angles, as upright as can be.

    Parameters
    ----------
    hinge : ndarray, shape (3,)
        Unit vector along the line, world.

    Returns
    -------
    ndarray, shape (2, 3)
        Unit vectors to the right and up, world. Up leads to the top of the head, or to its front where the line itself
        leads up; right leads rather to the patient's left, or to the back.

    Examples
    --------
    >>> (axes_across(np.array([0.0, 1.0, 0.0])) + 0.0).tolist()
    [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """
    want = np.array([0.0, 0.0, 1.0]) if abs(hinge[2]) < 0.8 else np.array([0.0, -1.0, 0.0])
    up = want - (want @ hinge) * hinge
    up = up / np.linalg.norm(up)
    right = np.cross(hinge, up)
    return np.stack([right * np.sign(right @ [1.0, 0.5, 0.0] or 1.0), up])


def _draw_cut(figure: Figure, bone: Volume, prosthesis: Prosthesis, fan: SlicedDesign) -> int:
    """The cut in which the slices of a fan are lines; returns how many are drawn."""
    right_up = axes_across(fan.frames[0, 2])
    centre = fan.opening.head_centre
    # the head around the eye: all bone, seen along the line
    flat = (bone.to_world(np.argwhere(bone.voxels)[::97]) - centre) @ right_up.T
    low, high = flat.min(axis=0) - _MARGIN_MM, flat.max(axis=0) + _MARGIN_MM
    aspect = _HEIGHT_IN / (_HALF * marks.WIDTH_IN)
    width = max(high[0] - low[0], (high[1] - low[1]) / aspect)
    ax = marks.plane(figure, (0, 0, _HALF, 1), (low + high) / 2 - np.array([1.0, aspect]) * width / 2, width)
    masks = {BONE: bone} if prosthesis.patch is None else {BONE: bone, PATCH: prosthesis.patch}
    fill_cut(ax, centre, right_up, masks)
    pages = [one for one in fan.slices[::_EVERY] if len(one.curves)]
    for one in pages:
        outermost = -fan.unit * one.curves[0, :, 0].min()  # rows run towards the eye
        towards = right_up @ -fan.frames[one.plane, 1]
        marks.polyline(ax, np.outer([0.0, _BEYOND * outermost], towards), OUTER, lw=1.6)
    ax.plot([0], [0], marker="o", ms=9, mfc=WHITE, mec=BLACK, mew=1.6, zorder=5)
    marks.pointer(ax, -np.array([0.18, 0.16]) * width, (0, 0), "the line, seen\nalong itself", colour=MEASURE)
    ax.text(0.02, 0.98, "a fan, edge on", transform=ax.transAxes, fontsize=TITLE_PT, weight="bold", va="top")
    marks.sides(ax, right_up * [[1.0], [-1.0]])
    marks.scale(ax, 50.0, "50 mm")
    return len(pages)
