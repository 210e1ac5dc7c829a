"""A slice of a design -> its picture: bone, boundaries, ends, tangents, start and final curves, patch."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ...methods.slicewise.slices import SlicedDesign, SliceResult
from ...stages import feature_extraction
from ...vault import slicing
from ...volume import Volume
from ..palette import BLACK, BONE, INNER, OUTER, PATCH, TANGENT
from .axes import fill_mask, name_sides, new_figure, scale_bar

if TYPE_CHECKING:
    from .axes import Axes, Figure

_COLOURS, _SIDES = (OUTER, INNER), ("outer", "inner")
_PIXEL_MM = 0.35
_AROUND_MM = 12.0  # shown around the curves
_TANGENT_MM = 12.0
_RAY_RAD = 0.02  # between the rays that part outer from inner boundary


def draw_slice(
    ax: Axes, sliced: SlicedDesign, result: SliceResult, bone: Volume, patch: Volume | None, *, skeleton: bool = False
) -> None:
    """Draw a slice of a design with all that was done in it.

    Parameters
    ----------
    ax : Axes
        Will be in mm along columns and rows of the slice.
    sliced : SlicedDesign
    result : SliceResult
        One of ``sliced.slices``.
    bone, patch : Volume
        Bool masks.
    skeleton : bool
        Boundaries by skeleton and hull, as the paper takes them; otherwise by their distance from the head's centre.
    """
    show_frame(ax, sliced)
    seen = show_areas(ax, sliced, result, bone, patch)
    frame = sliced.frames[result.plane]
    edges = _skeleton_boundaries(bone, frame, sliced.unit) if skeleton else None
    for points, colour in zip(edges or _boundaries(*seen, _centre(sliced, frame)), _COLOURS, strict=True):
        ax.plot(*points.T[::-1], ls="none", marker=".", ms=1.6, mew=0, color=colour)
    draw_curves(ax, sliced, result)
    scale_bar(ax, 20.0)


def show_frame(ax: Axes, sliced: SlicedDesign) -> None:
    """Give an axis limits, mm, that hold the curves of all slices of a design; rows run down.

    Parameters
    ----------
    ax : Axes
    sliced : SlicedDesign
    """
    (left, right), (bottom, top) = _limits(ax, sliced)
    ax.set(xlim=(left, right), ylim=(bottom, top))


def show_areas(
    ax: Axes, sliced: SlicedDesign, result: SliceResult, bone: Volume, patch: Volume | None
) -> tuple[NDArray[np.bool_], NDArray[np.float64], NDArray[np.float64]]:
    """Show bone, and the patch over it, in what an axis shows of a slice.

    Parameters
    ----------
    ax : Axes
        With its limits.
    sliced, result, bone, patch
        As for `draw_slice`.

    Returns
    -------
    bone : ndarray of bool, shape (R, C)
    rows, cols : ndarray, shape (R,), (C,)
        Where its pixels are, mm.
    """
    unit, frame = sliced.unit, sliced.frames[result.plane]
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    rows, cols = (np.arange(low, high, _PIXEL_MM) for low, high in ((top, bottom), (left, right)))
    half = _PIXEL_MM / 2
    extent = cols[0] - half, cols[-1] + half, rows[-1] + half, rows[0] - half
    seen = slicing.sample_mask(bone, frame, rows / unit, cols / unit)
    areas = [(seen, BONE, 1.0, "bone")]
    if patch is not None:
        areas.append((slicing.sample_mask(patch, frame, rows / unit, cols / unit), PATCH, 0.55, "patch"))
    for mask, colour, alpha, name in areas:
        fill_mask(ax, mask, extent, colour, alpha=alpha)
        ax.fill([], [], color=colour, alpha=alpha, label=name)
    return seen, rows, cols


def draw_curves(ax: Axes, sliced: SlicedDesign, result: SliceResult) -> None:
    """Draw the curves of a slice from start to rest, where they cross, the ends of the gap and the tangents there.

    Parameters
    ----------
    ax : Axes
    sliced, result
        As for `draw_slice`.
    """
    unit = sliced.unit
    for curve, start, colour, side in zip(result.curves, _starts(result), _COLOURS, _SIDES, strict=False):
        if len(start):
            ax.plot(*unit * start.T[::-1], color=colour, ls=(0, (4, 2)), lw=1.1, label=f"{side}, start")
        ax.plot(*unit * curve.T[::-1], color=colour, ls="-", lw=1.8, label=f"{side}, at rest")
    if len(result.crossings):
        ax.plot(*unit * result.crossings.T[::-1], "x", ms=9, mew=2.2, color=BLACK, label="the curves cross")
    for ends in result.ends:
        _draw_ends(ax, unit * ends.points, ends.tangents)


def slice_figure(
    sliced: SlicedDesign, result: SliceResult, bone: Volume, patch: Volume | None, *, skeleton: bool = False
) -> Figure:
    """A slice of a design on a new figure, with the letters of the patient's sides.

    Parameters
    ----------
    sliced, result, bone, patch, skeleton
        As for `draw_slice`.

    Returns
    -------
    Figure
    """
    figure, ax = new_figure(3.4, 2.5)
    draw_slice(ax, sliced, result, bone, patch, skeleton=skeleton)
    name_sides(ax, sliced.frames[result.plane][[2, 1]])
    return figure


def _starts(result: SliceResult) -> NDArray:
    """Start curve of each curve, shape (n, N, 2); without points where the curves had no start."""
    return result.start if len(result.start) == len(result.curves) else np.empty((len(result.curves), 0, 2))


def _draw_ends(ax: Axes, points: NDArray, tangents: NDArray) -> None:
    """Draw gap ends, (row, col) in mm, as rings, and their tangents as arrows."""
    for point, tangent in zip(points, tangents, strict=True):
        tip = point + _TANGENT_MM * tangent / np.linalg.norm(tangent)
        arrow = {"arrowstyle": "-|>", "color": TANGENT, "lw": 1.3, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 8}
        ax.annotate("", xy=tip[::-1], xytext=point[::-1], arrowprops=arrow)
        ax.plot([], [], color=TANGENT, lw=1.3, label="tangent at an end")
    ax.plot(*points.T[::-1], ls="none", marker="o", ms=4.5, mfc="white", mec=BLACK, mew=1.0, label="end of the balloon")


def _centre(sliced: SlicedDesign, frame: NDArray[np.float64]) -> NDArray[np.float64]:
    """The head's centre in a slice, (row, col) in mm."""
    origin, row, col = frame
    away = sliced.opening.head_centre - origin
    return np.array([away @ axis / np.linalg.norm(axis) for axis in (row, col)])


