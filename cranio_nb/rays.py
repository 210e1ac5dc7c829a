"""Stage 2, features for real skulls: a stack of slices comes in -> the ends of the gap in every slice go out.

Frames: slice (row, col) px, and polar (angle, radius) about the head's axis in the slice; angle 0 points up the slice
(against the rows) and grows towards the columns. Lengths in px unless a name says mm.

The skeleton of a real slice forks, loops and runs into the skull base. Seen from the head's axis the vault is one
radius per direction instead: outer surface, inner surface, and a gap where a ray meets no bone. Boundary points are
still left out near the rim (`skip`) and fitted over a neighbourhood (`reach`), both arc lengths as in the paper.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

_BREAK = 3.0  # mm: breaks along a ray up to this are diploe, not the end of the bone


@dataclass(frozen=True, eq=False)
class RayProfile:
    """The bone of each slice as radii about a centre.

    Parameters
    ----------
    centre : ndarray, shape (2,)
        Slice (row, col) px.
    angles : ndarray, shape (K,)
        Radians, evenly spaced.
    inner, outer : ndarray, shape (P, K)
        First and last bone along each ray, px; nan where the ray meets none.
    """

    centre: NDArray[np.float64]
    angles: NDArray[np.float64]
    inner: NDArray[np.float64]
    outer: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RimFits:
    """Positions and tangents of both boundaries at both rims of the gap, for each slice.

    Parameters
    ----------
    gap : ndarray of int, shape (P, 2)
        First and last ray of the gap; -1 where the slice has none.
    points, tangents : ndarray, shape (P, 2, 2, 2)
        [slice, boundary (0 outer, 1 inner), end, (row, col)]; tangents point into the gap; nan where unknown.
    """

    gap: NDArray[np.intp]
    points: NDArray[np.float64]
    tangents: NDArray[np.float64]


def look(slices: NDArray[np.bool_], centre: NDArray[np.float64], angles: NDArray, *, px: float) -> RayProfile:
    """Measure inner and outer radius of the bone along rays.

    Parameters
    ----------
    slices : ndarray of bool, shape (P, R, C)
    centre : ndarray, shape (2,)
        (row, col) px, the same for all slices; may lie outside the image.
    angles : ndarray, shape (K,)
        Directions of the rays, radians.
    px : float
        mm per pixel.
    """
    corners = np.array([[0, 0], [0, 1], [1, 0], [1, 1]]) * slices.shape[1:]
    radii = np.arange(10.0 / px, np.hypot(*(corners - centre).T).max(), 0.5)
    rows = np.rint(centre[0] - np.cos(angles)[:, None] * radii).astype(np.intp)
    cols = np.rint(centre[1] + np.sin(angles)[:, None] * radii).astype(np.intp)
    within = (rows >= 0) & (rows < slices.shape[1]) & (cols >= 0) & (cols < slices.shape[2])
    flat = np.where(within, rows * slices.shape[2] + cols, 0)
    inner, outer = np.full((2, len(slices), len(angles)), np.nan)
    for i, image in enumerate(slices):
        bone = image.ravel()[flat] & within
        inner[i], outer[i] = _first_and_last(bone, radii, breaks=int(_BREAK / px / 0.5))
    return RayProfile(np.asarray(centre, float), np.asarray(angles, float), inner, outer)


def find_gaps(
    profile: RayProfile, opening: NDArray[np.bool_], *, px: float, apart: float, full: float = 0.85, worn: float = 8.0
) -> NDArray[np.intp]:
    """First and last ray of the lesion's gap in each slice.

    Parameters
    ----------
    profile : RayProfile
    opening : ndarray of bool, shape (P, R, C)
        Where the lesion crosses each slice.
    px, apart : float
        mm per pixel, and between slices.
    full : float
        Next to the hole, bone thinner than this fraction of the usual thickness belongs to the gap: bevelled or worn
        rims, and slices of partial loss (the paper's Fig. 6), which have no hole of their own.
    worn : float
        mm beside the hole that may be worn.

    Returns
    -------
    ndarray of int, shape (P, 2)
        -1 where the slice has no gap.
    """
    thickness = profile.outer - profile.inner
    ray_apart = np.nanmedian(profile.outer) * (profile.angles[1] - profile.angles[0]) * px
    free = np.isnan(thickness)
    hole = _connected(free, _crossed(profile, opening) & free)
    away = ndimage.distance_transform_edt(~hole, sampling=(apart, ray_apart))
    usual = _usual_thickness(thickness, (away > worn) & (away < worn + 20) & ~free)
    missing = _connected(hole | ((thickness < full * usual) & (away <= worn)), hole)
    gap = np.full((len(free), 2), -1)
    rows = np.flatnonzero(missing.any(axis=1))
    gap[rows, 0] = missing[rows].argmax(axis=1)
    gap[rows, 1] = missing.shape[1] - 1 - missing[rows, ::-1].argmax(axis=1)
    return gap


def _connected(mask: NDArray[np.bool_], seeds: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The parts of a mask that hold a seed."""
    labels, _ = ndimage.label(mask)
    kept = np.unique(labels[seeds])
    return np.isin(labels, kept[kept > 0])


def _usual_thickness(thickness: NDArray[np.float64], around: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Plane through the thickness of the sound bone around the hole, continued across it, shape (P, K), px."""
    row, ray = np.nonzero(around)
    basis = np.stack([np.ones(len(row)), row, ray], axis=1)
    values = thickness[row, ray]
    weight = np.ones(len(row))
    for _ in range(5):
        plane = np.linalg.lstsq(basis * weight[:, None], values * weight, rcond=None)[0]
        residual = values - basis @ plane
        weight = 1 / np.maximum(1, np.abs(residual) / (1.4826 * np.median(np.abs(residual)) + 1e-6))
    rows, rays = np.ogrid[: thickness.shape[0], : thickness.shape[1]]
    return plane[0] + plane[1] * rows + plane[2] * rays


def fit_rims(
    profile: RayProfile, gap: NDArray[np.intp], *, skip: float, reach: float, order: int = 2, n_points: int = 40
) -> RimFits:
    """Fit both boundaries beside the gap and carry position and tangent to the first fitted point.

    Parameters
    ----------
    profile : RayProfile
    gap : ndarray of int, shape (P, 2)
    skip, reach : float
        Arc lengths on the boundary, px: left out next to the gap, and fitted after that.
    order : int
        1: radius linear in the angle, an arc about the head's axis where it is constant. 2: with its bend, so that
        the tangent at the rim is not that of the middle of the neighbourhood.
    n_points : int
        Points sampled over `reach`.

    Returns
    -------
    RimFits
        nan where a rim has bone for fewer than half of its points.
    """
    step = profile.angles[1] - profile.angles[0]
    points, tangents = np.full((2, len(gap), 2, 2, 2), np.nan)
    good = np.flatnonzero(gap[:, 0] >= 0)
    t = np.linspace(0, 1, n_points)
    for boundary, radius in enumerate((profile.outer, profile.inner)):
        typical = np.nanmedian(radius[good], axis=1)[:, None]
        for end, direction in enumerate((-1, 1)):
            away = 1 + np.rint((skip + t * reach) / (typical * step)).astype(np.intp)
            rays = gap[good, end][:, None] + direction * away
            inside = (rays >= 0) & (rays < radius.shape[1])
            rays = np.clip(rays, 0, radius.shape[1] - 1)
            r = np.where(inside, radius[good[:, None], rays], np.nan)
            x = (away - away[:, :1]) * step * direction
            value, slope = _robust_fit(x, r, order)
            angle = profile.angles[rays[:, 0]]
            up = np.stack([-np.cos(angle), np.sin(angle)], axis=-1)
            onward = np.stack([np.sin(angle), np.cos(angle)], axis=-1)
            points[good, boundary, end] = profile.centre + value[:, None] * up
            along = slope[:, None] * up + value[:, None] * onward
            tangents[good, boundary, end] = -direction * along / np.linalg.norm(along, axis=-1, keepdims=True)
    return RimFits(gap, points, tangents)


def _first_and_last(bone: NDArray[np.bool_], radii: NDArray, breaks: int) -> tuple[NDArray, NDArray]:
    """Radii where the outermost run of bone begins and ends on each ray; short breaks do not end a run."""
    index = np.arange(bone.shape[1])
    before = np.maximum.accumulate(np.where(bone, index, -(10**6)), axis=1)
    before = np.concatenate([np.full((len(bone), 1), -(10**6)), before[:, :-1]], axis=1)
    begins = bone & (index - before > breaks)
    first = np.where(begins, index, -1).max(axis=1)
    last = np.where(bone, index, -1).max(axis=1)
    none = last < 0
    half = (radii[1] - radii[0]) / 2
    return np.where(none, np.nan, radii[first] - half), np.where(none, np.nan, radii[last] + half)


def _crossed(profile: RayProfile, opening: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Rays of each slice that pass through the opening, shape (P, K)."""
    plane, row, col = np.nonzero(opening)
    angle = np.arctan2(col - profile.centre[1], profile.centre[0] - row)
    step = profile.angles[1] - profile.angles[0]
    ray = np.rint((angle - profile.angles[0]) / step).astype(np.intp)
    seen = (ray >= 0) & (ray < len(profile.angles))
    crossed = np.zeros(profile.outer.shape, bool)
    crossed[plane[seen], ray[seen]] = True
    return ndimage.binary_closing(crossed, np.ones((1, 5)))


def _robust_fit(x: NDArray, y: NDArray, order: int) -> tuple[NDArray, NDArray]:
    """Value and slope at x = 0 of a polynomial per row, outliers down-weighted (Tukey's biweight), shape (P,) each."""
    known = np.isfinite(y)
    scale = np.abs(x).max(axis=1, keepdims=True)
    basis = (x / scale)[..., None] ** np.arange(order + 1)
    y = np.where(known, y, 0.0)
    weight = known.astype(float)
    for _ in range(6):
        weighted = basis * weight[..., None]
        normal = np.einsum("pni,pnj->pij", weighted, basis) + 1e-9 * np.eye(order + 1)
        coefficients = np.linalg.solve(normal, np.einsum("pni,pn->pi", weighted, y)[..., None])[..., 0]
        residual = np.where(known, y - np.einsum("pni,pi->pn", basis, coefficients), np.nan)
        with np.errstate(all="ignore"):
            spread = 1.4826 * np.nanmedian(np.abs(np.where(known, residual, 0)), axis=1, keepdims=True)
        u = np.nan_to_num(residual) / (4 * np.maximum(spread, 0.3))
        weight = np.where(known & (np.abs(u) < 1), (1 - u**2) ** 2, 0.0)
    enough = known.mean(axis=1) >= 0.5
    return np.where(enough, coefficients[:, 0], np.nan), np.where(enough, coefficients[:, 1] / scale[:, 0], np.nan)


def share_tangents(tangents: NDArray[np.float64], sigma: float) -> NDArray[np.float64]:
    """Smooth tangents over neighbouring slices (Gaussian of `sigma` slices); unknown ones stay unknown.

    Parameters
    ----------
    tangents : ndarray, shape (P, ..., 2)
        Unit vectors; nan where unknown.
    sigma : float
        Standard deviation, slices; 0 leaves them as they are.
    """
    if sigma <= 0:
        return tangents
    shared = ndimage.gaussian_filter1d(np.nan_to_num(tangents), sigma, axis=0, mode="constant")
    shared = np.where(np.isnan(tangents), np.nan, shared)
    return shared / np.linalg.norm(shared, axis=-1, keepdims=True)
