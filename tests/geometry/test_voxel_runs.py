"""Runs against scipy's labels, and by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy import ndimage

from cranio_nb.geometry.voxel_pieces import SAME_SLICE
from cranio_nb.geometry.voxel_runs import find_pieces

MASKS = hnp.arrays(bool, hnp.array_shapes(min_dims=3, max_dims=3, min_side=1, max_side=7), elements=st.booleans())


@given(MASKS, st.booleans())
def test_pieces_are_those_of_scipy_in_the_same_order(mask, in_slices):
    labels, n = ndimage.label(mask, SAME_SLICE if in_slices else None)
    runs = find_pieces(mask, in_slices=in_slices)
    assert runs.n_pieces == n
    np.testing.assert_array_equal(runs.sizes, np.bincount(labels.ravel(), minlength=n + 1)[1:])
    boxes = [[[side.start for side in box], [side.stop for side in box]] for box in ndimage.find_objects(labels)]
    np.testing.assert_array_equal(runs.boxes, np.array(boxes, int).reshape(n, 2, 3))
    for piece in range(n):
        wanted = np.arange(n) == piece
        np.testing.assert_array_equal(runs.places(wanted), np.flatnonzero(labels == piece + 1))


@given(MASKS)
def test_runs_are_the_mask_and_leave_it_as_it_was(mask):
    before = mask.copy()
    runs = find_pieces(mask)
    again = np.zeros_like(mask)
    again.ravel()[runs.places(np.ones(runs.n_pieces, bool))] = True
    np.testing.assert_array_equal(again, before)
    np.testing.assert_array_equal(mask, before)
    # runs are as long as they can be: before and after each is nothing of its row
    for (plane, row, col), length in zip(runs.first, runs.length, strict=True):
        assert col == 0 or not mask[plane, row, col - 1]
        assert col + length == mask.shape[2] or not mask[plane, row, col + length]


@pytest.mark.parametrize("mask", [np.zeros((3, 4, 5), bool), np.zeros((0, 4, 5), bool)])
def test_nothing_has_no_pieces(mask):
    runs = find_pieces(mask)
    assert runs.n_pieces == 0 and runs.sizes.shape == (0,) and runs.boxes.shape == (0, 2, 3)
    assert len(runs.places(np.zeros(0, bool))) == 0


def test_the_end_of_a_row_and_of_a_slice_join_nothing():
    rows = np.array([[[0, 0, 1], [1, 0, 0]]], bool)
    assert find_pieces(rows).n_pieces == 2
    slices = np.array([[[0, 0], [1, 1]], [[1, 1], [0, 0]]], bool)
    assert find_pieces(slices).n_pieces == 2
