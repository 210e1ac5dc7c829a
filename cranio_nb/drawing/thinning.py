"""A fine mesh -> one with few faces, for a scene that a browser has to turn; never for measures."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..mesh import Mesh

_GROWTH = 1.15  # of the cells, until the faces are few enough


def thin_mesh(mesh: Mesh, carried: NDArray, max_faces: int) -> tuple[Mesh, NDArray[np.float64]]:
    """Make the vertices of each cell of a grid one vertex.

    Parameters
    ----------
    mesh : Mesh
        World mm.
    carried : ndarray, shape (V, K)
        Numbers at its vertices, averaged with them.
    max_faces : int

    Returns
    -------
    Mesh
        With at most `max_faces` faces; the mesh itself where it has no more.
    ndarray, shape (V', K)
        The carried numbers at its vertices.

    Notes
    -----
    Vertex clustering after Rossignac and Borrel 1993. Quadric decimation keeps shapes better, but can take a minute.

    Examples
    --------
    >>> import trimesh
    >>> ball = trimesh.creation.icosphere(subdivisions=4, radius=10.0)
    >>> thin, carried = thin_mesh(Mesh(ball.vertices, ball.faces), ball.vertices, 500)
    >>> len(ball.faces), len(thin.faces) <= 500, bool(np.allclose(carried, thin.vertices))
    (5120, True, True)
    """
    # cells that would give about so many faces if the surface were flat
    cell = np.sqrt(2 * mesh.areas.sum() / max_faces)
    points, faces = np.column_stack([mesh.vertices, carried]), mesh.faces
    while len(faces) > max_faces:
        # the mean of each cell's vertices; faces with two corners in one cell vanish
        _, group, sizes = np.unique(np.floor(points[:, :3] / cell), axis=0, return_inverse=True, return_counts=True)
        points = np.column_stack([np.bincount(group.ravel(), column) / sizes for column in points.T])
        faces = group.ravel()[faces]
        faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
        cell *= _GROWTH
    return Mesh(points[:, :3], faces), points[:, 3:]
