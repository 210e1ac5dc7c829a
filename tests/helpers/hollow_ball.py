"""A hollow ball with a hole, whose missing part is known in closed form."""

import numpy as np

from cranio_nb.opening import Opening
from cranio_nb.volume import Volume

INNER, OUTER, HALF_DEG = 72.0, 80.0, 22.0
"""Radii in mm, and half the hole's opening angle."""
CENTRE = np.array([-104.0, 33.0, -812.0])
STEP = 1.5
"""Size of a voxel, mm."""


def ball(towards, half_deg=HALF_DEG, room_mm=6.0):
    """A hollow ball about `CENTRE` with a conical hole, and its opening; so much room beside it in the image."""
    reach = OUTER + room_mm
    n = int(2 * reach / STEP)
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = np.eye(3)[:, ::-1] * STEP, CENTRE - reach
    radius, hole = radius_and_cone(Volume(np.zeros((n, n, n), bool), affine), towards, half_deg)
    bone = (radius >= INNER) & (radius <= OUTER) & ~hole
    sheet = (radius >= OUTER - 4) & (radius <= OUTER) & hole
    return Volume(bone, affine), Opening(Volume(sheet, affine), CENTRE)


def radius_and_cone(volume, towards, half_deg):
    """Of each voxel its distance from `CENTRE`, mm, and whether it lies in a cone from there."""
    away = volume.to_world(np.moveaxis(np.indices(volume.shape), 0, -1)) - CENTRE
    radius = np.linalg.norm(away, axis=-1)
    cosine = away @ (towards / np.linalg.norm(towards)) / np.maximum(radius, 1e-9)
    return radius, cosine > np.cos(np.radians(half_deg))


def pierced(diameter_mm, slice_mm, *, at_top=False):
    """A hollow ball about 0 with a wall of 69 to 75 mm and a round hole of one width at its side, or at its top."""
    axes = (np.arange(-84.0, 84.1, step) for step in (slice_mm, STEP, STEP))
    z, y, x = np.meshgrid(*axes, indexing="ij", sparse=True)
    away = np.sqrt(x**2 + y**2 + z**2)
    along, across = (z, x) if at_top else (x, z)
    hole = (np.hypot(y, across) <= diameter_mm / 2) & (along > 0)
    affine = np.array([[0, 0, STEP, 0], [0, STEP, 0, 0], [slice_mm, 0, 0, 0], [0, 0, 0, 1.0]])
    return Volume((away <= 75) & (away >= 69) & ~hole, affine)
