"""Rays from inside hollow balls, whose radii are known."""

import numpy as np

from cranio_nb.vault.cavity_walls import even_directions, measure_walls
from cranio_nb.volume import Volume

CENTRE = np.array([30.0, -40.0, 800.0])
STEP = 2.0


def ball(chin=False):
    """A hollow ball of 60 to 66 mm, with a chin of more bone 80 to 90 mm away in the direction of -y if wanted."""
    n = 101
    affine = np.array([[0, 0, STEP, 0], [0, STEP, 0, 0], [STEP, 0, 0, 0], [0, 0, 0, 1.0]])
    affine[:3, 3] = CENTRE - STEP * (n - 1) / 2
    z, y, x = STEP * (np.indices((n, n, n)) - (n - 1) / 2)
    r = np.sqrt(x**2 + y**2 + z**2)
    bone = (r > 60) & (r < 66)
    return Volume(bone | ((r > 80) & (r < 90) & (-y > 0.9 * r)) if chin else bone, affine)


def test_first_and_last_bone_of_a_hollow_ball_are_its_radii():
    walls = measure_walls(ball(), CENTRE)
    assert np.abs(walls.first - 60).max() <= STEP
    assert np.abs(walls.last - 66).max() <= STEP
    np.testing.assert_array_equal(walls.deep, 0)
    np.testing.assert_array_equal(walls.face, 0)


def test_bone_behind_the_wall_points_to_the_face():
    walls = measure_walls(ball(chin=True), CENTRE)
    front = -walls.directions[:, 1]
    assert np.abs(walls.deep[front > 0.95] - 10).max() <= STEP
    np.testing.assert_array_equal(walls.deep[front < 0.85], 0)
    np.testing.assert_allclose(walls.face / np.linalg.norm(walls.face), [0, -1, 0], atol=0.02)


def test_rays_that_meet_nothing_have_no_walls():
    nothing = Volume(np.zeros((9, 9, 9), bool), np.eye(4))
    walls = measure_walls(nothing, np.full(3, 4.0))
    assert np.isnan(walls.first).all() and np.isnan(walls.last).all()
    np.testing.assert_array_equal(walls.deep, 0)


def test_directions_are_even():
    rays = even_directions(3000)
    np.testing.assert_allclose(np.linalg.norm(rays, axis=1), 1)
    np.testing.assert_allclose(rays.T @ rays / 3000, np.eye(3) / 3, atol=1e-3)
