"""An opening in the skull: where bone is wanted, and the point inside the head that rays to it start from.

Frames: the sheet in voxel (plane, row, col); points and directions in the world (mm, LPS).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .grid import true_indices
from .volume import Volume


@dataclass(frozen=True, eq=False)
class Opening:
    """An opening in the skull.

    Parameters
    ----------
    sheet : Volume
        Bool (P, R, C) mask on the bone's grid: a coarse sheet across the hole, where bone is wanted.
        It shows where the hole is and how far it reaches, not the shape of the missing bone.
    head_centre : ndarray, shape (3,)
        World mm of a point inside the cranial cavity: where rays to the vault start.
    head_axes : ndarray, shape (3, 3), optional
        Rows: the head's left, back and up, orthonormal, world, along which rays to the vault are laid; where they are
        not given, a method that needs them finds them in the bone.

    Examples
    --------
    >>> sheet = np.zeros((4, 4, 4), bool)
    >>> sheet[1:3, 1, 1] = True
    >>> opening = Opening(Volume(sheet, np.eye(4)), np.array([1.5, 1.0, -9.0]))
    >>> opening.planes, opening.centre, opening.direction
    ((1, 3), array([1.5, 1. , 1. ]), array([0., 0., 1.]))
    """

    sheet: Volume
    head_centre: NDArray[np.float64]
    head_axes: NDArray[np.float64] | None = None

    @property
    def planes(self) -> tuple[int, int]:
        """The planes that the opening spans.

        Returns
        -------
        tuple of int
            First plane and one past the last.
        """
        hit = np.flatnonzero(self.sheet.voxels.any(axis=(1, 2)))
        return int(hit[0]), int(hit[-1]) + 1

    @property
    def centre(self) -> NDArray[np.float64]:
        """Centre of the opening.

        Returns
        -------
        ndarray, shape (3,)
            World mm.
        """
        return self.sheet.to_world(true_indices(self.sheet.voxels).mean(axis=0))

    @property
    def direction(self) -> NDArray[np.float64]:
        """Way from the head's centre to the opening.

        Returns
        -------
        ndarray, shape (3,)
            Unit vector, world.
        """
        towards = self.centre - self.head_centre
        return towards / np.linalg.norm(towards)
