"""Voxels between two spheres, and plates that are too thin."""

import numpy as np
import pytest

from cranio_nb.vault.radius_voxels import thickened, voxels_between
from cranio_nb.vault.ray_grid import RadiusMap, RayGrid
from cranio_nb.volume import Volume

N, CENTRE = 121, np.array([0.0, 0.0, 0.0])
GRID = RayGrid(CENTRE, np.eye(3), np.radians(0.5), N)
HOLE = GRID.polar < np.radians(15)


@pytest.fixture(scope="module")
def radius_map():
    outer = np.where(HOLE, np.nan, 80.0)
    return RadiusMap(GRID, outer=outer, inner=outer - 8, hole=HOLE)


def test_the_cap_between_two_spheres_has_its_volume(radius_map):
    step = 1.0
    affine = np.array([[0, 0, step, -40], [0, step, 0, -40], [step, 0, 0, 60], [0, 0, 0, 1.0]])
    empty = Volume(np.zeros((30, 81, 81), bool), affine)
    outer, inner = (np.where(HOLE, radius, np.nan) for radius in (80.0, 72.0))
    patch = voxels_between(radius_map, empty, outer=outer, inner=inner)
    wanted = 2 * np.pi / 3 * (80**3 - 72**3) * (1 - np.cos(np.radians(15)))
    assert patch.sum() * step**3 == pytest.approx(wanted, rel=0.15)  # and up to a millimetre of rim
    radius = np.linalg.norm(empty.to_world(np.argwhere(patch)), axis=1)
    assert radius.min() >= 72 and radius.max() <= 80
    bone = empty.with_voxels(np.indices(empty.shape)[1] < 40)
    assert not (voxels_between(radius_map, bone, outer=outer, inner=inner) & bone.voxels).any()


def test_a_thin_plate_is_thickened_about_its_middle_and_a_thick_one_left(radius_map):
    outer, inner = (np.where(HOLE, radius, np.nan) for radius in (80.0, 77.0))
    thick, thin = thickened(radius_map, outer=outer, inner=inner)
    np.testing.assert_allclose((thick - thin)[HOLE], 8)
    np.testing.assert_allclose((thick + thin)[HOLE], 157)
    same = thickened(radius_map, outer=outer, inner=inner - 9)
    np.testing.assert_array_equal(same[0], outer)
