"""Skulls laid on the mean head: moved, stretched, with holes."""

import numpy as np

from cranio_nb.prior import alignment
from cranio_nb.prior.alignment import align
from cranio_nb.prior.skull_points import sample_surface
from cranio_nb.vault.orientation import head_axes


def test_a_moved_and_stretched_skull_is_laid_back(intact):
    points = sample_surface(intact(1), head_axes(intact(1)))
    turn = alignment._rotation(np.array([0.15, 0.03, -0.04]))
    matrix, shift = 1.08 * turn @ np.diag([0.97, 1.0, 1.03]), np.array([3.0, -4.0, 5.0])
    frame = align(points.moved(matrix, shift), points)
    back = points.axes.T @ frame.matrix
    np.testing.assert_allclose(back, matrix, atol=5e-3)
    np.testing.assert_allclose(points.axes.T @ (frame.origin - points.centre), shift, atol=0.3)


def test_a_hole_hardly_moves_a_skull(intact, skull, learned):
    whole, open_ = (
        align(sample_surface(bone, head_axes(bone)), learned.mean) for bone in (intact(0), skull("large", 0))
    )
    other = align(sample_surface(intact(0), head_axes(intact(0))), learned.mean)
    np.testing.assert_array_equal(other.matrix, whole.matrix)
    assert np.linalg.norm(open_.origin - whole.origin) < 2.0
    np.testing.assert_allclose(open_.matrix, whole.matrix, atol=0.04)
