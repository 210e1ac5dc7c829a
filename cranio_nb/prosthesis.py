"""What comes out of a design: the prosthesis, and a row of the paper's Table 3.

Frames: the mesh in world mm (LPS), the patch in voxel (plane, row, col).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .mesh import Mesh
from .volume import Volume


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
        The method's own intermediate results, one per opening, for pictures and lessons.

    Examples
    --------
    >>> from cranio_nb.mesh import INNER, OUTER
    >>> triangle = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    >>> made = Prosthesis(triangle, np.array([OUTER], np.uint8), None, "none")
    >>> len(made.surface(OUTER).faces), len(made.surface(INNER).faces)
    (1, 0)
    """

    mesh: Mesh
    sides: NDArray[np.uint8]
    patch: Volume | None
    method: str
    parameters: dict[str, Any] = field(default_factory=dict)
    record: dict[str, Any] = field(default_factory=dict)
    working: tuple[Any, ...] = ()

    def surface(self, side: int) -> Mesh:
        """The faces of one side as an open mesh.

        Parameters
        ----------
        side : int
            `OUTER`, `INNER` or `RIM`.

        Returns
        -------
        Mesh
            With only the vertices it uses.
        """
        faces = self.mesh.faces[self.sides == side]
        used, compact = np.unique(faces, return_inverse=True)
        return Mesh(self.mesh.vertices[used], compact.reshape(-1, 3))

    def cropped(self) -> Prosthesis:
        """The same with no more of its grid than the box of its patch.

        Returns
        -------
        Prosthesis
        """
        return self if self.patch is None else replace(self, patch=self.patch.crop(self.patch.box()))


@dataclass(frozen=True)
class DistanceStats:
    """A row of the paper's Table 3: the distances of a surface's nodes from another surface (mm or voxels)."""

    min: float
    max: float
    mean: float
    std: float
