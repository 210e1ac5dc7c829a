"""Membranes across rims and the wall between two: surfaces of least area known in closed form."""

import numpy as np
import pytest
from rims import circle

from cranio_nb.errors import InputRefused
from cranio_nb.geometry.mesh_check import check_mesh
from cranio_nb.mesh import Mesh
from cranio_nb.methods.you import membrane

UP = np.array([0.0, 0.0, 1.0])


def rim(points):
    return membrane.Loop(points, np.arange(len(points)) * 12 / len(points), 12.0)


def test_the_fill_of_a_plane_rim_is_plane():
    made = membrane.span_loop(circle(10, 60, height=3.0), UP, 1.0)
    np.testing.assert_allclose(made.mesh.vertices[:, 2], 3.0, atol=1e-9)
    assert made.converged and made.areas[-1] == pytest.approx(30 * 100 * np.sin(np.pi / 30))  # of the 60-gon
    assert made.mesh.normals[:, 2] == pytest.approx(1.0)


def test_the_fill_has_a_triangle_edge_on_every_edge_of_the_rim_and_no_others():
    made = membrane.span_loop(circle(10, 60), UP, 1.0)
    edges = made.mesh.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    keys, count = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    assert len(keys[count == 1]) == 60 and count.max() == 2


def test_the_area_never_rises_and_ends_at_scherks_surface():
    """cos(x) e^z = cos(y) is minimal (Scherk 1834)."""
    side = np.linspace(-1.2, 1.2, 49)[:-1]
    square = np.concatenate(
        [
            np.column_stack(p)
            for p in (
                (side, np.full(48, -1.2)),
                (np.full(48, 1.2), side),
                (-side, np.full(48, 1.2)),
                (np.full(48, -1.2), -side),
            )
        ]
    )
    loop = np.column_stack([square, np.log(np.cos(square[:, 1]) / np.cos(square[:, 0]))])
    made = membrane.span_loop(loop, UP, 0.05, tol=1e-5, max_iter=100)
    x, y, z = made.mesh.vertices.T
    assert made.converged and (np.diff(made.areas) <= 1e-9).all() and made.areas[-1] < made.areas[0] - 1e-3
    np.testing.assert_allclose(z, np.log(np.cos(y) / np.cos(x)), atol=5e-3)


def test_two_fills_and_their_wall_are_a_solid():
    for n, m in ((60, 60), (60, 41), (37, 52)):
        rims = [rim(circle(10, n, height=4.0)), rim(circle(8, m, start=0.02))]
        fills = [membrane.span_loop(r.points, UP, 1.0) for r in rims]
        mesh = membrane.join_membranes(*fills, *rims)
        report = check_mesh(mesh)
        assert report.sound and report.n_parts == 1
        assert mesh.volume == pytest.approx(np.pi * 4 / 3 * (100 + 80 + 64), rel=0.02)  # a frustum


def test_even_steps_keep_a_circle_and_its_stations():
    loop = membrane.resample_loop(rim(circle(20, 500)), 1.0, 0.5)
    np.testing.assert_allclose(np.linalg.norm(loop.points, axis=1), 20, atol=0.02)
    turn = np.arctan2(loop.points[:, 1], loop.points[:, 0]) % (2 * np.pi)
    ahead = (loop.stations - turn * 12 / (2 * np.pi) + 6) % 12 - 6
    np.testing.assert_allclose(ahead, 0, atol=0.03)
    assert (np.diff(loop.stations) > 0).all()


def test_a_rim_that_crosses_itself_is_refused():
    turn = np.linspace(0, 2 * np.pi, 80, endpoint=False)
    eight = np.column_stack([10 * np.sin(turn), 5 * np.sin(2 * turn), 0 * turn])
    with pytest.raises(InputRefused) as refused:
        membrane.span_loop(eight, UP, 0.5)
    assert refused.value.code == "TangledRim"


def test_a_membrane_needs_no_points_inside():
    made = membrane.span_loop(circle(1.0, 8), UP, 5.0)
    assert isinstance(made.mesh, Mesh) and len(made.mesh.vertices) == 8 and made.converged
