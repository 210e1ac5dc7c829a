"""The paper's five stages, each by what it makes of one slice of a head, and the solid that comes out.

Frame: slice (row, col) px, columns to the right, rows down.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...curves import ChordFrame, GapEnds, Points, cubic
from ...drawing import shading
from ...drawing.coarse_skull import skull_surface
from ...drawing.described import Described
from ...drawing.figures import Axes, Figure
from ...drawing.figures.axes import fill_mask
from ...drawing.palette import (
    BLACK,
    BONE,
    INNER,
    LABEL_PT,
    MEASURE,
    OUTER,
    PATCH,
    PROSTHESIS,
    SKULL,
    TANGENT,
    TITLE_PT,
    WHITE,
    rgb_shares,
)
from ...mesh import Mesh
from ...opening import Opening
from ...prosthesis import Prosthesis
from ...stages import deformable_model, feature_extraction, prosthesis_volume
from ...volume import Volume
from ..classroom import bridged_plane, gap_ends
from . import marks
from .legend import key_row

STAGES = ("segmentation", "feature_extraction", "deformable_model", "prosthesis_volume", "surface_reconstruction")
"""Names of the stages and of their modules, in the paper's order."""
_MAKES = (
    "bone of every slice",
    "ends of the gap, tangents",
    "two curves across the gap",
    "voxels between them",
    "a closed mesh (blue)",
)
_HEIGHT_IN = 6.5
_TILE = (0.29, 0.352)  # width and height of a picture, as shares of the drawing
_LEFT, _BOTTOM = (0.008, 0.355, 0.702), (0.559, 0.076)  # of the columns, and of the rows
_KEY = ("outer side; the prosthesis", "inner side", "patch of a slice", "end of the gap", "way the bone was going")
_FOLLOW = {"skip_px": 3.0, "reach_px": 10.0}
_WINDOW_HU = (-500.0, 1300.0)  # black and white
_BESIDE_PX = 8.0  # shown beyond the ends of the gap
_INWARDS_PX = 48.0  # of the head's inside shown with the gap
_SNAXELS = 21
_TANGENT_PX = 16.0
_SLICE_SIDES = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
_FROM = (1.0, -0.35, 0.15)  # the viewer of the mesh, LPS


@dataclass(frozen=True, eq=False)
class Steps:
    """What the stages make of one slice.

    Parameters
    ----------
    hu : ndarray, shape (R, C)
        The slice of the scan.
    bone, patch : ndarray of bool, shape (R, C)
    ends : tuple of GapEnds
        Outer and inner, slice (row, col) px.
    curves : ndarray, shape (2, n, 2)
        Outer and inner balloon at rest, slice (row, col) px.
    """

    hu: NDArray
    bone: NDArray[np.bool_]
    patch: NDArray[np.bool_]
    ends: tuple[GapEnds, GapEnds]
    curves: Points


def walk(ct: Volume, bone: Volume, opening: Opening, plane: int) -> Steps:
    """Take a slice through the stages.

    Parameters
    ----------
    ct, bone : Volume
        HU, and bool mask.
    opening : Opening
    plane : int
        In which both ends of its gap are seen.

    Returns
    -------
    Steps
    """
    ends = gap_ends(bone, opening, plane, **_FOLLOW)
    inside = bone.to_voxel(opening.head_centre)[1:]
    outer, inner = (_balloon(one, inside) for one in ends)
    mask = bone.voxels[plane]
    patch = prosthesis_volume.fill_gap(outer, inner, mask)
    return Steps(ct.voxels[plane], mask, patch, ends, np.stack([outer, inner]))


def _balloon(ends: GapEnds, inside: NDArray[np.float64]) -> Points:
    """The balloon of one boundary at rest, with the pressure of its tangents, (row, col) px."""
    frame = ChordFrame.of(ends, inside)
    angles = frame.end_angles(ends)
    start = cubic(frame.length, *angles, _SNAXELS)
    slopes = np.array([[1.0, np.tan(t)] for t in angles]) * frame.length / (_SNAXELS - 1)
    k = deformable_model.tangent_pressure(frame.length, *angles, _SNAXELS)
    return frame.to_slice(deformable_model.inflate(start, slopes, pressure=k).curve)


