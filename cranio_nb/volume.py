"""A box of voxels and its place in the patient: the one type for CT, bone mask and patch.

Frames: voxel (plane, row, col) index -> world (x, y, z) in mm, DICOM LPS (x to the patient's left, y to the back,
z to the top of the head). Outside the readers, conversions between the two happen here only.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InputRefused

Affine = NDArray[np.float64]
Box = tuple[slice, slice, slice]
"""Part of a grid: a range of planes, of rows and of columns, with steps of 1."""

# Axis order of the package: planes rise to the top of the head (z), rows to the back (y), columns to the left (x).
_WORLD_AXIS = (2, 1, 0)


@dataclass(frozen=True, eq=False)
class Volume:
    """Voxels on a regular grid in the world.

    Parameters
    ----------
    voxels : ndarray, shape (P, R, C)
        HU (int16 or float32) for a CT, bool for a bone mask or a patch.
    affine : ndarray, shape (4, 4)
        Voxel index (plane, row, col, 1) -> world mm (x, y, z, 1), DICOM LPS.

    Raises
    ------
    InputRefused
        If the voxels are not three-dimensional or the affine is not a finite, invertible (4, 4) map.

    Examples
    --------
    >>> volume = Volume(np.zeros((4, 5, 6)), np.diag([3.0, 0.5, 0.5, 1.0]))
    >>> volume.shape, round(volume.voxel_volume, 9)
    ((4, 5, 6), 0.75)
    """

    voxels: NDArray
    affine: Affine

    def __post_init__(self) -> None:
        affine = np.asarray(self.affine, float)
        object.__setattr__(self, "affine", affine)
        if self.voxels.ndim != 3:
            raise InputRefused("BadShape", f"The volume has {self.voxels.ndim} dimensions; 3 are wanted.")
        if affine.shape != (4, 4) or not np.isfinite(affine).all() or abs(np.linalg.det(affine)) < 1e-12:
            raise InputRefused("BadGeometry", "The affine is not a finite, invertible (4, 4) matrix.")

    @property
    def shape(self) -> tuple[int, int, int]:
        """Number of planes, rows and columns.

        Returns
        -------
        tuple of int
        """
        planes, rows, cols = self.voxels.shape
        return planes, rows, cols

    @property
    def edges(self) -> NDArray[np.float64]:
        """World vectors from a voxel to the next plane, row and column.

        Returns
        -------
        ndarray, shape (3, 3)
            Rows plane, row, col; mm. At right angles unless the gantry was tilted.
        """
        return self.affine[:3, :3].T

    @property
    def spacing(self) -> NDArray[np.float64]:
        """Distance between voxel centres along (plane, row, col).

        Returns
        -------
        ndarray, shape (3,)
            mm.
        """
        return np.linalg.norm(self.affine[:3, :3], axis=0)

    @property
    def axes(self) -> NDArray[np.float64]:
        """Unit vectors along which planes, rows and columns count up.

        Returns
        -------
        ndarray, shape (3, 3)
            Rows plane, row, col; world. At right angles unless the gantry was tilted.

        Examples
        --------
        >>> Volume(np.zeros((4, 5, 6)), np.diag([3.0, 0.5, -0.5, 1.0])).axes[2]
        array([ 0.,  0., -1.])
        """
        return (self.affine[:3, :3] / self.spacing).T

    @property
    def voxel_volume(self) -> float:
        """Volume of one voxel.

        Returns
        -------
        float
            mm3.
        """
        return float(abs(np.linalg.det(self.affine[:3, :3])))

    def to_world(self, points: ArrayLike) -> NDArray[np.float64]:
        """World positions of voxel indices.

        Parameters
        ----------
        points : array_like, shape (..., 3)
            Voxel (plane, row, col), fractions allowed.

        Returns
        -------
        ndarray, shape (..., 3)
            World mm.
        """
        return np.asarray(points, float) @ self.affine[:3, :3].T + self.affine[:3, 3]

    def to_voxel(self, points: ArrayLike) -> NDArray[np.float64]:
        """Fractional voxel indices of world points.

        Parameters
        ----------
        points : array_like, shape (..., 3)
            World mm.

        Returns
        -------
        ndarray, shape (..., 3)
            Voxel (plane, row, col).
        """
        return self.steps(np.asarray(points, float) - self.affine[:3, 3])

    def steps(self, directions: ArrayLike) -> NDArray[np.float64]:
        """How many voxels a world vector spans along each axis of the grid.

        Parameters
        ----------
        directions : array_like, shape (..., 3)
            World vectors, mm; for unit vectors the result is in voxels per mm.

        Returns
        -------
        ndarray, shape (..., 3)
            Planes, rows and columns.

        Examples
        --------
        >>> volume = Volume(np.zeros((4, 5, 6)), np.diag([3.0, 0.5, 0.5, 1.0]))
        >>> volume.steps([0.0, 1.0, 0.0])
        array([0., 2., 0.])
        """
        return np.asarray(directions, float) @ np.linalg.inv(self.affine[:3, :3]).T

    def at(self, points: ArrayLike, *, outside: float) -> NDArray:
        """Values of the voxels nearest to world points.

        Parameters
        ----------
        points : array_like, shape (..., 3)
            World mm.
        outside : scalar
            Value of points that lie in no voxel; False for a mask.

        Returns
        -------
        ndarray, shape (...)

        Examples
        --------
        >>> volume = Volume(np.arange(8).reshape(2, 2, 2), np.eye(4))
        >>> volume.at([[0.2, 0.9, 0.0], [9.0, 0.0, 0.0]], outside=-1)
        array([ 2, -1])
        """
        return self.at_index(self.to_voxel(points), outside=outside)

    def at_index(self, index: ArrayLike, *, outside: float) -> NDArray:
        """Values of the voxels nearest to fractional indices; a half goes to the even voxel.

        Parameters
        ----------
        index : array_like, shape (..., 3)
            Voxel (plane, row, col). Along a ray, `start + length * step` with `to_voxel` and `steps` is cheaper than
            world points.
        outside : scalar
            Value where there is no voxel.

        Returns
        -------
        ndarray, shape (...)
        """
        return nearest_values(self.voxels, index, outside=outside)

    def contains(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Whether world points lie in a voxel of the grid.

        Parameters
        ----------
        points : array_like, shape (..., 3)
            World mm.

        Returns
        -------
        ndarray of bool, shape (...)
        """
        return inside_grid(self.to_voxel(points), self.shape)

    def box(self, margin: ArrayLike = 0) -> Box:
        """Smallest box that holds all true voxels, grown by a margin and clipped to the grid.

        Parameters
        ----------
        margin : int or array_like of int, shape (3,)
            Voxels on each side.

        Returns
        -------
        tuple of slice
            Of no voxels where none is true.

        Examples
        --------
        >>> mask = np.zeros((4, 5, 6), bool)
        >>> mask[2, 3, 4] = True
        >>> Volume(mask, np.eye(4)).box(margin=1)
        (slice(1, 4, None), slice(2, 5, None), slice(3, 6, None))
        """
        hits = [np.flatnonzero(self.voxels.any(axis=tuple({0, 1, 2} - {axis}))) for axis in range(3)]
        if not len(hits[0]):
            return slice(0, 0), slice(0, 0), slice(0, 0)
        return self.box_around(np.array([(hit[0], hit[-1]) for hit in hits]).T, margin)

    def box_around(self, index: ArrayLike, margin: ArrayLike = 0) -> Box:
        """Smallest box that holds fractional indices, grown by a margin and clipped to the grid.

        Parameters
        ----------
        index : array_like, shape (n, 3)
            Voxel (plane, row, col); n > 0.
        margin : int or array_like of int, shape (3,)
            Voxels on each side.

        Returns
        -------
        tuple of slice
            Of at least one voxel along each axis.
        """
        index, margin, last = np.asarray(index), np.asarray(margin), np.array(self.shape) - 1
        low = np.clip(np.floor(index.min(axis=0)).astype(int) - margin, 0, last)
        high = np.clip(np.ceil(index.max(axis=0)).astype(int) + margin, low, last) + 1
        planes, rows, cols = (slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
        return planes, rows, cols

    def affine_from(self, start: ArrayLike, step: ArrayLike = 1) -> Affine:
        """Affine of another grid along the same axes.

        Parameters
        ----------
        start : array_like, shape (3,)
            Fractional index, on this grid, of the other grid's first voxel.
        step : float or array_like, shape (3,)
            Voxels of this grid from each voxel of the other to its next.

        Returns
        -------
        ndarray, shape (4, 4)
            Voxel index of the other grid -> world mm.

        Examples
        --------
        >>> Volume(np.zeros((4, 4, 4)), np.eye(4)).affine_from((0.5, 0.5, 0.5), 2)[0]
        array([2. , 0. , 0. , 0.5])
        """
        affine = self.affine.copy()
        affine[:3, 3] = self.to_world(start)
        affine[:3, :3] *= step
        return affine

    def with_voxels(self, voxels: NDArray) -> Self:
        """Other voxels on the same grid.

        Parameters
        ----------
        voxels : ndarray, shape (P, R, C)

        Returns
        -------
        Volume

        Raises
        ------
        InputRefused
            ``GridMismatch`` when the shape is another.
        """
        if voxels.shape != self.voxels.shape:
            raise InputRefused("GridMismatch", f"The voxels have shape {voxels.shape}; the grid has {self.shape}.")
        return replace(self, voxels=voxels)

    def crop(self, box: Box) -> Self:
        """Part of the volume inside an index box; its voxels keep their place in the world.

        Parameters
        ----------
        box : tuple of slice
            Steps of 1.

        Returns
        -------
        Volume
            Its voxels are a view.

        Examples
        --------
        >>> v = Volume(np.zeros((4, 4, 4)), np.eye(4))
        >>> v.crop(np.s_[1:3, :, 2:]).affine[:3, 3]
        array([1., 0., 2.])
        """
        start = [range(n)[s].start for n, s in zip(self.shape, box, strict=True)]
        return replace(self, voxels=self.voxels[box], affine=self.affine_from(start))

    def canonical(self) -> Self:
        """The same voxels with planes rising to the head's top, rows to the back and columns to the left.

        Returns
        -------
        Volume
            Axes are only permuted and flipped, never resampled, so every voxel keeps its place in the world.
        """
        return self.reorder(canonical_order(self.affine))

    def reorder(self, order: AxisOrder) -> Self:
        """Permute and flip the axes; every voxel keeps its place in the world.

        Parameters
        ----------
        order : AxisOrder

        Returns
        -------
        Volume
        """
        flips = tuple(slice(None, None, -1 if flip else 1) for flip in order.flips)
        voxels = self.voxels.transpose(order.axes)[flips]
        columns = self.affine[:3, list(order.axes)]
        last = np.array(voxels.shape) - 1
        affine = np.eye(4)
        affine[:3, :3] = columns * np.where(order.flips, -1, 1)
        affine[:3, 3] = self.affine[:3, 3] + columns @ np.where(order.flips, last, 0)
        return replace(self, voxels=voxels, affine=affine)


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
    directions = affine[:3, :3] / np.linalg.norm(affine[:3, :3], axis=0)
    best = max(
        ((a, b, c) for a in range(3) for b in range(3) for c in range(3) if {a, b, c} == {0, 1, 2}),
        key=lambda axes: sum(abs(directions[w, a]) for w, a in zip(_WORLD_AXIS, axes, strict=True)),
    )
    flips = [bool(directions[w, a] < 0) for w, a in zip(_WORLD_AXIS, best, strict=True)]
    return AxisOrder(best, (flips[0], flips[1], flips[2]))


def inside_grid(index: ArrayLike, shape: tuple[int, ...]) -> NDArray[np.bool_]:
    """Whether fractional indices round to an element of an array.

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
    nearest = np.rint(np.moveaxis(np.asarray(index, float), -1, 0))
    return np.logical_and.reduce([(i >= 0) & (i < n) for i, n in zip(nearest, shape, strict=True)])


def nearest_values(values: NDArray, index: ArrayLike, *, outside: float) -> NDArray:
    """Values of the array elements nearest to fractional indices; a half goes to the even element.

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
    """
    inside = inside_grid(index, values.shape)
    nearest = (np.rint(i) for i in np.moveaxis(np.asarray(index, float), -1, 0))
    return np.where(inside, values[tuple(np.where(inside, i, 0).astype(np.intp) for i in nearest)], outside)


def same_grid(a: Volume, b: Volume, tol: float = 0.05) -> bool:
    """Whether two volumes share shape and place.

    Parameters
    ----------
    a, b : Volume
    tol : float
        Largest distance between their corner voxels along an axis of the world, mm.

    Returns
    -------
    bool
    """
    if a.shape != b.shape:
        return False
    corners = np.array(np.meshgrid(*[(0, n - 1) for n in a.shape])).reshape(3, -1).T
    return bool(np.abs(a.to_world(corners) - b.to_world(corners)).max() <= tol)


def check_same_grid(a: Volume, b: Volume, what: str) -> None:
    """Refuse two volumes that do not share one grid.

    Parameters
    ----------
    a, b : Volume
    what : str
        The two in words, e.g. "patch and bone".

    Raises
    ------
    InputRefused
        ``GridMismatch``.
    """
    if not same_grid(a, b):
        raise InputRefused(
            "GridMismatch",
            f"The {what} lie on different grids, of shapes {a.shape} and {b.shape}.",
            "Bring them onto one grid first.",
        )
