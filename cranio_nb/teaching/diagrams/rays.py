"""Rays from inside the head, in one cut through the hole: those that meet bone, and those that leave.

Frame: (x, y) mm in the cut, to the right and up, from the head's centre.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...drawing.described import Described
from ...drawing.figures import Axes, Figure
from ...drawing.figures.axes import fill_mask
from ...drawing.palette import BLACK, BONE, INNER, MEASURE, NOTE_PT, OUTER, PATCH, WHITE, side_letter
from ...opening import Opening
from ...vault import slicing
from ...volume import Volume
from . import marks

_HEIGHT_IN = 4.3
_CUT = 0.6  # of the drawing, for the cut
_EVERY_DEG = 4.0  # between the rays drawn
_EYE_MM = 9.0  # from which on rays are drawn
_SIDE_DEG = 72.0  # on each side of the hole: rays shown side by side
_BEYOND_MM = 14.0  # how far a ray is drawn that leaves
_MARGIN_MM = 18.0
_PIXEL_MM = 0.4


def ray_fan(bone: Volume, opening: Opening) -> Described:
    """Draw the rays of one cut through the middle of an opening and the head's centre, and the radii they measure.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    opening : Opening

    Returns
    -------
    Described
    """
    right_up = cut_axes(opening)
    turns = np.radians(np.arange(0.0, 360.0, _EVERY_DEG))
    outer, inner = ray_radii(bone, opening, np.column_stack([np.cos(turns), np.sin(turns)]) @ right_up)
    leaves = np.isnan(outer)
    far = float(np.nanmax(outer)) + _BEYOND_MM
    figure = marks.sheet(_HEIGHT_IN)
    _draw_cut(figure, (bone, opening), right_up, turns, outer, far)
    middle = float(np.arctan2(*(right_up[::-1] @ opening.direction)))
    ax = _draw_radii(figure, np.degrees(turns - middle), outer, inner, far)
    # where the two ends of the row of rays lie in the patient
    for share, turn in ((0.06, middle - np.radians(_SIDE_DEG)), (0.94, middle + np.radians(_SIDE_DEG))):
        letter = side_letter(np.array([np.cos(turn), np.sin(turn)]) @ right_up)
        marks.word(ax, (share, 0.97), letter, colour=MEASURE, transform=ax.transAxes, weight="bold")
    alt = (
        "Left: a cut through the head; rays from its middle end at the bone, but those towards the hole leave through "
        "it. Right: the radius of each ray; where the hole is, the two rows of radii have a gap."
    )
    line = f"{len(turns)} rays in this cut: {int(leaves.sum())} leave, {int((~leaves).sum())} meet bone"
    return marks.finished(figure, alt, line)


def cut_axes(opening: Opening) -> NDArray[np.float64]:
    """Axes of the cut through the head's centre and the middle of an opening that leaves the head's sides level.

    Parameters
    ----------
    opening : Opening

    Returns
    -------
    ndarray, shape (2, 3)
        Unit vectors to the right and up in the drawing, world: as near to the patient's left and front as can be.
    """
    # the cut holds the way to the opening and the horizontal way across it
    towards = opening.direction
    across = np.cross(towards, [0.0, 0.0, 1.0])
    across = across / np.linalg.norm(across)
    turn = np.stack([towards, across])
    # of these two, turned within the cut so that up is as much to the front as can be
    front = turn @ [0.0, -1.0, 0.0]
    front = front / np.linalg.norm(front)
    up = front @ turn
    right = np.array([front[1], -front[0]]) @ turn
    return np.stack([right if right[0] > 0 else -right, up])


def ray_radii(
    bone: Volume, opening: Opening, directions: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Where rays from the head's centre meet their last and their first bone.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    opening : Opening
    directions : ndarray, shape (n, 3)
        Unit vectors, world.

    Returns
    -------
    outer, inner : ndarray, shape (n,)
        mm; nan for rays that leave.
    """
    lengths = np.arange(0.0, np.linalg.norm(bone.spacing * bone.shape), 0.25)
    met = bone.at(opening.head_centre + directions[:, None] * lengths[:, None], outside=False)
    last = len(lengths) - 1 - met[:, ::-1].argmax(axis=1)
    meets = met.any(axis=1)
    outer, inner = (np.where(meets, lengths[at], np.nan) for at in (last, met.argmax(axis=1)))
    return outer, inner


