"""The gap of a block that touches another."""

import numpy as np
import pytest
from measured_shapes import block, oblique

from cranio_nb.errors import InputRefused
from cranio_nb.implant.clearance import with_clearance
from cranio_nb.volume import Volume


def test_clearance_leaves_the_gap_and_no_more_than_a_voxel():
    bone = Volume(block((0, 0, 0), (16, 40, 20)), oblique((2.5, 0.45, 0.6)))
    patch = bone.with_voxels(block((4, 8, 20), (6, 20, 15)))
    for gap, layers in ((0.25, 1), (0.6, 1), (0.61, 2), (1.3, 3)):
        kept = with_clearance(patch, bone, gap_mm=gap).voxels
        assert not (kept & ~patch.voxels).any()
        assert np.flatnonzero(kept.any(axis=(0, 1)))[0] == 20 + layers
    assert with_clearance(patch, bone.with_voxels(~bone.voxels & False), gap_mm=0.4).voxels.sum() == patch.voxels.sum()
    with pytest.raises(InputRefused):
        with_clearance(patch, bone, gap_mm=0)
