"""A thinned mesh keeps its shape and what its vertices carry."""

import numpy as np
import pytest

from cranio_nb.drawing.thinning import thin_mesh
from cranio_nb.mesh import Mesh


@pytest.mark.parametrize("max_faces", [2000, 300])
def test_a_thinned_sphere_keeps_to_its_radius(max_faces):
    from skimage.measure import marching_cubes

    grid = np.linalg.norm(np.mgrid[-25:26, -25:26, -25:26], axis=0)
    vertices, faces, _, _ = marching_cubes(20 - grid, 0.0)
    mesh, carried = thin_mesh(Mesh(vertices - 25, faces.astype(int)), vertices - 25, max_faces)
    assert 0.3 * max_faces < len(mesh.faces) <= max_faces
    cell = np.sqrt(4 * np.pi * 20**2 * 3 / max_faces)
    sag = 20 - np.linalg.norm(mesh.vertices, axis=1)
    assert sag.min() > -0.1 and sag.max() < cell**2 / 20
    np.testing.assert_allclose(carried, mesh.vertices, atol=1e-9)
