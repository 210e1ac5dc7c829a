"""What goes into a design and what comes out of it: the lesion, the prosthesis, and a row of the paper's Table 3.

Frames: lesions are given in voxel (plane, row, col); meshes in world mm (LPS).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .mesh import Mesh
from .volume import Volume

OUTER, INNER, RIM = 0, 1, 2
"""Labels of `Prosthesis.sides`: towards the scalp, towards the brain, against the bone."""


@dataclass(frozen=True, eq=False)
class Lesion:
    """An opening in the skull.

    Parameters
    ----------
    opening : Volume
        Bool (P, R, C) mask on the bone's grid: a coarse sheet across the hole, where bone is wanted.
        It shows where the hole is and how far it reaches, not the shape of the missing bone.
    head_centre : ndarray, shape (3,)
        World mm of a point inside the cranial cavity, from which the vault is seen.
    """

    opening: Volume
    head_centre: NDArray[np.float64]

    @property
    def planes(self) -> tuple[int, int]:
        """First plane and one past the last plane the opening spans."""
        hit = np.flatnonzero(self.opening.voxels.any(axis=(1, 2)))
        return int(hit[0]), int(hit[-1]) + 1

    @property
    def centre(self) -> NDArray[np.float64]:
        """Centre of the opening, shape (3,), world mm."""
        return self.opening.to_world(np.argwhere(self.opening.voxels).mean(axis=0))

    @property
    def direction(self) -> NDArray[np.float64]:
        """Unit vector from the head's centre to the opening, shape (3,), LPS."""
        towards = self.centre - self.head_centre
        return towards / np.linalg.norm(towards)


@dataclass(frozen=True, eq=False)
class Prosthesis:
    """A designed prosthesis.

    Parameters
    ----------
    mesh : Mesh
        Closed surface, world mm.
    sides : ndarray of uint8, shape (F,)
        `OUTER`, `INNER` or `RIM` for each face.
    patch : Volume or None
        Bool mask on the bone's grid; never overlaps bone. None for a method that works on meshes alone.
    method : str
        Name of the method that made it.
    parameters : dict
        Every parameter of the method, JSON-able.
    record : dict
        What happened: for slice methods a list ``slices`` of per-slice values, findings, timings. JSON-able.
    working : tuple
        The method's own intermediate results, one per lesion, for pictures and lessons.
    """

    mesh: Mesh
    sides: NDArray[np.uint8]
    patch: Volume | None
    method: str
    parameters: dict[str, Any] = field(default_factory=dict)
    record: dict[str, Any] = field(default_factory=dict)
    working: tuple[Any, ...] = ()

    def surface(self, side: int) -> Mesh:
        """The faces of one side as an open mesh (`OUTER`, `INNER` or `RIM`), with only the vertices it uses."""
        faces = self.mesh.faces[self.sides == side]
        used, compact = np.unique(faces, return_inverse=True)
        return Mesh(self.mesh.vertices[used], compact.reshape(-1, 3))


@dataclass(frozen=True)
class DistanceStats:
    """A row of the paper's Table 3: the distances of a surface's nodes from another surface (mm or voxels)."""

    min: float
    max: float
    mean: float
    std: float