def _skeleton_boundaries(
    bone: Volume, frame: NDArray[np.float64], unit: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Outer and inner boundary, (row, col) in mm, of a plane of the scan; None where it has no skeleton."""
    plane = round(float(bone.to_voxel(frame[0])[0]))
    try:
        seen = feature_extraction.extract_features(bone.voxels[plane])
    except feature_extraction.SliceProblem:
        return None
    return seen.outer * unit, seen.inner * unit


def _boundaries(
    bone: NDArray[np.bool_], rows: NDArray, cols: NDArray, centre: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Outer and inner boundary, (row, col) in mm, parted half-way between first and last bone along each ray."""
    index = np.argwhere(bone & ~ndimage.binary_erosion(bone, border_value=1))
    edge = np.column_stack([rows[index[:, 0]], cols[index[:, 1]]])
    # polar coordinates about the head's centre; `ray` counts the rays round it
    radius = np.hypot(*(edge - centre).T)
    ray = np.round((np.arctan2(*(edge - centre).T) + np.pi) / _RAY_RAD).astype(int)
    # farthest and nearest bone along each ray
    high, low = np.full(ray.max(initial=0) + 1, -np.inf), np.full(ray.max(initial=0) + 1, np.inf)
    np.maximum.at(high, ray, radius)
    np.minimum.at(low, ray, radius)
    far = 2 * radius > high[ray] + low[ray]
    return edge[far], edge[~far]


def _limits(ax: Axes, sliced: SlicedDesign) -> tuple[tuple[float, float], tuple[float, float]]:
    """Limits of x and y in mm around the curves, the same for every slice of a design; rows run down.

    A balloon under too much pressure leaves any picture: what lies far from its gap is not followed.
    """
    curves = [np.clip(s.curves, *_box_around_ends(s)).reshape(-1, 2) for s in sliced.slices if s.curves.size]
    points = sliced.unit * np.concatenate(curves) if curves else _centre(sliced, sliced.frames[0])[None]
    low, high = points.min(axis=0) - _AROUND_MM, points.max(axis=0) + _AROUND_MM
    middle, half = (low + high) / 2, (high - low) / 2
    # as much wider or higher as makes a mm equally long along both
    width, height = ax.get_window_extent().size
    half = np.maximum(half, [half[1] * height / width, half[0] * width / height])
    return (middle[1] - half[1], middle[1] + half[1]), (middle[0] + half[0], middle[0] - half[0])


def _box_around_ends(result: SliceResult) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Corners of the box around the ends of both curves that is as wide again on each side, shape (2,) each."""
    ends = result.curves[:, [0, -1]].reshape(-1, 2)
    low, high = ends.min(axis=0), ends.max(axis=0)
    return low - np.ptp(ends, axis=0).max(), high + np.ptp(ends, axis=0).max()
