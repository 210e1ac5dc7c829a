"""A cap of a spherical shell with the shell it was cut from: a prosthesis whose surface and sides are known."""

import numpy as np

from cranio_nb.volume import Volume

RADIUS, THICKNESS, HALF_ANGLE = 60.0, 6.0, 30.0
CENTRE = np.array([12.0, -30.0, 807.0])


def spherical_cap(spacing, half_angle=HALF_ANGLE, thickness=THICKNESS, towards=(0.3, -0.8, 0.6)):
    """A cap of a spherical shell, and the rest of the shell as bone, both around CENTRE."""
    spacing = np.asarray(spacing, float)
    shape = np.ceil(2 * (RADIUS + 4) / spacing).astype(int)
    affine = np.zeros((4, 4))
    affine[[2, 1, 0], [0, 1, 2]] = spacing
    affine[:3, 3] = CENTRE - affine[:3, :3] @ ((shape - 1) / 2) + (0.13, 0.07, 0.21)
    affine[3, 3] = 1
    grid = Volume(np.zeros(shape, bool), affine)
    offset = grid.to_world(np.stack(np.indices(shape), axis=-1)) - CENTRE
    radius = np.linalg.norm(offset, axis=-1)
    towards = np.asarray(towards) / np.linalg.norm(towards)
    angle = np.degrees(np.arccos(np.clip(offset @ towards / radius.clip(1e-9), -1, 1)))
    shell = (radius <= RADIUS) & (radius > RADIUS - thickness)
    hole = angle < half_angle
    return grid.with_voxels(shell & hole), grid.with_voxels(shell & ~hole), towards