def pipeline(ct: Volume, bone: Volume, opening: Opening, prosthesis: Prosthesis) -> Described:
    """Draw what goes in, what each stage makes of it, and what comes out.

    Parameters
    ----------
    ct, bone : Volume
        HU, and bool mask.
    opening : Opening
    prosthesis : Prosthesis
        What closes it.

    Returns
    -------
    Described

    Raises
    ------
    InputRefused
        ``NoAxialGap`` where no slice shows both ends of the gap.
    """
    steps = walk(ct, bone, opening, bridged_plane(bone, opening, **_FOLLOW))
    figure = marks.sheet(_HEIGHT_IN)
    tiles = [(left, bottom) for bottom in _BOTTOM for left in _LEFT]
    _draw_arrows(figure)
    names = ["CT", *(f"{i} {name}" for i, name in enumerate(STAGES, 1))]
    for place, name, made in zip(tiles, names, ("Hounsfield units", *_MAKES), strict=True):
        x, y = place[0], place[1] + _TILE[1]
        figure.text(x, y + 0.045, name, fontsize=TITLE_PT, weight="bold", va="bottom")
        figure.text(x, y + 0.01, made, fontsize=LABEL_PT, color=MEASURE, va="bottom")
    for place, draw in zip(tiles, (_scan, _segmentation, _features, _balloons, _patch), strict=False):
        draw(figure, place, steps)
    _mesh(figure, tiles[-1], bone, prosthesis.mesh)
    key_row(figure, _HEIGHT_IN, _KEY)
    alt = (
        "Six pictures joined by arrows. A CT slice; its bone, a ring that is open at one side; the ends of the gap "
        "with their tangents; an outer and an inner curve across the gap; the patch between them; the skull, "
        "closed by the solid."
    )
    lengths = ", ".join(f"{np.linalg.norm(np.diff(one.points, axis=0)):.1f}" for one in steps.ends)
    line = f"gap {lengths} px, patch {int(steps.patch.sum())} px, mesh {len(prosthesis.mesh.faces)} triangles"
    return marks.finished(figure, alt, line)


def _draw_arrows(figure: Figure) -> None:
    """From each picture to the next: to the right, and from the end of the first row down to the second."""
    ax = marks.plane(figure, (0, 0, 1, 1), (0, 0), 1.0)
    tall = _HEIGHT_IN / marks.WIDTH_IN
    for bottom in _BOTTOM:
        for left, following in pairwise(_LEFT):
            y = (bottom + _TILE[1] / 2) * tall
            marks.arrow(ax, (left + _TILE[0] + 0.01, y), (following - 0.008, y), BLACK, width=2.6)
    # round the corner: below the last of the first row, above the first of the second
    high, low = (_BOTTOM[0] - 0.012) * tall, (_BOTTOM[1] + _TILE[1] + 0.105) * tall
    first, last = _LEFT[0] + 0.28, _LEFT[-1] + _TILE[0] / 2
    middle = (high + low) / 2 + 0.008
    marks.polyline(ax, np.array([[last, high], [last, middle], [first, middle]]), BLACK, lw=2.6)
    marks.arrow(ax, (first, middle), (first, low - 0.068), BLACK, width=2.6)


def _window(low: Points, high: Points) -> tuple[Points, Points]:
    """First and last (row, col) px of a picture around a box."""
    aspect = _TILE[1] * _HEIGHT_IN / (_TILE[0] * marks.WIDTH_IN)
    size = high - low
    half = max(size[1], size[0] / aspect) / 2 * np.array([aspect, 1.0])
    return (low + high) / 2 - half, (low + high) / 2 + half


def _tile(figure: Figure, place: tuple[float, float], low: Points, high: Points) -> Axes:
    """A picture of the slice around a box (row, col) px, rows running down."""
    first, last = _window(low, high)
    ax = marks.plane(figure, (*place, *_TILE), first[::-1], last[1] - first[1])
    ax.invert_yaxis()
    return ax


def _whole(steps: Steps) -> tuple[Points, Points]:
    """The box of the whole head."""
    at = np.argwhere(steps.bone)
    return at.min(axis=0) - 14.0, at.max(axis=0) + 14.0


def _close(figure: Figure, place: tuple[float, float], steps: Steps) -> Axes:
    """A framed picture of the bone around the gap."""
    ax = _tile(figure, place, *_gap(steps))
    _show(ax, steps.bone, BONE)
    _frame(ax, steps)
    return ax


def _frame(ax: Axes, steps: Steps) -> None:
    """A frame around what the pictures of the gap show."""
    (top, left), (bottom, right) = _window(*_gap(steps))
    box = np.array([[left, top], [right, top], [right, bottom], [left, bottom], [left, top]])
    marks.polyline(ax, box, MEASURE, lw=1.2)


