"""Pieces: nothing shared between two of them, and a design is their union off the bone."""

from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from cranio_nb.methods.design import assemble
from cranio_nb.methods.piece import Piece
from cranio_nb.opening import Opening
from cranio_nb.volume import Volume

GRID = Volume(np.zeros((12, 14, 16), bool), np.diag([2.0, 1.0, 1.0, 1.0]))


def block(*slices):
    voxels = np.zeros(GRID.shape, bool)
    voxels[slices] = True
    return voxels


def test_pieces_share_no_record_and_stay_as_they_are():
    one, other = Piece(GRID.voxels), Piece(GRID.voxels)
    one.record["n"] = 1
    assert other.record == {} and other.working == ()
    with pytest.raises(FrozenInstanceError):
        one.voxels = GRID.voxels


def test_a_design_is_the_union_of_its_pieces_without_bone():
    left, right = block(slice(3, 8), slice(2, 6), slice(2, 6)), block(slice(3, 8), slice(8, 12), slice(9, 14))
    bone = GRID.with_voxels(block(slice(3, 4)))
    openings = [Opening(GRID.with_voxels(voxels), np.array([-20.0, 7.0, 8.0])) for voxels in (left, right)]
    pieces = [Piece(left, ("a",), {"parts": [{"n": 1}]}), Piece(right, ("b", "c"), {"parts": [{"n": 2}, {"n": 3}]})]
    made = assemble(bone, openings, iter(pieces), method="blocks", parameters={"smooth": False})
    np.testing.assert_array_equal(made.patch.voxels, (left | right) & ~bone.voxels)
    assert made.working == ("a", "b", "c")
    assert [(part["opening"], part["n"]) for part in made.record["parts"]] == [(0, 1), (1, 2), (1, 3)]
