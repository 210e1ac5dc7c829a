"""One opening in fans of planes that cross it in several directions: the patch between the means of their curves.

Frame: slice (row, col) in mm about the head's centre.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ...curves import GapEnds
from ...opening import Opening
from ...vault import radius_measurement, radius_voxels, slicing
from ...vault.rims import RayProfile, fit_rims, share_tangents
from ...volume import Volume
from . import inflate
from .slices import Settings, SlicedDesign, SliceResult

_TANGENT_ERROR, _TURN_ERROR = 0.05, 0.3  # radians of tangent error on sound bone, and per radian its rim bends
_POINT_ERROR = 0.1  # mm: what a curve is off at its own ends


def bridge(
    bone: Volume,
    opening: Opening,
    *,
    directions: int,
    skip_mm: float,
    reach_mm: float,
    coupling_mm: float,
    settings: Settings,
) -> tuple[tuple[SlicedDesign, ...], NDArray[np.bool_]]:
    """Slices of one opening in several directions, and the patch between the means of their curves.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    opening : Opening
    directions : int
        Fans, evenly turned.
    skip_mm, reach_mm, coupling_mm : float
        As for `by_rays`.
    settings : Settings
        In mm.

    Returns
    -------
    made : tuple of SlicedDesign
        One for each direction.
    voxels : ndarray of bool, shape (P, R, C)
    """
    radius_map = radius_measurement.measure_around(bone, opening)
    fans = slicing.make_fans(radius_map, directions)
    profiles = [slicing.read_profile(radius_map, fan) for fan in fans]
    ends = [by_rays(p, skip_mm=skip_mm, reach_mm=reach_mm, coupling_mm=coupling_mm) for p in profiles]
    # the balloons of all fans move together: a step costs little more for all than for one fan
    relaxed = iter(inflate.inflate([one for slices in ends for one in slices], np.zeros(2), settings))
    into_hole = radius_map.grid.directions[radius_map.hole]
    made, radii, weights = [], [], []
    for fan, profile, slices in zip(fans, profiles, ends, strict=True):
        results = inflate.carry(list(islice(relaxed, len(slices))))
        made.append(SlicedDesign(opening, fan.frames(radius_map.grid.centre), 1.0, results))
        at = fan.locate(into_hole)
        # all directions are compared on the same rays, those of the radius map into the hole
        both = [_on_rays(results, boundary, profile) for boundary in (0, 1)]
        radii.append([ndimage.map_coordinates(r, at, order=1, cval=np.nan) for r, _ in both])
        weights.append([ndimage.map_coordinates(w, at, order=1, cval=0.0) for _, w in both])
    # the mean of all directions, by their certainty
    outer, inner = np.full((2, *radius_map.hole.shape), np.nan)
    outer[radius_map.hole], inner[radius_map.hole] = _weighted_mean(np.array(radii), np.array(weights))
    if not np.isfinite(outer).any():
        return tuple(made), np.zeros(bone.shape, bool)
    # the two means are independent: where they come too close they are moved apart
    outer, inner = radius_voxels.thickened(radius_map, outer=outer, inner=inner)
    return tuple(made), radius_voxels.voxels_between(radius_map, bone, outer=outer, inner=inner)


def by_rays(profile: RayProfile, *, skip_mm: float, reach_mm: float, coupling_mm: float) -> list[SliceResult]:
    """Gap ends of every slice of a fan, tangents shared between neighbours.

    Parameters
    ----------
    profile : RayProfile
        In mm; its slices are 1 mm apart on the vault.
    skip_mm, reach_mm : float
        As for `rims.fit_rims`.
    coupling_mm : float
        Standard deviation over which tangents are shared; 0 for none.

    Returns
    -------
    list of SliceResult
        One for each slice that crosses the hole.
    """
    # position and tangent of each rim by itself, then the tangents of neighbours evened out
    fits = fit_rims(profile, skip_mm=skip_mm, reach_mm=reach_mm)
    tangents = share_tangents(fits.tangents, coupling_mm)  # 1 mm is one slice
    # how much the rim bends is noisy too: its median over the same neighbours
    turns = ndimage.median_filter(np.nan_to_num(fits.turns, nan=1.0), size=(2 * round(coupling_mm) + 1, 1, 1))
    results = []
    # a slice is bridged only when all four tangents (two boundaries, two ends) are known
    for plane in np.flatnonzero(profile.missing.any(axis=1)):
        if np.isfinite(tangents[plane]).all():
            ends = tuple(GapEnds(fits.points[plane, b], tangents[plane, b]) for b in (0, 1))
            results.append(SliceResult(int(plane), "balloon", ends=ends, turns_rad=turns[plane]))
        else:
            results.append(SliceResult(int(plane), "skipped", "too little bone beside the gap to fit a tangent to"))
    return results


def _weighted_mean(values: NDArray[np.float64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean over the first axis of what is known; nan where nothing is."""
    weights = np.where(np.isfinite(values), weights, 0.0)
    total = weights.sum(axis=0)
    return np.where(total > 0, (weights * np.nan_to_num(values)).sum(axis=0) / np.where(total > 0, total, 1.0), np.nan)


def _on_rays(
    results: Sequence[SliceResult], boundary: int, profile: RayProfile
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Radius of a fan's curves along the rays of its slices, and its weight; shape (P, K), nan and 0 elsewhere.

    A tangent that is wrong by an angle e at the end moves a cubic by e L t (1 - t)^2, so a point is the surer the
    shorter the slice's way across the hole, the nearer its rim, and the less the rim's own bone bends.
    """
    radii, weights = np.full(profile.outer.shape, np.nan), np.zeros(profile.outer.shape)
    for s in results:
        if not s.curves.size:
            continue
        # the curve as a radius for each ray
        row, col = s.curves[boundary].T
        angle = np.arctan2(col, -row)
        radii[s.plane] = np.interp(profile.angles, angle, np.hypot(row, col), np.nan, np.nan)
        # the square of its error: both tangents', and that of its ends
        t = np.clip((profile.angles - angle[0]) / (angle[-1] - angle[0]), 0, 1)
        length = np.hypot(row[-1] - row[0], col[-1] - col[0])
        slips = _TANGENT_ERROR**2 + (_TURN_ERROR * s.turns_rad[boundary]) ** 2
        error = length**2 * (slips[0] * (t * (1 - t) ** 2) ** 2 + slips[1] * (t**2 * (1 - t)) ** 2)
        weights[s.plane] = 1 / (error + _POINT_ERROR**2)
    return radii, weights