def _gap(steps: Steps) -> tuple[Points, Points]:
    """The box of the gap, with more of the head's inside than of its outside."""
    at = steps.curves.reshape(-1, 2)
    inwards = np.argwhere(steps.bone).mean(axis=0) - at.mean(axis=0)
    at = np.vstack([at, at.mean(axis=0) + _INWARDS_PX * inwards / np.linalg.norm(inwards)])
    return at.min(axis=0) - _BESIDE_PX, at.max(axis=0) + _BESIDE_PX


def _show(ax: Axes, mask: NDArray[np.bool_], colour: str) -> None:
    """A mask in one colour, the limits of the picture kept."""
    limits = ax.get_xlim(), ax.get_ylim()
    rows, cols = mask.shape
    fill_mask(ax, mask, (-0.5, cols - 0.5, rows - 0.5, -0.5), colour)
    ax.set(xlim=limits[0], ylim=limits[1], aspect="auto")


def _scan(figure: Figure, place: tuple[float, float], steps: Steps) -> None:
    """The slice of the scan in greys."""
    ax = _tile(figure, place, *_whole(steps))
    limits = ax.get_xlim(), ax.get_ylim()
    ax.imshow(steps.hu, cmap="gray", vmin=_WINDOW_HU[0], vmax=_WINDOW_HU[1], interpolation="bilinear")
    ax.set(xlim=limits[0], ylim=limits[1], aspect="auto")
    marks.sides(ax, _SLICE_SIDES)


def _segmentation(figure: Figure, place: tuple[float, float], steps: Steps) -> None:
    """The bone of the whole slice, and a frame around what the next pictures show."""
    ax = _tile(figure, place, *_whole(steps))
    _show(ax, steps.bone, BONE)
    _frame(ax, steps)
    marks.sides(ax, _SLICE_SIDES)


def _features(figure: Figure, place: tuple[float, float], steps: Steps) -> None:
    """Boundaries, ends and tangents."""
    ax = _close(figure, place, steps)
    seen = feature_extraction.extract_features(steps.bone)
    for points, colour in ((seen.outer, OUTER), (seen.inner, INNER)):
        ax.plot(*points.T[::-1], ls="none", marker="s", ms=3.0, mfc=colour, mec="none")
    _draw_ends(ax, steps, tangents=True)


def _balloons(figure: Figure, place: tuple[float, float], steps: Steps) -> None:
    """Both balloons at rest."""
    ax = _close(figure, place, steps)
    for curve, colour in zip(steps.curves, (OUTER, INNER), strict=True):
        marks.polyline(ax, curve[:, ::-1], colour, lw=2.2, marker="o", ms=3.8, mfc=WHITE, mew=1.3)
    _draw_ends(ax, steps, tangents=False)


def _patch(figure: Figure, place: tuple[float, float], steps: Steps) -> None:
    """The patch between the curves."""
    ax = _close(figure, place, steps)
    _show(ax, steps.patch, PATCH)
    for curve, colour in zip(steps.curves, (OUTER, INNER), strict=True):
        marks.polyline(ax, curve[:, ::-1], colour, lw=2.2)


def _draw_ends(ax: Axes, steps: Steps, *, tangents: bool) -> None:
    """The ends of both gaps, with the way the bone was going."""
    for ends in steps.ends:
        for point, tangent in zip(ends.points, ends.tangents, strict=True):
            if tangents:
                marks.arrow(ax, point[::-1], (point + _TANGENT_PX * tangent)[::-1], TANGENT, width=2.2)
            ax.plot(*point[::-1], marker="o", ms=6, mfc=WHITE, mec=BLACK, mew=1.3, zorder=5)


def _mesh(figure: Figure, place: tuple[float, float], bone: Volume, mesh: Mesh) -> None:
    """The skull, closed by the prosthesis."""
    parts = [shading.Solid(skull_surface(bone), rgb_shares(SKULL)), shading.Solid(mesh, rgb_shares(PROSTHESIS))]
    seen = shading.render(parts, _FROM, px_mm=0.6).rgb
    ax = _tile(figure, place, np.zeros(2), np.array(seen.shape[:2], float))
    limits = ax.get_xlim(), ax.get_ylim()
    ax.imshow(seen, interpolation="bilinear")
    ax.set(xlim=limits[0], ylim=limits[1], aspect="auto")
    marks.sides(ax, shading.view_axes(_FROM)[:2])
