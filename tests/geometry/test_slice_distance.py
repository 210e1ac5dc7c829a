"""Signed distances in planes, against every pair of pixels."""

import numpy as np
from scipy.spatial.distance import cdist

from cranio_nb.geometry.slice_distance import plane_distances


def test_distances_are_those_to_the_nearest_pixel_of_the_other_kind():
    mask = np.random.default_rng(0).random((3, 12, 15)) < 0.3
    found = plane_distances(mask, bound_px=100.0)
    for plane, signed in zip(mask, found, strict=True):
        inside, outside = np.argwhere(plane), np.argwhere(~plane)
        apart = cdist(inside, outside)
        np.testing.assert_allclose(signed[plane], apart.min(axis=1))
        np.testing.assert_allclose(signed[~plane], -apart.min(axis=0))


def test_planes_do_not_know_each_other_and_distances_are_bounded():
    mask = np.zeros((3, 30, 4), bool)
    mask[1, :20], mask[2] = True, True
    found = plane_distances(mask, bound_px=5.0)
    assert (found[0] == -5).all() and (found[2] == 5).all()
    np.testing.assert_array_equal(found[1, :, 0], np.clip(np.where(np.arange(30) < 20, 20, 19) - np.arange(30), -5, 5))
