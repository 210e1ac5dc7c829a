"""Marching tetrahedra: closed manifolds of any mask, volumes known in closed form."""

import numpy as np
import pytest
from random_masks import OBLIQUE, noise

from cranio_nb.geometry.mesh_check import check_mesh
from cranio_nb.mesh import Mesh
from cranio_nb.methods.you import tetrahedra
from cranio_nb.volume import Volume


def ball(n, radius=1.0):
    """Signed distance to a sphere on a grid of n points from -1.2 to 1.2, and the grid's step."""
    grid = np.indices((n, n, n)) / (n - 1) * 2.4 - 1.2
    return radius - np.sqrt((grid**2).sum(axis=0)), 2.4 / (n - 1)


@pytest.mark.parametrize("affine", [np.eye(4), np.diag([-1.0, 1, 1, 1]), OBLIQUE])
def test_any_mask_has_a_closed_manifold_that_looks_outward(affine):
    report = check_mesh(tetrahedra.extract(Volume(noise(), affine)))
    assert report.sound


def test_a_voxel_is_the_cell_around_it_in_the_freudenthal_lattice():
    """Half of each of its 14 edges reaches a corner of the surface: a polyhedron of volume 1/2."""
    one = np.zeros((3, 3, 3), bool)
    one[1, 1, 1] = True
    mesh = tetrahedra.extract(Volume(one, np.eye(4)))
    assert (len(mesh.vertices), len(mesh.faces)) == (14, 24)
    assert mesh.volume == pytest.approx(0.5)


def test_one_body_has_the_euler_characteristic_of_a_sphere_and_a_ring_that_of_a_torus():
    x, y, z = np.indices((21, 21, 21)) - 10.0
    for field, wanted in ((8 - np.sqrt(x**2 + y**2 + z**2), 2), (3 - np.hypot(np.hypot(x, y) - 6, z), 0)):
        vertices, faces = tetrahedra.march(field)
        assert len(vertices) - len(faces) * 3 / 2 + len(faces) == wanted


def test_the_volume_of_a_ball_converges_with_the_square_of_the_step():
    errors = []
    for n in (10, 20, 40):
        field, step = ball(n)
        vertices, faces = tetrahedra.march(field)
        errors.append(4 / 3 * np.pi - Mesh(vertices * step, faces).volume)
    assert errors[0] > 0  # chords lie inside
    assert errors[1] / errors[0] < 0.3 and errors[2] / errors[1] < 0.3


def test_vertices_lie_on_the_level_of_a_linear_field():
    p, r, c = np.indices((6, 5, 7))
    vertices, _ = tetrahedra.march(0.31 * p - 0.7 * r + 0.43 * c - 0.19)
    np.testing.assert_allclose(vertices @ [0.31, -0.7, 0.43] - 0.19, 0, atol=1e-12)


def test_a_mask_at_the_border_is_closed_there():
    assert check_mesh(tetrahedra.extract(Volume(np.ones((3, 4, 5), bool), np.eye(4)))).sound
