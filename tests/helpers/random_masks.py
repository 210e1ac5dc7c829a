"""Masks of noise, and a grid that is not at right angles."""

import numpy as np

OBLIQUE = np.array([[0.1, -0.2, 0.9, 31.0], [0.3, 0.8, 0.1, -70.0], [1.9, -0.2, 0.1, 5.0], [0, 0, 0, 1.0]])
"""Unlike steps, slanting axes, an origin far away; left-handed, as (plane, row, col) in LPS is."""


def noise(shape=(9, 8, 7), seed=0):
    """A mask with true voxels at random, shape `shape`."""
    return np.random.default_rng(seed).random(shape) < 0.4
