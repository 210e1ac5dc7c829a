"""A triangle mesh in the world: vertices in mm (DICOM LPS), faces wound so that normals point outward."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

OUTER, INNER, RIM = 0, 1, 2
"""Labels of a prosthesis's faces: towards the scalp, towards the brain, against the bone."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles.

    Parameters
    ----------
    vertices : ndarray of float, shape (V, 3)
        World positions in mm.
    faces : ndarray of int, shape (F, 3)
        Vertex indices, counter-clockwise seen from outside.

    Examples
    --------
    >>> tetrahedron = Mesh(np.array([[0.0, 0, 0], [6, 0, 0], [0, 6, 0], [0, 0, 6]]),
    ...                    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    >>> round(tetrahedron.volume, 9)
    36.0
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.intp]

    @property
    def corners(self) -> NDArray[np.float64]:
        """Corner positions of each face.

        Returns
        -------
        ndarray, shape (F, 3, 3)
            mm.
        """
        return self.vertices[self.faces]

    @property
    def centres(self) -> NDArray[np.float64]:
        """Centroid of each face.

        Returns
        -------
        ndarray, shape (F, 3)
            mm.
        """
        return self.corners.mean(axis=1)

    @property
    def area_vectors(self) -> NDArray[np.float64]:
        """Outward normal of each face times its area.

        Returns
        -------
        ndarray, shape (F, 3)
            mm2.
        """
        a, b, c = np.moveaxis(self.corners, 1, 0)
        return np.cross(b - a, c - a) / 2

    @property
    def areas(self) -> NDArray[np.float64]:
        """Area of each face.

        Returns
        -------
        ndarray, shape (F,)
            mm2.
        """
        return np.linalg.norm(self.area_vectors, axis=1)

    @property
    def normals(self) -> NDArray[np.float64]:
        """Outward unit normal of each face.

        Returns
        -------
        ndarray, shape (F, 3)
            Zero for a face without area.
        """
        vectors = self.area_vectors
        lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
        return np.divide(vectors, lengths, out=np.zeros((len(self.faces), 3)), where=lengths > 0)

    @cached_property
    def vertex_normals(self) -> NDArray[np.float64]:
        """Outward unit normal of each vertex, the mean of its faces by area; kept, for many views of one mesh.

        Returns
        -------
        ndarray, shape (V, 3)
            Zero for a vertex without a face.
        """
        # sum of area vectors around each vertex
        corner, shares = self.faces.ravel(), np.repeat(self.area_vectors, 3, axis=0)
        total = np.stack([np.bincount(corner, share, len(self.vertices)) for share in shares.T], axis=1)
        return total / np.linalg.norm(total, axis=1, keepdims=True).clip(1e-12)

    @property
    def volume(self) -> float:
        """Enclosed volume by the divergence theorem.

        Returns
        -------
        float
            mm3; positive when normals point outward.
        """
        if not len(self.faces):
            return 0.0
        a, b, c = np.moveaxis(self.corners - self.vertices.mean(axis=0), 1, 0)  # near the origin: no cancellation
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)
