"""Indices of arrays: nearest elements, boxes, axis orders, grids along the same axes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cranio_nb.grid import (
    AxisOrder,
    box_around,
    canonical_order,
    inside_grid,
    move_affine,
    nearest_values,
    touched,
    true_indices,
)
from cranio_nb.volume import Volume


@pytest.mark.parametrize("shape", [(5,), (4, 6), (3, 4, 5)])
def test_nearest_values_are_those_of_a_loop(shape):
    rng = np.random.default_rng(1)
    values, index = rng.integers(0, 99, shape), rng.uniform(-2, 8, (200, len(shape)))
    found = nearest_values(values, index, outside=-1)
    for one, value in zip(index, found, strict=True):
        at = tuple(int(i) for i in np.rint(one))
        inside = all(0 <= i < n for i, n in zip(at, shape, strict=True))
        assert value == (values[at] if inside else -1)
    np.testing.assert_array_equal(inside_grid(index, shape), found >= 0)


def test_a_border_takes_the_largest_of_those_that_share_it_and_the_type_stays():
    values = np.array([False, True, False, False, True])
    found = nearest_values(values, [[0.5], [1.5], [2.5], [-0.5], [4.5]], outside=False)
    assert found.dtype == bool and found.tolist() == [True, True, False, False, True]
    assert nearest_values(np.arange(4), [[0.5], [1.5], [3.5], [4.0]], outside=-1).tolist() == [1, 2, 3, -1]
    corner = np.zeros((2, 2, 2), bool)
    corner[1, 0, 1] = True
    assert nearest_values(corner, [0.5, 0.5, 0.5], outside=False)


@given(st.integers(0, 99), st.sampled_from((-1e-9, 1e-9)))
def test_rounding_moves_no_point_to_another_element(seed, rounding):
    rng = np.random.default_rng(seed)
    values, at = rng.random((5, 6, 7)) < 0.5, rng.integers(-2, 16, (50, 3)) / 2
    for seen in (lambda i: nearest_values(values, i, outside=False), lambda i: inside_grid(i, values.shape)):
        np.testing.assert_array_equal(seen(at + rounding * rng.random(at.shape)), seen(at))
    np.testing.assert_array_equal(touched(at + rounding, values.shape), touched(at, values.shape))


@given(st.integers(0, 99), st.integers(0, 2))
def test_reversed_elements_are_met_by_reversed_indices(seed, axis):
    rng = np.random.default_rng(seed)
    values, at = rng.random((5, 6, 7)) < 0.5, rng.integers(-2, 16, (50, 3)) / 2
    back = at.copy()
    back[:, axis] = values.shape[axis] - 1 - at[:, axis]
    here, there = (nearest_values(v, i, outside=False) for v, i in ((values, at), (np.flip(values, axis), back)))
    np.testing.assert_array_equal(here, there)


def test_a_box_holds_its_points_and_stays_in_the_grid():
    index = np.random.default_rng(2).uniform(-3, 12, (50, 3))
    box = box_around(index, (9, 9, 9), margin=1)
    inside = index[((index >= 0) & (index <= 8)).all(axis=1)]
    for side, low, high in zip(box, inside.min(axis=0), inside.max(axis=0), strict=True):
        assert 0 <= side.start <= low and high <= side.stop - 1 <= 8
    far = box_around([[100.0, 100, 100]], (9, 9, 9))
    assert [side.stop - side.start for side in far] == [1, 1, 1]


def test_another_grid_along_the_same_axes_is_where_its_start_and_step_say():
    affine = np.array([[0, 0.1, 0.5, 3], [0.2, 0.6, 0, -8], [2.5, 0, 0, 70], [0, 0, 0, 1]])
    coarse = Volume(np.zeros((2, 2, 2)), move_affine(affine, (0.5, 1.0, 1.5), (2, 3, 4)))
    fine = Volume(np.zeros((9, 9, 9)), affine)
    np.testing.assert_allclose(coarse.to_world([1, 1, 1]), fine.to_world([2.5, 4.0, 5.5]))


def test_the_canonical_order_of_a_canonical_grid_changes_nothing():
    assert canonical_order(np.diag([1.0, 1, 1, 1])[[2, 1, 0, 3]]) == AxisOrder((0, 1, 2), (False, False, False))


@pytest.mark.parametrize("shape", [(7,), (4, 6), (3, 4, 5), (0, 3)])
def test_true_indices_are_those_of_argwhere_in_memory_too(shape):
    mask = np.random.default_rng(3).random(shape) < 0.3
    for one in (mask, mask.T, mask[::-1]):
        found, wanted = true_indices(one), np.argwhere(one)
        np.testing.assert_array_equal(found, wanted)
        assert found.dtype == wanted.dtype and found.strides == wanted.strides  # sums run in the same order
