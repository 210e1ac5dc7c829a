"""Arrays by their indices, and the order of their axes: what `Volume` and the grids of rays share.

Frames: any array index, fractions allowed; world (x, y, z) in mm, DICOM LPS.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain, product

import numpy as np
from numpy.typing import ArrayLike, NDArray

Affine = NDArray[np.float64]
Box = tuple[slice, slice, slice]
"""Part of a grid: a range of planes, of rows and of columns, with steps of 1."""

# Axis order of the package: planes rise to the top of the head (z), rows to the back (y), columns to the left (x).
_WORLD_AXIS = (2, 1, 0)
_BORDER = 1e-6  # voxels to either side of a border that still belong to it; rounding moves points by less


@dataclass(frozen=True)
class AxisOrder:
    """New axis i is old axis `axes[i]`, reversed where `flips[i]`.

    Parameters
    ----------
    axes : tuple of int
        A permutation of 0, 1, 2.
    flips : tuple of bool
    """

    axes: tuple[int, int, int]
    flips: tuple[bool, bool, bool]

    @property
    def inverse(self) -> AxisOrder:
        """The order that undoes this one.

        Returns
        -------
        AxisOrder
        """
        back = tuple(int(i) for i in np.argsort(self.axes))
        return AxisOrder((back[0], back[1], back[2]), (self.flips[back[0]], self.flips[back[1]], self.flips[back[2]]))


def canonical_order(affine: Affine) -> AxisOrder:
    """The axis order that turns a grid into the package's own (planes up, rows back, columns left).

    Parameters
    ----------
    affine : ndarray, shape (4, 4)
        Array index -> world mm (LPS) of the grid as stored.

    Returns
    -------
    AxisOrder

    Examples
    --------
    >>> canonical_order(np.diag([-0.5, 0.5, 3.0, 1.0]))  # columns to the right, rows back, planes up
    AxisOrder(axes=(2, 1, 0), flips=(False, False, True))
    """
    # of the six permutations the one whose axes lie best along z, y, x
    directions = affine[:3, :3] / np.linalg.norm(affine[:3, :3], axis=0)
    best = max(
        ((a, b, c) for a in range(3) for b in range(3) for c in range(3) if {a, b, c} == {0, 1, 2}),
        key=lambda axes: sum(abs(directions[w, a]) for w, a in zip(_WORLD_AXIS, axes, strict=True)),
    )
    # an axis that runs against its world axis is reversed
    flips = [bool(directions[w, a] < 0) for w, a in zip(_WORLD_AXIS, best, strict=True)]
    return AxisOrder(best, (flips[0], flips[1], flips[2]))


def inside_grid(index: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Whether fractional indices lie in an element of an array, its border included.

    Parameters
    ----------
    index : array_like, shape (..., k)
    shape : tuple of int
        k numbers.

    Returns
    -------
    ndarray of bool, shape (...)

    Examples
    --------
    >>> inside_grid([[0.4, 2.4], [0.4, 2.6]], (1, 3))
    array([ True, False])
    """
    pairs = zip(*_nearest(index), shape, strict=True)
    return np.logical_and.reduce([(high >= 0) & (low < n) for low, high, n in pairs])


def nearest_values(values: NDArray, index: ArrayLike, *, outside: float) -> NDArray:
    """Values of the array elements nearest to fractional indices; on a border, the largest of those that share it.

    Parameters
    ----------
    values : ndarray of k dimensions
    index : array_like, shape (..., k)
    outside : scalar
        Value where the array has no element.

    Returns
    -------
    ndarray, shape (...)

    Examples
    --------
    >>> nearest_values(np.array([3, 4, 5]), [[0.6], [7.0]], outside=0)
    array([4, 0])
    >>> nearest_values(np.array([3, 4, 5]), [[0.5], [-0.5]], outside=0)
    array([4, 3])
    """
    low, high = _nearest(index)
    found = _values(values, low, outside)
    border = (low != high).any(axis=0)
    if border.any():
        for one in product(*zip(low[:, border], high[:, border], strict=True)):
            found[border] = np.fmax(found[border], _values(values, np.stack(one), outside))
    return found


