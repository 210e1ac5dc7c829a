"""An opening in the skull: where bone is wanted, and from where it is seen.

Frames: the sheet in voxel (plane, row, col); points and directions in the world (mm, LPS).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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
        World mm of a point inside the cranial cavity, from which the vault is seen.
    """

    sheet: Volume
    head_centre: NDArray[np.float64]

    @property
    def planes(self) -> tuple[int, int]:
        """First plane and one past the last plane the opening spans."""
        hit = np.flatnonzero(self.sheet.voxels.any(axis=(1, 2)))
        return int(hit[0]), int(hit[-1]) + 1

    @property
    def centre(self) -> NDArray[np.float64]:
        """Centre of the opening, shape (3,), world mm."""
        return self.sheet.to_world(np.argwhere(self.sheet.voxels).mean(axis=0))

    @property
    def direction(self) -> NDArray[np.float64]:
        """Unit vector from the head's centre to the opening, shape (3,), LPS."""
        towards = self.centre - self.head_centre
        return towards / np.linalg.norm(towards)
