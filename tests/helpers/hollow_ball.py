"""A hollow ball with a conical hole, whose missing part is known in closed form."""

import numpy as np

from cranio_nb.opening import Opening
from cranio_nb.volume import Volume

INNER, OUTER, HALF_DEG = 72.0, 80.0, 22.0
"""Radii in mm, and half the hole's opening angle."""
CENTRE = np.array([-104.0, 33.0, -812.0])
STEP = 1.5
"""Size of a voxel, mm."""


def ball(towards):
    """A hollow ball about `CENTRE` with a conical hole, and its opening."""
    reach = OUTER + 6
    n = int(2 * reach / STEP)
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = np.eye(3)[:, ::-1] * STEP, CENTRE - reach
    away = np.moveaxis(np.indices((n, n, n)), 0, -1) @ affine[:3, :3].T - reach
    radius = np.linalg.norm(away, axis=-1)
    cosine = away @ (towards / np.linalg.norm(towards)) / np.maximum(radius, 1e-9)
    hole = cosine > np.cos(np.radians(HALF_DEG))
    bone = (radius >= INNER) & (radius <= OUTER) & ~hole
    sheet = (radius >= OUTER - 4) & (radius <= OUTER) & hole
    return Volume(bone, affine), Opening(Volume(sheet, affine), CENTRE)
