"""Faces that pass through each other, against signed volumes, and faces that only touch."""

import numpy as np

from cranio_nb.geometry.self_intersection import crossings
from cranio_nb.mesh import Mesh


def test_crossings_agree_with_edges_through_faces():
    rng = np.random.default_rng(8)
    for size in (0.1, 0.5, 2.0):
        corners = rng.random((60, 1, 3)) + size * rng.standard_normal((60, 3, 3))
        soup = Mesh(corners.reshape(-1, 3), np.arange(180).reshape(-1, 3))
        wanted = {(i, j) for i in range(60) for j in range(i) if _pierces(corners[i], corners[j])}
        assert {(max(p), min(p)) for p in crossings(soup).tolist()} == wanted


def test_faces_in_one_plane_cross_only_where_they_overlap():
    a = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0]], float)
    for shift, crossing in (((1, 1, 0), 1), ((4, 0, 0), 0), ((1, 1, 1e-3), 0), ((0, 0, 0), 1)):
        pair = Mesh(np.vstack([a, a + np.array(shift)]), np.arange(6).reshape(2, 3))
        assert len(crossings(pair)) == crossing


def test_a_face_folded_back_onto_its_neighbour_crosses_it():
    vertices = np.array([[0, 0, 0], [2, 0, 0], [1, 1, 0], [1, 0.5, 0], [1, -1, 0]])
    assert len(crossings(Mesh(vertices, np.array([[0, 1, 2], [1, 0, 3]])))) == 1
    assert len(crossings(Mesh(vertices, np.array([[0, 1, 2], [1, 0, 4]])))) == 0


def _pierces(a, b):
    """Whether an edge of one triangle goes through the other, by signed volumes."""

    def through(segment, triangle):
        def volume(*points):
            p, q, r, s = points
            return np.linalg.det([q - p, r - p, s - p])

        start, end = segment
        sides = [volume(start, end, triangle[k], triangle[(k + 1) % 3]) for k in range(3)]
        crosses_plane = volume(start, *triangle) * volume(end, *triangle) < 0
        return crosses_plane and (min(sides) > 0 or max(sides) < 0)

    return any(through((p[k], p[(k + 1) % 3]), q) for p, q in ((a, b), (b, a)) for k in range(3))
