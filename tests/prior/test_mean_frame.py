"""Directions that are even and symmetric."""

import numpy as np

from cranio_nb.prior.mean_frame import MeanFrame, even_directions, mirror_index


def test_the_sphere_is_symmetric_and_even():
    rays = even_directions(3)
    twins = mirror_index(rays)
    assert len(rays) == 642
    np.testing.assert_allclose(rays[twins], rays * [-1, 1, 1], atol=1e-12)
    np.testing.assert_array_equal(twins[twins], np.arange(len(rays)))
    np.testing.assert_allclose(rays.T @ rays / len(rays), np.eye(3) / 3, atol=0.01)


def test_a_frame_carries_points_and_stretches_directions():
    frame = MeanFrame(np.diag([2.0, 1.0, 3.0]), np.array([5.0, 6.0, 7.0]))
    np.testing.assert_array_equal(frame.to_world(np.array([[1.0, 1.0, 1.0]])), [[7, 7, 10]])
    np.testing.assert_allclose(frame.stretch(np.eye(3)), [2, 1, 3])
