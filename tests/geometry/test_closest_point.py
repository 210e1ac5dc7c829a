"""The nearest place on a mesh, against every triangle of it tried by another library."""

import numpy as np
import pytest

from cranio_nb.geometry.closest_point import nearest
from cranio_nb.mesh import Mesh


@pytest.mark.parametrize("size", [1.0, 30.0])
def test_nearest_place_agrees_with_trimesh(size):
    trimesh = pytest.importorskip("trimesh")
    rng = np.random.default_rng(11)
    mesh = Mesh(rng.normal(size=(60, 3)) * size, rng.integers(0, 60, (40, 3)))
    mesh = Mesh(mesh.vertices, mesh.faces[mesh.areas > 1e-6])
    points = rng.normal(size=(300, 3)) * 20
    peer = np.full(300, np.inf)
    for corners in mesh.corners:
        place = trimesh.triangles.closest_point(np.repeat(corners[None], 300, axis=0), points)
        peer = np.minimum(peer, np.linalg.norm(place - points, axis=1))
    found = nearest(points, mesh)
    np.testing.assert_allclose(found.distance, peer, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(found.places(mesh) - points, axis=1), peer, atol=1e-9)
