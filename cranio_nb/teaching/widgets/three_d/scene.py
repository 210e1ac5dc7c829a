"""What both panels of lesson 09 show a surface against: the vault around a hole, and the bone missing in it.

Frame: radius map (v, u) with radii in mm, on every third or fourth ray only, so that a picture follows the hand.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ....methods import thin_plate
from ....prosthesis import Prosthesis
from ....vault import radius_measurement
from ....vault.ray_grid import RadiusMap
from ....volume import Volume

_ANY = 1e-9  # a mean above this has something in it; sums of zeros may be a little off

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Scene:
    """What both panels show.

    Parameters
    ----------
    radius_map : RadiusMap
        Of every third or fourth ray.
    true : ndarray, shape (M, M)
        Radii of the outer surface with the missing bone in its place, mm; nan where none is known.
    mirrored : ndarray, shape (M, M), or None
        Outer radii of the other side of the skull.
    """

    radius_map: RadiusMap
    true: Array
    mirrored: Array | None = None


def thin_rays(radius_map: RadiusMap, every: int) -> RadiusMap:
    """Keep every n-th ray of a radius map, counted from its middle; radii become means of their neighbours.

    Parameters
    ----------
    radius_map : RadiusMap
        N x N rays.
    every : int

    Returns
    -------
    RadiusMap
        Its hole holds the hole of the finer map.
    """
    shown = [np.where(radius_map.hole, np.nan, radius) for radius in (radius_map.outer, radius_map.inner)]
    outer, inner = (thin_plate.thin_map(radius, every) for radius in shown)
    hole = thin_plate.thin_map(radius_map.hole.astype(float), every) > _ANY
    grid = replace(radius_map.grid, step_rad=radius_map.grid.step_rad * every, n=len(outer))
    return replace(radius_map, grid=grid, outer=outer, inner=inner, hole=hole)


def make_scene(fine: RadiusMap, bone: Volume, truth: Prosthesis | None, every: int) -> Scene:
    """The vault around a hole and, where it is known, the bone that is missing in it.

    Parameters
    ----------
    fine : RadiusMap
        Radius map of the hole.
    bone : Volume
        Bool mask of the skull.
    truth : Prosthesis or None
        The missing bone with its patch.
    every : int
        Every how many rays are kept.

    Returns
    -------
    Scene
    """
    radius_map = thin_rays(fine, every)
    if truth is None or truth.patch is None:
        return Scene(radius_map, np.where(radius_map.hole, np.nan, radius_map.outer))
    whole = radius_measurement.measure_along(fine, bone.with_voxels(bone.voxels | truth.patch.voxels))
    return Scene(radius_map, thin_plate.thin_map(whole.outer, every))


def error_line(off: Array) -> str:
    """Mean with its sign, root mean square and maximum of errors of a radius, in words.

    Parameters
    ----------
    off : ndarray, any shape
        mm, outward positive; what is not finite is left out.

    Returns
    -------
    str

    Examples
    --------
    >>> error_line(np.array([-1.0, -2.0, np.nan]))
    '1.50 mm too deep on average, rms 1.58 mm, 2.00 mm at most'
    """
    off = off[np.isfinite(off)]
    mean = f"{abs(off.mean()):.2f} mm too {'high' if off.mean() > 0 else 'deep'} on average"
    return f"{mean}, rms {np.sqrt((off**2).mean()):.2f} mm, {np.abs(off).max():.2f} mm at most"
