"""Indices of arrays: nearest elements, boxes, axis orders, grids along the same axes."""

import numpy as np
import pytest

from cranio_nb.grid import AxisOrder, box_around, canonical_order, inside_grid, move_affine, nearest_values
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


def test_a_half_goes_to_the_even_element_and_the_type_stays():
    values = np.array([False, True, False, True])
    found = nearest_values(values, [[0.5], [1.5], [2.5], [-0.5], [3.5]], outside=False)
    assert found.dtype == bool and found.tolist() == [False, False, False, False, False]
    assert nearest_values(np.arange(4), [[0.5], [1.5], [2.5]], outside=9).tolist() == [0, 2, 2]


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
