"""Meshes that are sound, and meshes with one fault each."""

import numpy as np
import pytest
from measured_shapes import box, join, shell, sphere, weld

from cranio_nb.geometry.mesh_check import check_mesh
from cranio_nb.mesh import Mesh


def test_a_ball_is_sound_and_as_thick_as_its_diameter():
    report = check_mesh(sphere(5, (3, 4, 800)))
    assert report.sound and report.n_parts == 1
    assert report.volume == pytest.approx(4 / 3 * np.pi * 125, rel=0.01)
    assert report.wall_p1 == pytest.approx(10, rel=0.02)


def test_the_wall_of_a_shell_is_found():
    report = check_mesh(shell(10, 8.5).mesh)
    assert report.sound and report.n_parts == 2
    assert report.wall_p1 == pytest.approx(1.5, abs=0.1)


def test_faults_of_single_faces():
    ball = sphere(1, subdivisions=2)
    open_ball = check_mesh(Mesh(ball.vertices, ball.faces[1:]))
    assert not open_ball.closed and open_ball.n_open_edges == 3
    flipped = ball.faces.copy()
    flipped[0] = flipped[0, ::-1]
    report = check_mesh(Mesh(ball.vertices, flipped))
    assert report.closed and not report.manifold and report.n_flipped_edges == 3
    assert check_mesh(Mesh(ball.vertices, np.vstack([ball.faces, ball.faces[:1]]))).n_unclear == 1
    assert check_mesh(Mesh(ball.vertices, np.vstack([ball.faces, [[0, 0, 1]]]))).n_unclear == 1
    inverted = check_mesh(Mesh(ball.vertices, ball.faces[:, ::-1]))
    assert inverted.manifold and inverted.volume < 0 and not inverted.sound
    broken = ball.vertices.copy()
    broken[0, 0] = np.nan
    assert not check_mesh(Mesh(broken, ball.faces)).sound


def test_cubes_that_share_an_edge_or_a_corner_are_not_manifold():
    along_edge = check_mesh(weld(join(box(), box(centre=(1, 1, 0)))))
    assert not along_edge.closed and along_edge.n_crossings == 0
    at_corner = check_mesh(weld(join(box(), box(centre=(1, 1, 1)))))
    assert at_corner.closed and at_corner.n_pinches == 1 and not at_corner.manifold
    assert at_corner.n_parts == 2 and at_corner.n_crossings == 0
    assert check_mesh(join(box(), box(centre=(1, 1, 1)))).sound  # apart, merely touching


def test_self_intersections_that_other_checks_let_pass():
    assert check_mesh(join(sphere(), sphere(centre=(0.7, 0.1, 0.2)))).n_crossings > 50
    assert check_mesh(join(sphere(), sphere(0.5))).n_crossings == 0  # nested, not crossing
    spiked = sphere(1, subdivisions=3)
    spike = spiked.vertices.copy()
    spike[0] = -3 * spike[0]
    report = check_mesh(Mesh(spike, spiked.faces))
    assert report.manifold and report.n_crossings > 0 and not report.sound


def test_no_mesh_is_not_sound():
    report = check_mesh(Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.intp)))
    assert not report.closed and not report.sound and report.n_parts == 0
