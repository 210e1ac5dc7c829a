"""A shape prior and a skull with a hole -> the vault most likely around the hole.

Frames: mean head (see `mean_frame`), radii in mm of it; maps (v, u) of rays (see `vault.ray_grid`) with radii in
mm of the skull; world mm (LPS).
"""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CloughTocher2DInterpolator

from ..errors import InputRefused
from ..vault.head_frame import head_or_grid_axes
from ..vault.ray_grid import RadiusMap, RayGrid
from ..volume import Volume
from .alignment import align
from .mean_frame import MeanFrame
from .shape_prior import Prior, conditional_mean
from .skull_points import sample_surface
from .vault_radii import (
    VAULT_DEG,
    local_median,
    measure_vault,
    rays_near,
    rays_without_bone,
    vault_rays,
    without_outliers,
)

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_RIM_MM, _FREE_RIM_MM = 4.0, 6.0  # of bone beside a measured hole, and beside any other, that are not trusted
_MISFIT_MM = 3.5  # far more than any adult skull showed
_BEYOND_RAD = 0.2  # beside the map up to which rays are predicted


@dataclass(frozen=True, eq=False)
class Prediction:
    """What a prior predicts around an opening.

    Parameters
    ----------
    outer, inner : ndarray, shape (M, M)
        Conditional mean of the radii along the rays of the map, mm; nan where the prior does not reach.
    frame : MeanFrame
        How the skull was laid on the mean head.
    """

    _: KW_ONLY
    outer: Array
    inner: Array
    frame: MeanFrame


def predict_around(prior: Prior, bone: Volume, radius_map: RadiusMap, axes: Array | None = None) -> Prediction:
    """The most likely vault around an opening, given the bone that is there.

    Parameters
    ----------
    prior : Prior
    bone : Volume
        Bool mask of the skull with the hole; all of it informs, not only what the map shows.
    radius_map : RadiusMap
        Of the opening.
    axes : ndarray, shape (3, 3), optional
        `Opening.head_axes`; found in the bone when not given.

    Returns
    -------
    Prediction

    Raises
    ------
    InputRefused
        ``PriorDoesNotFit`` when the skull does not lie on the mean head; ``NoVault``.
    """
    # rays of different skulls can be compared only in the frame of the mean head
    axes = head_or_grid_axes(bone) if axes is None else axes
    frame = align(sample_surface(bone, axes), prior.mean)
    if frame.misfit_mm > _MISFIT_MM:
        message = f"The skull lies {frame.misfit_mm:.1f} mm off the prior's mean head; {_MISFIT_MM:g} mm is the most."
        raise InputRefused("PriorDoesNotFit", message, "Design without the prior, or learn one from such skulls.")
    # what the skull shows, without its holes and their rims
    middle = prior.samples.mean(axis=0)
    radii = measure_vault(bone, frame, middle[0])
    usual = middle + local_median(radii - middle)
    hole = _rays_through(radius_map, frame, middle)
    rims = rays_near(hole, _RIM_MM) | rays_near(rays_without_bone(radii) & ~hole, _FREE_RIM_MM)
    known = np.where(rims, np.nan, without_outliers(radii, usual))
    # what follows from it, on the rays of the map
    wanted = _rays_beside(radius_map.grid, frame)
    points = frame.to_world(vault_rays()[wanted] * conditional_mean(prior, known, wanted)[..., None])
    outer, inner = (_radius_on(radius_map.grid, frame, side) for side in points)
    return Prediction(outer=outer, inner=inner, frame=frame)


def _rays_beside(grid: RayGrid, frame: MeanFrame) -> Mask:
    """Which of the `vault_rays` lie on a map or a little beside it, shape (m,)."""
    # the map reaches to half its width; a ray counts by its angle with the map's middle
    directions = vault_rays() @ frame.matrix.T
    reach = min(grid.n / 2 * grid.step_rad + _BEYOND_RAD, np.pi)
    wanted: Mask = directions @ grid.axes[2] > np.cos(reach) * np.linalg.norm(directions, axis=1)
    return wanted


def _rays_through(radius_map: RadiusMap, frame: MeanFrame, middle: Array) -> Mask:
    """Which rays pass through the map's hole, on the outer or the inner side of the mean vault (2, m)."""
    through = np.zeros(len(vault_rays()), bool)
    for radius in middle:
        # where the mean vault lies on each ray, and whether the map misses bone in that direction
        away = frame.to_world(vault_rays() * radius[:, None]) - radius_map.grid.centre
        through |= radius_map.grid.at(radius_map.hole, away, outside=False)
    return through


def _radius_on(grid: RayGrid, frame: MeanFrame, points: Array) -> Array:
    """Radius of a surface given by points (k, 3), world, along the rays of a map, shape (M, M), mm."""
    away = points - grid.centre
    # scattered points of the surface -> the map's own rays, by a C1 interpolation over triangles
    index = np.indices((grid.n, grid.n)).reshape(2, -1).T
    values = CloughTocher2DInterpolator(grid.locate(away).T, np.linalg.norm(away, axis=1))(index)
    radius = values.reshape(grid.n, grid.n)
    # what lies below the vault in the mean frame was never learned
    in_head = (grid.points(radius) - frame.origin) @ np.linalg.inv(frame.matrix).T
    with np.errstate(invalid="ignore"):
        below = in_head[..., 2] < np.cos(np.radians(VAULT_DEG)) * np.linalg.norm(in_head, axis=-1)
    return np.where(below, np.nan, radius)
