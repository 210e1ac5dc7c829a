"""The coarse surface lies where the bone is, whatever the slices' distance."""

import numpy as np
import pytest

from cranio_nb.drawing import coarse_skull
from cranio_nb.volume import Volume


def shell(spacing: tuple[float, float, float]) -> Volume:
    """A hollow ball of radii 40 and 34 mm about the world's origin."""
    shape = [int(100 / s) for s in spacing]
    affine = np.eye(4)
    affine[:3, :3] = np.array([[0, 0, spacing[2]], [0, spacing[1], 0], [spacing[0], 0, 0]])
    affine[:3, 3] = [-50.0, -50.0, -50.0]
    grid = Volume(np.zeros(shape, bool), affine)
    radius = np.linalg.norm(grid.to_world(np.moveaxis(np.indices(shape), 0, -1)), axis=-1)
    return grid.with_voxels((radius < 40) & (radius > 34))


@pytest.mark.parametrize("spacing", [(1.0, 0.5, 0.5), (2.5, 0.5, 0.5), (3.0, 1.75, 1.75)])
def test_coarse_skull_stays_where_it_is(spacing):
    mesh = coarse_skull.skull_surface(shell(spacing))
    radius = np.linalg.norm(mesh.vertices, axis=1)
    outer = radius[radius > 37]
    away = np.abs(mesh.vertices[radius > 37][:, 2]) < 30
    assert np.abs(outer[away] - 40).mean() < 0.7 and mesh.volume > 0
    cut = coarse_skull.skull_surface(shell(spacing), floor_mm=5.0)
    assert cut.vertices[:, 2].min() > 5.0 - spacing[0]
    assert len(coarse_skull.skull_surface(shell(spacing), floor_mm=500.0).faces) == 0
