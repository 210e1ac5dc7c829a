"""Simple closed meshes whose measures are known."""

import numpy as np
from skimage.measure import marching_cubes

from cranio_nb.mesh import Mesh


def ball(centre=(0.0, 0.0, 0.0), radius: float = 20.0) -> Mesh:
    """A ball about `centre`, mm, its normals outward."""
    axis = np.arange(-radius - 3, radius + 4)
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    vertices, faces, _, _ = marching_cubes(np.sqrt(x**2 + y**2 + z**2), radius, gradient_direction="ascent")
    mesh = Mesh(vertices + axis[0] + np.array(centre), faces.astype(np.intp))
    return mesh if mesh.volume > 0 else Mesh(mesh.vertices, mesh.faces[:, ::-1])


def cube(size: float, at=(0.0, 0.0, 0.0)) -> Mesh:
    """A cube about `at`, mm, of twelve faces."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))])
    return Mesh((corners - 0.5) * size + at, faces)
