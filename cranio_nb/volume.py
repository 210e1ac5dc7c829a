"""A box of voxels and where it stands in the patient: the one type for CT, bone mask and patch.

Frames: voxel (plane, row, col) index -> world (x, y, z) in mm, DICOM LPS (x to the patient's left, y to the back,
z to the top of the head).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InputRefused

Affine = NDArray[np.float64]

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
        """Number of planes, rows and columns."""
        planes, rows, cols = self.voxels.shape
        return planes, rows, cols

    @property
    def spacing(self) -> NDArray[np.float64]:
        """Distance between voxel centres along (plane, row, col), shape (3,), in mm."""
        return np.linalg.norm(self.affine[:3, :3], axis=0)

    @property
    def voxel_volume(self) -> float:
        """Volume of one voxel in mm3."""
        return float(abs(np.linalg.det(self.affine[:3, :3])))

    def to_world(self, points: ArrayLike) -> NDArray[np.float64]:
        """World mm of voxel indices, both shape (..., 3)."""
        return np.asarray(points, float) @ self.affine[:3, :3].T + self.affine[:3, 3]

    def to_voxel(self, points: ArrayLike) -> NDArray[np.float64]:
        """Fractional voxel indices of world points in mm, both shape (..., 3)."""
        return (np.asarray(points, float) - self.affine[:3, 3]) @ np.linalg.inv(self.affine[:3, :3]).T

    def with_voxels(self, voxels: NDArray) -> Self:
        """Other voxels on the same grid."""
        if voxels.shape != self.voxels.shape:
            raise InputRefused("GridMismatch", f"The voxels have shape {voxels.shape}; the grid has {self.shape}.")
        return replace(self, voxels=voxels)

    def crop(self, box: tuple[slice, slice, slice]) -> Self:
        """Part of the volume inside an index box (steps of 1), as a view standing at the same place in the world.

        Examples
        --------
        >>> v = Volume(np.zeros((4, 4, 4)), np.eye(4))
        >>> v.crop(np.s_[1:3, :, 2:]).affine[:3, 3]
        array([1., 0., 2.])
        """
        start = [range(n)[s].start for n, s in zip(self.shape, box, strict=True)]
        affine = self.affine.copy()
        affine[:3, 3] = self.to_world(start)
        return replace(self, voxels=self.voxels[box], affine=affine)

    def canonical(self) -> Self:
        """The same voxels with planes rising to the head's top, rows to the back and columns to the left.

        Axes are only permuted and flipped, never resampled, so every voxel keeps its place in the world.
        """
        return self.reorder(canonical_order(self.affine))

    def reorder(self, order: AxisOrder) -> Self:
        """Permute and flip the axes; every voxel keeps its place in the world."""
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
    """New axis i is old axis `axes[i]`, reversed where `flips[i]`."""

    axes: tuple[int, int, int]
    flips: tuple[bool, bool, bool]

    @property
    def inverse(self) -> AxisOrder:
        """The order that undoes this one."""
        back = tuple(int(i) for i in np.argsort(self.axes))
        return AxisOrder((back[0], back[1], back[2]), (self.flips[back[0]], self.flips[back[1]], self.flips[back[2]]))


def canonical_order(affine: Affine) -> AxisOrder:
    """The axis order that turns a grid into the package's own (planes up, rows back, columns left).

    Parameters
    ----------
    affine : ndarray, shape (4, 4)
        Array index -> world mm (LPS) of the grid as stored.
    """
    directions = affine[:3, :3] / np.linalg.norm(affine[:3, :3], axis=0)
    best = max(
        ((a, b, c) for a in range(3) for b in range(3) for c in range(3) if {a, b, c} == {0, 1, 2}),
        key=lambda axes: sum(abs(directions[w, a]) for w, a in zip(_WORLD_AXIS, axes, strict=True)),
    )
    flips = [bool(directions[w, a] < 0) for w, a in zip(_WORLD_AXIS, best, strict=True)]
    return AxisOrder(best, (flips[0], flips[1], flips[2]))


def same_grid(a: Volume, b: Volume, tol: float = 0.05) -> bool:
    """Whether two volumes share shape and place: their corner voxels lie within `tol` mm."""
    if a.shape != b.shape:
        return False
    corners = np.array(np.meshgrid(*[(0, n - 1) for n in a.shape])).reshape(3, -1).T
    return bool(np.abs(a.to_world(corners) - b.to_world(corners)).max() <= tol)
