"""A stack of slices that slide or lie unevenly -> an upright, even stack. Lengths in mm.

Only linear interpolation, so that no new HU extremes appear; what comes from outside the slices is air.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray


def slide_slices(voxels: NDArray, slides: NDArray[np.float64], *, fill: float) -> tuple[NDArray, NDArray[np.float64]]:
    """Shift every slice within its own plane onto a common frame that is large enough for all of them.

    Parameters
    ----------
    voxels : ndarray, shape (P, R, C)
        Never modified.
    slides : ndarray, shape (P, 2)
        Where each slice's first pixel lies, in pixels along (row, col) from any common point.
    fill : float
        Value outside the slices.

    Returns
    -------
    upright : ndarray, shape (P, R', C')
        Of the same type, with R' >= R and C' >= C.
    origin : ndarray, shape (2,)
        Where the frame's first pixel lies, in the same pixels and from the same point as `slides`.

    Examples
    --------
    The second slice lies half a pixel further along the columns:

    >>> upright, origin = slide_slices(np.array([[[4.0, 8]], [[4, 8]]]), np.array([[0, 0], [0, 0.5]]), fill=0)
    >>> upright[:, 0], origin
    (array([[4., 8., 0.], [2., 6., 4.]]), array([0., 0.]))
    """
    # the frame: whole pixels, around all slices
    origin = np.floor(slides.min(axis=0) + 1e-6)
    offsets = slides - origin
    grow = np.ceil(offsets.max(axis=0) - 1e-6).astype(int)
    planes, rows, cols = voxels.shape

    # each slice at its place in it
    upright = np.full((planes, rows + grow[0], cols + grow[1]), fill, voxels.dtype)
    for out, plane, (down, right) in zip(upright, voxels, offsets, strict=True):
        _place(out, plane, float(down), float(right), fill)
    return upright, origin


def _place(out: NDArray, plane: NDArray, down: float, right: float, fill: float) -> None:
    """Write a plane into `out`, its first pixel at (down, right) >= 0, with linear interpolation between pixels."""
    # linear interpolation, with one pixel of filling around the plane
    (r0, fr), (c0, fc) = _split(down), _split(right)
    wide = np.full((plane.shape[0] + 2, plane.shape[1] + 2), fill, np.float32)
    wide[1:-1, 1:-1] = plane
    mixed = wide[1:] * (1 - fr) + wide[:-1] * fr
    mixed = mixed[:, 1:] * (1 - fc) + mixed[:, :-1] * fc
    rows, cols = min(mixed.shape[0], out.shape[0] - r0), min(mixed.shape[1], out.shape[1] - c0)
    out[r0 : r0 + rows, c0 : c0 + cols] = _as(mixed[:rows, :cols], out.dtype)


def _split(shift: float) -> tuple[int, float]:
    """Whole and fractional part, with rounding noise taken off."""
    whole = int(np.floor(shift + 1e-6))
    return whole, max(shift - whole, 0.0)


def even_heights(heights: NDArray[np.float64], step: float) -> NDArray[np.float64]:
    """Heights from the first to the last, evenly spaced.

    Parameters
    ----------
    heights : ndarray, shape (P,)
        Rising, mm.
    step : float
        Largest distance wanted, mm.

    Returns
    -------
    ndarray, shape (Q,)
        mm; by `step` or a little less, so that both ends stay.

    Examples
    --------
    >>> even_heights(np.array([0.0, 1, 5]), 2.0)
    array([0.        , 1.66666667, 3.33333333, 5.        ])
    """
    count = int(np.ceil((heights[-1] - heights[0]) / step - 0.01))
    return np.linspace(heights[0], heights[-1], count + 1)


def resample_planes(voxels: NDArray, heights: NDArray[np.float64], wanted: NDArray[np.float64]) -> NDArray:
    """Interpolate planes at other heights, linearly between the two neighbours.

    Parameters
    ----------
    voxels : ndarray, shape (P, R, C)
        Never modified.
    heights : ndarray, shape (P,)
        Rising heights of its planes, mm.
    wanted : ndarray, shape (Q,)
        Heights within the same range, mm.

    Returns
    -------
    ndarray, shape (Q, R, C)
        Of the same type.

    Examples
    --------
    >>> planes = np.array([0, 100], np.int16).reshape(2, 1, 1)
    >>> resample_planes(planes, np.array([0.0, 4.0]), np.array([0.0, 1.0, 4.0])).ravel()
    array([  0,  25, 100], dtype=int16)
    """
    # each height between two planes, and how far along
    below = np.clip(np.searchsorted(heights, wanted, side="right") - 1, 0, len(heights) - 2)
    part = (wanted - heights[below]) / (heights[below + 1] - heights[below])
    planes = np.empty((len(wanted), *voxels.shape[1:]), voxels.dtype)
    for out, k, f in zip(planes, below, part, strict=True):
        out[...] = _as(voxels[k] * np.float32(1 - f) + voxels[k + 1] * np.float32(f), voxels.dtype)
    return planes


def find_missing_gaps(heights: NDArray[np.float64], instances: list[int | None]) -> list[int]:
    """Find the gaps that look like missing slices, rather than like a scan with two slice distances.

    Parameters
    ----------
    heights : ndarray, shape (P,)
        Rising, mm.
    instances : list of int or None
        The slices' own numbers.

    Returns
    -------
    list of int
        Index of the slice below each such gap.

    Notes
    -----
    A gap is suspect where it is over 1.5 times the median of the three gaps on each side, or where the slice numbers
    jump just as far while others run by one.

    Examples
    --------
    >>> find_missing_gaps(np.array([0.0, 1, 2, 3, 5, 6, 7, 8]), [None] * 8)
    [3]
    """
    # wide beside the gaps around it
    gaps = np.diff(heights)
    local = np.array([np.median(gaps[max(i - 3, 0) : i + 4]) for i in range(len(gaps))])
    suspect = gaps > 1.5 * local
    # or as wide as the slice numbers jump
    if all(n is not None for n in instances) and len(gaps):
        jumps = np.array([abs(b - a) for a, b in pairwise(n for n in instances if n is not None)])
        times = np.rint(gaps / gaps.min())
        suspect |= (jumps > 1) & (jumps == times) & (jumps.min() == 1)
    return [int(i) for i in np.flatnonzero(suspect)]


def _as(values: NDArray, dtype: np.dtype) -> NDArray:
    """Interpolated values in the type of the voxels: rounded, not cut."""
    if dtype.kind == "b":
        return values >= 0.5
    return np.rint(values).astype(dtype) if dtype.kind in "iu" else values.astype(dtype)
