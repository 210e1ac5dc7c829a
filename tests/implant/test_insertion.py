"""Walls that lean over by known angles, and bone over a patch."""

import numpy as np
import pytest
from measured_shapes import block

from cranio_nb.implant.insertion import find_part_to_trim, undercut_share
from cranio_nb.mesh import Mesh
from cranio_nb.volume import Volume


@pytest.mark.parametrize("lean, share", [(0.0, 0.0), (20.0, 0.0), (-20.0, 1.0), (-3.0, 0.0)])
def test_undercut_is_the_share_of_walls_that_lean_over(lean, share):
    around = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    ring = np.stack([np.cos(around), np.sin(around)], axis=1)
    top, bottom = 20.0, 20 - 5 * np.tan(np.deg2rad(lean))  # lean > 0: narrower below
    vertices = np.vstack([np.c_[top * ring, np.full(60, 5.0)], np.c_[bottom * ring, np.zeros(60)]])
    i, j = np.arange(60), (np.arange(60) + 1) % 60
    rim = Mesh(vertices, np.vstack([np.stack([i, i + 60, j], 1), np.stack([j, i + 60, j + 60], 1)]))
    assert np.einsum("fd,fd->f", rim.normals, rim.centres * [1, 1, 0]).min() > 0
    assert undercut_share(rim, np.array([0, 0, 2.0])) == pytest.approx(share)


def test_only_what_lies_under_bone_must_be_trimmed():
    bone = Volume(block((8, 0, 0), (6, 40, 15)), np.diag([1, 1, 1, 1]))
    patch = bone.with_voxels(block((2, 5, 5), (6, 30, 30)))  # lies below, its columns 5 to 14 under the bone
    up = np.array([1.0, 0, 0])
    caught = find_part_to_trim(patch, bone, up).voxels
    assert caught.any() and not (caught & ~patch.voxels).any()
    assert np.flatnonzero(caught.any(axis=(0, 1))).tolist() == list(range(5, 14))
    assert not find_part_to_trim(patch, bone, -up).voxels.any()
