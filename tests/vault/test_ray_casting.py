"""Radii of a hollow ball along rays from its centre: planes near and far apart, scalp plates, breaks."""

import numpy as np
import pytest
from scipy import ndimage

from cranio_nb.vault.ray_casting import _cells, _is_bone, _sampled, expected_radius, surface_radii
from cranio_nb.vault.ray_grid import RayGrid
from cranio_nb.volume import Volume

CENTRE = np.array([12.0, -30.0, 400.0])
GRID = RayGrid(CENTRE, np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1]]), np.radians(2.0), 41)


def ball(spacing, *shells):
    """Bone between pairs of radii about the centre."""
    shape = tuple(int(2 * 100 / s) + 1 for s in spacing)
    affine = np.eye(4)
    affine[:3, :3] = np.eye(3)[:, ::-1] * spacing
    affine[:3, 3] = CENTRE - affine[:3, :3] @ ((np.array(shape) - 1) / 2)
    radius = np.linalg.norm(
        affine[:3, :3] @ (np.indices(shape).reshape(3, -1) - ((np.array(shape) - 1) / 2)[:, None]), axis=0
    )
    return Volume(np.any([(radius > a) & (radius < b) for a, b in shells], axis=0).reshape(shape), affine)


@pytest.mark.parametrize("spacing", [(1.0, 1.0, 1.0), (3.0, 1.0, 1.0)])
def test_radii_are_those_of_the_ball(spacing):
    outer, inner = surface_radii(ball(spacing, (70, 78)), CENTRE, GRID.directions, np.full((41, 41), 77.0))
    assert abs(np.median(outer) - 78) < 0.3 and abs(np.median(inner) - 70) < 0.3
    assert np.abs(outer - 78).max() < max(spacing) and np.abs(inner - 70).max() < max(spacing)


def test_the_run_nearest_to_the_expected_surface_is_taken_and_short_breaks_are_diploe():
    plate = ball((1.0, 1.0, 1.0), (66, 70.7), (72, 76), (84, 87))  # two tables with diploe, and a plate in the scalp
    outer, inner = surface_radii(plate, CENTRE, GRID.directions, np.full((41, 41), 77.0))
    assert np.abs(outer - 76).max() < 1 and np.abs(inner - 66).max() < 1


def test_a_ray_without_bone_has_no_radius():
    outer, inner = surface_radii(ball((2.0, 2.0, 2.0), (10, 12)), CENTRE, GRID.directions, np.full((41, 41), 77.0))
    assert np.isnan(outer).all() and np.isnan(inner).all()


def test_the_expected_radius_is_that_of_the_ball_and_outliers_do_not_bend_it():
    bone = ball((1.5, 1.5, 1.5), (70, 78))
    voxels = bone.voxels.copy()
    beside = bone.to_voxel(CENTRE + 85 * GRID.directions[20, 26]).astype(int)
    voxels[tuple(slice(i - 3, i + 4) for i in beside)] = True  # a loose plate above the bone
    nothing = np.zeros((41, 41), bool)
    found = expected_radius(
        bone.with_voxels(voxels), CENTRE, GRID.directions, typical=78.0, degrees=np.zeros((41, 41)), hidden=nothing
    )
    assert np.abs(found - 78).max() < 1.5


@pytest.mark.parametrize("kind", [np.uint8, np.float32])
def test_cells_tell_bone_as_interpolation_does(kind):
    rng = np.random.default_rng(4)
    field = ndimage.gaussian_filter(rng.normal(size=(9, 12, 7)), 1) * 4 + 0.5
    field = (field > 0.5).astype(kind) if kind == np.uint8 else field.astype(kind)
    at = rng.uniform(-2, 14, (3, 60, 40))
    at[:, :30] = np.rint(2 * at[:, :30]) / 2  # on voxels and midway between them
    np.testing.assert_array_equal(_is_bone(field, _cells(field), at), _sampled(field, at) > 0.5)
