"""Areas, normals and volumes of triangle meshes against closed forms."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from cranio_nb.mesh import Mesh

TETRAHEDRON = Mesh(
    np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]), np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
)


def hull_mesh(points):
    """Convex hull wound outwards by the hull's own equations."""
    hull = ConvexHull(points)
    mesh = Mesh(points, hull.simplices)
    wrong = np.einsum("fd,fd->f", mesh.area_vectors, hull.equations[:, :3]) < 0
    return Mesh(points, np.where(wrong[:, None], hull.simplices[:, ::-1], hull.simplices))


def ball(n):
    """Sphere of radius 1 by n points of a Fibonacci spiral."""
    z = 1 - (2 * np.arange(n) + 1) / n
    turn = np.pi * (1 + 5**0.5) * np.arange(n)
    flat = np.sqrt(1 - z**2)
    return hull_mesh(np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1))


def test_a_corner_tetrahedron():
    assert TETRAHEDRON.volume == pytest.approx(1 / 6, abs=1e-15)
    np.testing.assert_allclose(TETRAHEDRON.areas, [0.5, 0.5, 0.5, np.sqrt(3) / 2])
    np.testing.assert_allclose(TETRAHEDRON.normals, [[0, 0, -1], [0, -1, 0], [-1, 0, 0], np.ones(3) / np.sqrt(3)])
    np.testing.assert_allclose(TETRAHEDRON.centres[3], [1 / 3] * 3)


def test_volume_and_area_of_a_polyhedron_agree_with_the_hull_library():
    points = np.random.default_rng(3).normal(size=(40, 3)) * [80, 60, 5] + [-104, 33, -812]
    mesh, hull = hull_mesh(points), ConvexHull(points)
    assert mesh.volume == pytest.approx(hull.volume, rel=1e-12)
    assert mesh.areas.sum() == pytest.approx(hull.area, rel=1e-12)


def test_a_sphere_is_approached_from_below_and_in_second_order():
    coarse, fine = ball(500), ball(2000)  # half the edge length
    lack = [4 / 3 * np.pi - m.volume for m in (coarse, fine)]
    assert 0 < lack[1] < lack[0]
    assert lack[0] / lack[1] == pytest.approx(4, rel=0.1)
    assert fine.areas.sum() == pytest.approx(4 * np.pi, rel=0.005)
    np.testing.assert_allclose(fine.normals, fine.centres / np.linalg.norm(fine.centres, axis=1)[:, None], atol=0.05)


def test_volume_follows_the_determinant_of_an_affine_map():
    sphere = ball(300)
    a = np.array([[1.2, 0.3, 0.0], [-0.1, 0.9, 0.4], [0.2, 0.0, 2.0]])
    mapped = Mesh(sphere.vertices @ a.T + [5, 6, 7], sphere.faces)
    assert mapped.volume == pytest.approx(np.linalg.det(a) * sphere.volume, rel=1e-12)
    assert Mesh(3 * sphere.vertices, sphere.faces).volume == pytest.approx(27 * sphere.volume, rel=1e-12)


def test_far_from_the_origin_nothing_cancels():
    far = Mesh(TETRAHEDRON.vertices + 1e6, TETRAHEDRON.faces)
    assert far.volume == pytest.approx(1 / 6, rel=1e-9)


def test_winding_inwards_gives_the_negative_volume():
    sphere = ball(200)
    inside_out = Mesh(sphere.vertices, sphere.faces[:, ::-1])
    assert inside_out.volume == pytest.approx(-sphere.volume, rel=1e-12)
    np.testing.assert_allclose(inside_out.normals, -sphere.normals, atol=1e-12)


def test_area_vectors_of_a_closed_surface_cancel():
    np.testing.assert_allclose(ball(200).area_vectors.sum(axis=0), 0, atol=1e-12)


def test_normals_are_unit_and_a_face_without_area_has_none():
    flat = Mesh(np.array([[0.0, 0, 0], [1, 1, 1], [2, 2, 2], [0, 0, 3]]), np.array([[0, 1, 2], [0, 1, 3]]))
    assert flat.areas[0] == 0
    np.testing.assert_array_equal(flat.normals[0], 0)
    assert np.linalg.norm(flat.normals[1]) == pytest.approx(1)


def test_normals_of_a_spheres_vertices_point_away_from_its_centre():
    fine = ball(3000)
    np.testing.assert_allclose(fine.vertex_normals, fine.vertices, atol=0.05)
    lonely = Mesh(np.vstack([fine.vertices, [9.0, 9, 9]]), fine.faces)
    np.testing.assert_array_equal(lonely.vertex_normals[-1], 0)


def test_a_mesh_without_faces_holds_nothing():
    nothing = Mesh(np.empty((0, 3)), np.empty((0, 3), int))
    assert nothing.volume == 0.0
    assert nothing.areas.shape == (0,) and nothing.normals.shape == (0, 3)
