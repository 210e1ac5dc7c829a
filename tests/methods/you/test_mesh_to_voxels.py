"""From a mesh back to voxels: what marching tetrahedra made of a mask is that mask again."""

import numpy as np
import pytest
from random_masks import OBLIQUE, noise

from cranio_nb.mesh import Mesh
from cranio_nb.methods.you import mesh_to_voxels, tetrahedra
from cranio_nb.volume import Volume


@pytest.mark.parametrize("affine", [np.eye(4), OBLIQUE])
def test_the_voxels_inside_the_surface_of_a_mask_are_the_mask(affine):
    mask = Volume(noise(), affine)
    np.testing.assert_array_equal(mesh_to_voxels.fill_mesh(tetrahedra.extract(mask), mask), mask.voxels)


def test_a_mesh_beyond_the_grid_fills_what_of_it_is_on_the_grid():
    mask = Volume(np.ones((9, 9, 9), bool), np.eye(4))
    small = mask.crop(np.s_[2:5, 3:6, 4:9])
    assert mesh_to_voxels.fill_mesh(tetrahedra.extract(mask), small).all()
    there = small.affine.copy()
    there[0, 3] += 40
    away = Volume(small.voxels, there)
    assert not mesh_to_voxels.fill_mesh(tetrahedra.extract(mask), away).any()


def test_overlapping_parts_count_once():
    a = tetrahedra.extract(Volume(np.ones((4, 4, 4), bool), np.eye(4)))
    both = Mesh(np.concatenate([a.vertices, a.vertices + 0.3]), np.concatenate([a.faces, a.faces + len(a.vertices)]))
    grid = Volume(np.zeros((6, 6, 6), bool), np.eye(4))
    filled = mesh_to_voxels.fill_mesh(both, grid)
    assert (filled >= mesh_to_voxels.fill_mesh(a, grid)).all() and filled[1:3, 1:3, 1:3].all()