def _draw_cut(
    figure: Figure,
    seen: tuple[Volume, Opening],
    right_up: NDArray[np.float64],
    turns: NDArray[np.float64],
    outer: NDArray[np.float64],
    far: float,
) -> None:
    """The head in the cut, and its rays: lines that end at the bone, arrows that leave."""
    around = np.column_stack([np.cos(turns), np.sin(turns)])
    low, width = _limits(outer[:, None] * around)
    ax = marks.plane(figure, (0, 0, _CUT, 1), low, width)
    fill_cut(ax, seen[1].head_centre, right_up, {BONE: seen[0], PATCH: seen[1].sheet})
    for towards, radius in zip(around, outer, strict=True):
        if np.isnan(radius):
            marks.arrow(ax, _EYE_MM * towards, far * towards, BLACK, width=1.4)
        else:
            marks.polyline(ax, np.outer([_EYE_MM, radius], towards), MEASURE, lw=0.7)
            ax.plot(*(radius * towards), marker="o", ms=3.4, mfc=OUTER, mec="none")
    ax.plot([0], [0], marker="o", ms=9, mfc=WHITE, mec=BLACK, mew=1.6)
    marks.word(ax, (0, -1.9 * _EYE_MM), "eye", bbox={"fc": WHITE, "ec": "none", "pad": 2.0})
    marks.sides(ax, right_up * [[1.0], [-1.0]])
    marks.scale(ax, 50.0, "50 mm")


def _draw_radii(figure: Figure, turn_deg: NDArray, outer: NDArray, inner: NDArray, top_mm: float) -> Axes:
    """The same rays side by side: what each measures, against its angle from the middle of the opening."""
    turn = (turn_deg + 180.0) % 360.0 - 180.0
    ax = figure.add_axes((_CUT + 0.09, 0.13, 0.885 - _CUT, 0.8))
    shown = np.abs(turn) < _SIDE_DEG
    turn, outer, inner = turn[shown], outer[shown], inner[shown]
    ax.vlines(turn[np.isfinite(outer)], 0, inner[np.isfinite(outer)], colors=MEASURE, lw=0.7)
    for at in turn[np.isnan(outer)]:
        marks.arrow(ax, (at, 0), (at, top_mm), BLACK, width=1.4)
    ax.plot(turn, outer, ls="none", marker="s", ms=3.4, color=OUTER, label="outer radius")
    ax.plot(turn, inner, ls="none", marker="o", ms=3.4, color=INNER, label="inner radius")
    ax.set(xlim=(-_SIDE_DEG, _SIDE_DEG), ylim=(0, 1.04 * top_mm), xticks=range(-60, 61, 30))
    ax.set_xlabel("degrees from the middle of the hole", fontsize=NOTE_PT)
    ax.set_ylabel("mm from the eye", fontsize=NOTE_PT)
    ax.tick_params(labelsize=NOTE_PT)
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(fontsize=NOTE_PT, loc="lower center", framealpha=1.0)
    return ax


def _limits(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """Lower left corner and width, mm, of a plane with the head in the middle."""
    low, high = np.nanmin(points, axis=0) - _MARGIN_MM, np.nanmax(points, axis=0) + _MARGIN_MM
    aspect = _HEIGHT_IN / (_CUT * marks.WIDTH_IN)
    width = max(high[0] - low[0], (high[1] - low[1]) / aspect)
    return (low + high) / 2 - np.array([1.0, aspect]) * width / 2, float(width)


def fill_cut(ax: Axes, origin: NDArray[np.float64], right_up: NDArray[np.float64], masks: dict[str, Volume]) -> None:
    """Fill what a cut shows of masks, over all of a plane in mm.

    Parameters
    ----------
    ax : Axes
    origin : ndarray, shape (3,)
        What lies at (0, 0), world mm.
    right_up : ndarray, shape (2, 3)
        Unit vectors to the right and up, world.
    masks : dict of str to Volume
        Bool masks by colour, the last on top.
    """
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    cols, rows = np.arange(left, right, _PIXEL_MM), np.arange(-top, -bottom, _PIXEL_MM)
    frame = np.stack([origin, -right_up[1], right_up[0]])
    for colour, mask in masks.items():
        fill_mask(ax, slicing.sample_mask(mask, frame, rows, cols), (left, right, bottom, top), colour)
    ax.set(xlim=(left, right), ylim=(bottom, top), aspect="auto")
