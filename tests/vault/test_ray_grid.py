"""A grid of rays: directions and their inverse, angles, look-ups; maps of radii."""

import numpy as np
import pytest

from cranio_nb.vault.ray_grid import RadiusMap, RayGrid, filled_from_nearest

CENTRE = np.array([31.0, -47.0, 812.0])
AXES = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]


@pytest.fixture(params=[5, 8, 61])
def grid(request):
    return RayGrid(CENTRE, AXES, np.radians(2.5), request.param)


def test_locate_undoes_directions_of_any_length(grid):
    np.testing.assert_allclose(np.linalg.norm(grid.directions, axis=-1), 1)
    np.testing.assert_allclose(grid.locate(3.7 * grid.directions), np.indices((grid.n, grid.n)), atol=1e-9)


def test_the_angle_from_the_middle_is_the_distance_on_the_map(grid):
    v, u = (np.indices((grid.n, grid.n)) - (grid.n - 1) / 2) * grid.step_rad
    np.testing.assert_allclose(grid.polar, np.hypot(v, u), atol=1e-12)
    np.testing.assert_allclose(np.arccos(np.clip(grid.directions @ AXES[2], -1, 1)), np.hypot(v, u), atol=1e-7)


def test_points_lie_at_their_radius(grid):
    radius = 80 + np.arange(grid.n**2, dtype=float).reshape(grid.n, grid.n) / 100
    np.testing.assert_allclose(np.linalg.norm(grid.points(radius) - CENTRE, axis=-1), radius)


def test_values_are_looked_up_at_the_nearest_ray_and_nowhere_else(grid):
    values = np.arange(grid.n**2).reshape(grid.n, grid.n)
    np.testing.assert_array_equal(grid.at(values, 5 * grid.directions, outside=-1), values)
    assert grid.at(values, AXES[0] - 5 * AXES[2], outside=-1) == -1


def test_rays_are_a_step_apart_on_the_vault(grid):
    flat = np.full((grid.n, grid.n), 80.0)
    radius_map = RadiusMap(grid, outer=flat, inner=flat - 8, hole=flat < 0)
    middle = grid.n // 2
    points = grid.points(flat)
    apart = np.linalg.norm(points[middle, middle] - points[middle, middle - 1])
    assert radius_map.step_mm == pytest.approx(apart, rel=1e-3)


def test_the_unknown_is_filled_from_the_nearest_known_place():
    values = np.full((7, 9), np.nan)
    values[1, 1], values[5, 7] = 3.0, 4.0
    v, u = np.indices(values.shape)
    near_first, near_second = np.hypot(v - 1, u - 1), np.hypot(v - 5, u - 7)
    found = filled_from_nearest(values)
    assert (found[near_first < near_second] == 3).all() and (found[near_second < near_first] == 4).all()
