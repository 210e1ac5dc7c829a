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
from .grid import Affine, AxisOrder, Box, box_around, canonical_order, move_affine, nearest_values


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
        """Values of the voxels nearest to fractional indices; on a border, the largest of those that share it.

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
        # first and last plane, row and column with any true voxel
        hits = [np.flatnonzero(self.voxels.any(axis=tuple({0, 1, 2} - {axis}))) for axis in range(3)]
        if not len(hits[0]):
            return slice(0, 0), slice(0, 0), slice(0, 0)
        return box_around([[hit[0] for hit in hits], [hit[-1] for hit in hits]], self.shape, margin)

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
        return replace(self, voxels=self.voxels[box], affine=move_affine(self.affine, start))

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
        # the voxels: axes permuted, then reversed; both are views
        flips = tuple(slice(None, None, -1 if flip else 1) for flip in order.flips)
        voxels = self.voxels.transpose(order.axes)[flips]
        # the affine: its columns permuted; a reversed axis starts at its last voxel
        columns = self.affine[:3, list(order.axes)]
        last = np.array(voxels.shape) - 1
        affine = np.eye(4)
        affine[:3, :3] = columns * np.where(order.flips, -1, 1)
        affine[:3, 3] = self.affine[:3, 3] + columns @ np.where(order.flips, last, 0)
        return replace(self, voxels=voxels, affine=affine)


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

    Examples
    --------
    >>> volume = Volume(np.zeros((2, 2, 2)), np.eye(4))
    >>> same_grid(volume, volume.with_voxels(volume.voxels > 0)), same_grid(volume, volume.crop(np.s_[1:, :, :]))
    (True, False)
    """
    if a.shape != b.shape:
        return False
    # affine maps differ most at a corner
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
        here, there = (f"{v.shape} of {v.spacing.round(2)} mm at {v.affine[:3, 3].round(1)}" for v in (a, b))
        raise InputRefused(
            "GridMismatch",
            f"The {what} lie on different grids (shape, voxel, corner): {here} and {there}.",
            "Bring them onto one grid first.",
        )