def touched(index: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Elements of an array in which fractional indices lie; on a border, all that share it.

    Parameters
    ----------
    index : array_like, shape (m, k)
    shape : tuple of int
        k numbers.

    Returns
    -------
    ndarray of bool, shape `shape`

    Examples
    --------
    >>> touched([[0.6], [2.5], [7.0]], (5,))
    array([False,  True,  True,  True, False])
    """
    marked = np.zeros(shape, bool)
    low, high = _nearest(index)
    border = (low != high).any(axis=0)
    ends = product(*zip(low[:, border], high[:, border], strict=True))
    for one in chain([tuple(low)], ends):
        inside = np.logical_and.reduce([(i >= 0) & (i < n) for i, n in zip(one, shape, strict=True)])
        marked[tuple(i[inside] for i in one)] = True
    return marked


def _nearest(index: ArrayLike) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Lowest and highest element that a fractional index lies in, shape (k, ...): two only on a border.

    Points that a turned header moves by rounding lie on the same border as before.
    """
    at = np.ascontiguousarray(np.moveaxis(np.asarray(index, float), -1, 0))
    return np.ceil(at - (0.5 + _BORDER)).astype(np.intp), np.floor(at + (0.5 + _BORDER)).astype(np.intp)


def _values(values: NDArray, at: NDArray[np.intp], outside: float) -> NDArray:
    """Values of elements, shape (...); any element stands in where there is none, and is replaced at the end."""
    # without its sign, what lies before the first element is a large number
    inside = np.logical_and.reduce([i.view(np.uintp) < n for i, n in zip(at, values.shape, strict=True)])
    if not values.flags.c_contiguous:
        return np.where(inside, values[tuple(np.where(inside, i, 0) for i in at)], outside)
    # one number for each place in the array is looked up several times faster than an index for each axis
    place = at[0].copy()
    for i, n in zip(at[1:], values.shape[1:], strict=True):
        place *= n
        place += i
    return np.where(inside, values.ravel().take(place, mode="clip"), outside)


def true_indices(mask: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Index of each true element of a mask, in the order of `numpy.argwhere`.

    Parameters
    ----------
    mask : ndarray of bool, shape (N_1, ..., N_k)

    Returns
    -------
    ndarray of int, shape (n, k)

    Notes
    -----
    Where few of many voxels are true this is ten times as fast as `numpy.argwhere`, which steps through all axes.

    Examples
    --------
    >>> true_indices(np.array([[False, True], [True, False]])).tolist()
    [[0, 1], [1, 0]]
    """
    return np.transpose(np.unravel_index(np.flatnonzero(mask), mask.shape))


def box_around(index: ArrayLike, shape: tuple[int, int, int], margin: ArrayLike = 0) -> Box:
    """Smallest box of a grid that holds fractional indices, grown by a margin and clipped to the grid.

    Parameters
    ----------
    index : array_like, shape (n, 3)
        Voxel (plane, row, col); n > 0.
    shape : tuple of int
        Of the grid.
    margin : int or array_like of int, shape (3,)
        Voxels on each side.

    Returns
    -------
    tuple of slice
        Of at least one voxel along each axis.

    Examples
    --------
    >>> box_around([[1.2, 2.0, 3.0], [1.7, 2.0, 4.0]], (9, 9, 5), margin=1)
    (slice(0, 4, None), slice(1, 4, None), slice(2, 5, None))
    """
    # grown by the margin, clipped to the grid, at least one voxel wide
    index, margin, last = np.asarray(index), np.asarray(margin), np.array(shape) - 1
    low = np.clip(np.floor(index.min(axis=0)).astype(int) - margin, 0, last)
    high = np.clip(np.ceil(index.max(axis=0)).astype(int) + margin, low, last) + 1
    planes, rows, cols = (slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    return planes, rows, cols


def move_affine(affine: Affine, start: ArrayLike, step: ArrayLike = 1) -> Affine:
    """Affine of another grid along the same axes.

    Parameters
    ----------
    affine : ndarray, shape (4, 4)
        Voxel index -> world mm of the first grid.
    start : array_like, shape (3,)
        Fractional index, on the first grid, of the other's first voxel.
    step : float or array_like, shape (3,)
        Voxels of the first grid from each voxel of the other to its next.

    Returns
    -------
    ndarray, shape (4, 4)
        Voxel index of the other grid -> world mm.

    Examples
    --------
    >>> move_affine(np.eye(4), (0.5, 0.5, 0.5), 2)[0]
    array([2. , 0. , 0. , 0.5])
    """
    # origin: world place of the first voxel; columns: the old ones times the step
    moved = affine.copy()
    moved[:3, 3] = np.asarray(start, float) @ affine[:3, :3].T + affine[:3, 3]
    moved[:3, :3] *= np.asarray(step, float)
    return moved
