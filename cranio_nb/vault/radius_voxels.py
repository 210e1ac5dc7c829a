"""A prosthesis as a pair of radii per ray -> voxels on the bone's grid.

Frames: map (v, u), see `ray_grid`; radii in mm; voxel (plane, row, col).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..geometry.side_by_side import side_by_side
from ..grid import box_around, nearest_values
from ..volume import Volume
from .ray_grid import RadiusMap, filled_from_nearest

_FILM_MM = 0.75  # on the bone beside a hole that nobody would build
_MEDIAN, _OPENED = 5, 2  # rays: a step that is narrower is noise
_NEAR_MM = 20.0  # of bone beside a hole that gives the thickness of sound bone


def voxels_between(
    radius_map: RadiusMap, bone: Volume, *, outer: NDArray[np.float64], inner: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Voxels between two surfaces inside a hole, off the bone.

    Parameters
    ----------
    radius_map : RadiusMap
        The vault around the hole.
    bone : Volume
        Bool mask; the result is on its grid.
    outer, inner : ndarray, shape (M, M)
        Radii of the prosthesis, mm; nan outside it.

    Returns
    -------
    ndarray of bool, shape (P, R, C)
    """
    filled = np.isfinite(outer) & np.isfinite(inner)
    region = ndimage.binary_dilation(filled & radius_map.hole, iterations=max(1, round(1.0 / radius_map.step_mm)))
    top, bottom = (filled_from_nearest(np.where(filled, radius, np.nan)) for radius in (outer, inner))
    # what reaches over the rim ends with the bone's own surface: no flap and no film lies on the bone
    outside = ~radius_map.hole | _is_level(top - radius_map.outer, radius_map.hole)
    inside = ~radius_map.hole | _is_level(radius_map.inner - bottom, radius_map.hole)
    top[outside] = np.fmin(top, radius_map.outer)[outside]
    bottom[inside] = np.fmax(bottom, radius_map.inner)[inside]
    # only a box around the prosthesis is filled
    directions = radius_map.grid.directions[region]
    ends = np.concatenate([radius_map.grid.centre + directions * r[region][:, None] for r in (top, bottom)])
    box = box_around(bone.to_voxel(ends), bone.shape, margin=1)
    patch = np.zeros(bone.shape, bool)
    patch[box] = _between(radius_map, region, bone.crop(box), outer=top, inner=bottom) & ~bone.voxels[box]
    return patch


def thickened(
    radius_map: RadiusMap, *, outer: NDArray[np.float64], inner: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Surfaces moved apart about their middle where they lie closer than sound bone near the hole ever does.

    Parameters
    ----------
    radius_map : RadiusMap
        The vault around the hole.
    outer, inner : ndarray, shape (M, M)
        Radii of the prosthesis, mm; nan outside it.

    Returns
    -------
    outer, inner : ndarray, shape (M, M)
        mm, at least as far apart as the thinnest tenth of the bone within 20 mm of the hole.
    """
    away = ndimage.distance_transform_edt(~radius_map.hole) * radius_map.step_mm
    near = (away > 0) & (away <= _NEAR_MM)
    least = float(np.nanquantile((radius_map.outer - radius_map.inner)[near], 0.1))
    short = np.maximum(least - (outer - inner), 0.0) / 2
    return outer + short, inner - short


def _is_level(step: NDArray[np.float64], hole: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Where, in a hole, a prosthesis rises so little above the bone that this bone is whole, shape (M, M).

    A thinned rim is a real step down. Beside the hole nothing is said: False.
    """
    # what lies further from the hole than both filters reach does not count
    margin = _MEDIAN // 2 + 2 * _OPENED
    sides = ndimage.find_objects(hole.astype(np.uint8))[0]
    box = tuple(slice(max(side.start - margin, 0), side.stop + margin) for side in sides)
    level = np.zeros(step.shape, bool)
    rise = ndimage.median_filter(np.nan_to_num(step[box], nan=np.inf), _MEDIAN) >= _FILM_MM
    level[box] = ~ndimage.binary_opening(rise, iterations=_OPENED)
    return level & hole


def _between(
    radius_map: RadiusMap, region: NDArray[np.bool_], box: Volume, *, outer: NDArray, inner: NDArray
) -> NDArray[np.bool_]:
    """Voxels of a box whose direction lies in the region and whose radius lies between the two surfaces."""
    filled = np.zeros(box.shape, bool)
    plane_index = np.stack(np.meshgrid(*[np.arange(n, dtype=float) for n in box.shape[1:]], indexing="ij"), axis=-1)

    def fill(plane: int) -> None:
        """Fill one plane."""
        away = box.to_world(np.insert(plane_index, 0, plane, axis=-1)) - radius_map.grid.centre
        at = radius_map.grid.locate(away)
        within = nearest_values(region, np.moveaxis(at, 0, -1), outside=False)
        # both surfaces between the rays
        top, bottom = (ndimage.map_coordinates(r, at[:, within], order=1, mode="nearest") for r in (outer, inner))
        radius = np.linalg.norm(away[within], axis=-1)
        filled[plane][within] = (radius <= top) & (radius >= bottom)

    side_by_side(fill, range(box.shape[0]))
    return filled
