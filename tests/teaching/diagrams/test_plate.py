"""The drawn map: a place of the head lies as far from the middle of its map as its ray is from the middle ray."""

import numpy as np
import pytest
from hollow_ball import OUTER, ball

from cranio_nb.teaching.diagrams import plate_map
from cranio_nb.teaching.diagrams.plate import on_map, on_surface, rim_angles
from cranio_nb.vault.ray_grid import RadiusMap, RayGrid

AXES = np.linalg.qr(np.array([[0.2, 1.0, 0.1], [0.1, 0.0, 1.0], [1.0, 0.1, 0.0]]))[0]
GRID = RayGrid(np.array([3.0, -2.0, 7.0]), AXES, np.radians(1.0), 121)
POLAR, AROUND = np.array([10.0, 30.0, 45.0]), np.array([0.0, 130.0, 250.0])


def test_angles_are_kept_on_the_head_and_on_the_map():
    points = on_surface(GRID, np.full((121, 121), 80.0), POLAR, AROUND) - GRID.centre
    assert np.linalg.norm(points, axis=1) == pytest.approx(80.0)
    assert np.degrees(np.arccos(points @ AXES[2] / 80.0)) == pytest.approx(POLAR)
    flat = on_map(POLAR, AROUND)
    assert np.hypot(*flat.T) == pytest.approx(POLAR)
    v, u = np.degrees(GRID.step_rad) * (GRID.locate(points) - 60)  # the map's own place of the same points
    assert flat == pytest.approx(np.column_stack([u, v]))


def test_the_rim_is_that_of_the_hole():
    hole = np.degrees(GRID.polar) < 20.0
    radii = np.where(hole, np.nan, 80.0)
    polar, around = rim_angles(RadiusMap(GRID, outer=radii, inner=radii - 6, hole=hole))
    assert polar == pytest.approx(20.0, abs=1.0) and np.ptp(around) > 350


def test_head_and_map_are_drawn():
    bone, opening = ball(np.array([1.0, 0.0, 0.0]))
    grid = RayGrid(
        opening.head_centre, np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), np.radians(2.0), 55
    )
    hole = np.degrees(grid.polar) < 22.0
    radii = np.where(hole, np.nan, OUTER)
    drawn = plate_map(bone, RadiusMap(grid, outer=radii, inner=radii - 8, hole=hole))
    assert "15 degrees apart" in drawn.line and len(drawn.png) < 140_000
