"""Stage 2, features for real skulls: radii along rays come in -> the ends of the gap in every slice go out.

Frames: slice (row, col), and polar (angle, radius) about a centre inside the head; angle 0 points up the slice
(against the rows) and grows towards the columns. Lengths in the unit of the slice.

The skeleton of a real slice forks, loops and runs into the skull base. Along rays from inside the head the vault is one
radius per direction instead: outer surface, inner surface, and a gap. Boundary points are still left out near the
rim (`skip`) and fitted over a neighbourhood (`reach`), both arc lengths as in the paper.
"""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage


@dataclass(frozen=True, eq=False)
class RayProfile:
    """The bone of each slice as radii about a centre.

    Parameters
    ----------
    centre : ndarray, shape (2,)
        Slice (row, col).
    angles : ndarray, shape (K,)
        Radians, evenly spaced.
    outer, inner : ndarray, shape (P, K)
        Radii of the outer and inner surface along each ray; nan where the ray meets no bone.
    missing : ndarray of bool, shape (P, K)
        Rays in which bone is missing: the gap.
    """

    centre: NDArray[np.float64]
    angles: NDArray[np.float64]
    _: KW_ONLY
    outer: NDArray[np.float64]
    inner: NDArray[np.float64]
    missing: NDArray[np.bool_]

    @property
    def gap(self) -> NDArray[np.intp]:
        """First and last missing ray of each slice.

        Returns
        -------
        ndarray of int, shape (P, 2)
            -1 where there is none.
        """
        first = self.missing.argmax(axis=1)
        last = self.missing.shape[1] - 1 - self.missing[:, ::-1].argmax(axis=1)
        return np.where(self.missing.any(axis=1, keepdims=True), np.stack([first, last], axis=1), -1)


@dataclass(frozen=True, eq=False)
class RimFits:
    """Positions and tangents of both boundaries at both rims of the gap, for each slice.

    Parameters
    ----------
    points, tangents : ndarray, shape (P, 2, 2, 2)
        [slice, boundary (0 outer, 1 inner), end, (row, col)]; tangents point into the gap; nan where unknown.
    turns : ndarray, shape (P, 2, 2)
        [slice, boundary, end]: how much the slope of the radius changes over `reach`, radians. Sound vault turns
        little; ridges, sinuses and thin spots turn much, and a tangent taken there says little about the gap.
    """

    points: NDArray[np.float64]
    tangents: NDArray[np.float64]
    turns: NDArray[np.float64]


def fit_rims(profile: RayProfile, *, skip: float, reach: float, order: int = 2, n_points: int = 40) -> RimFits:
    """Fit both boundaries beside the gap and carry position and tangent to the first fitted point.

    Parameters
    ----------
    profile : RayProfile
    skip, reach : float
        Arc lengths on the boundary: left out next to the gap, and fitted after that.
    order : int
        1: radius linear in the angle, an arc about the centre where it is constant. 2: with its bend, so that the
        tangent at the rim is not that of the middle of the neighbourhood.
    n_points : int
        Points sampled over `reach`.

    Returns
    -------
    RimFits
        nan where a rim has bone for fewer than half of its points.
    """
    gap, step = profile.gap, profile.angles[1] - profile.angles[0]
    points, tangents = np.full((2, len(gap), 2, 2, 2), np.nan)
    turns = np.full((len(gap), 2, 2), np.nan)
    good = np.flatnonzero(gap[:, 0] >= 0)
    t = np.linspace(0, 1, n_points)
    for boundary, radius in enumerate((profile.outer, profile.inner)):
        typical = np.nanmedian(radius)
        # rays from the first fitted point on, as arc lengths on this boundary
        away = 1 + np.rint((skip + t * reach) / (typical * step)).astype(np.intp)
        for end, direction in enumerate((-1, 1)):
            rays = gap[good, end][:, None] + direction * away
            inside = (rays >= 0) & (rays < radius.shape[1])
            rays = np.clip(rays, 0, radius.shape[1] - 1)
            r = np.where(inside, radius[good[:, None], rays], np.nan)
            # radius over angle, fitted; value and slope at the first fitted point
            x = np.broadcast_to((away - away[0]) * step * direction, r.shape)
            value, slope, bend = _robust_fit(x, r, order, noise=0.004 * typical)
            turns[good, boundary, end] = np.abs(2 * bend * x[:, -1] / value)
            # position and tangent there, in the slice
            angle = profile.angles[rays[:, 0]]
            up = np.stack([-np.cos(angle), np.sin(angle)], axis=-1)
            onward = np.stack([np.sin(angle), np.cos(angle)], axis=-1)
            along = slope[:, None] * up + value[:, None] * onward
            points[good, boundary, end] = profile.centre + value[:, None] * up
            tangents[good, boundary, end] = -direction * along / np.linalg.norm(along, axis=-1, keepdims=True)
    return RimFits(points, tangents, turns)


def share_tangents(tangents: NDArray[np.float64], sigma: float) -> NDArray[np.float64]:
    """Smooth tangents over neighbouring slices; unknown ones stay unknown.

    A running median drops the slices that disagree with their neighbours, a Gaussian smooths the rest.

    Parameters
    ----------
    tangents : ndarray, shape (P, ..., 2)
        Unit vectors; nan where unknown.
    sigma : float
        Standard deviation of the Gaussian and half width of the median, slices; 0 leaves them as they are.

    Returns
    -------
    ndarray, shape (P, ..., 2)
        Unit vectors; nan where unknown.
    """
    known = np.isfinite(tangents).all(axis=tuple(range(1, tangents.ndim)))
    if sigma <= 0 or not known.any():
        return tangents
    width = (min(2 * int(np.ceil(sigma)) + 1, int(known.sum())), *[1] * (tangents.ndim - 1))
    # among known slices the median, over all of them the Gaussian, in which unknown ones weigh nothing
    shared = np.zeros(tangents.shape)
    shared[known] = ndimage.median_filter(tangents[known], size=width, mode="nearest")
    shared = ndimage.gaussian_filter1d(shared, sigma, axis=0, mode="constant")
    shared[~known] = np.nan
    return shared / np.linalg.norm(shared, axis=-1, keepdims=True)


def _robust_fit(x: NDArray, y: NDArray, order: int, noise: float) -> tuple[NDArray, NDArray, NDArray]:
    """Value, slope and half second derivative at x = 0 of a polynomial per row, shape (P,) each; Tukey's biweight."""
    # powers of x in units of its range
    known = np.isfinite(y)
    scale = np.abs(x).max(axis=1, keepdims=True)
    basis = (x / scale)[..., None] ** np.arange(order + 1)
    y = np.where(known, y, 0.0)
    weight = known.astype(float)
    # weighted least squares, weights by Tukey's biweight of the residuals
    for _ in range(6):
        weighted = basis * weight[..., None]
        normal = np.einsum("pni,pnj->pij", weighted, basis) + 1e-9 * np.eye(order + 1)
        coefficients = np.linalg.solve(normal, np.einsum("pni,pn->pi", weighted, y)[..., None])[..., 0]
        residual = np.where(known, y - np.einsum("pni,pi->pn", basis, coefficients), 0.0)
        spread = 1.4826 * np.median(np.abs(residual), axis=1, keepdims=True)
        u = residual / (4 * np.maximum(spread, noise))
        weight = np.where(known & (np.abs(u) < 1), (1 - u**2) ** 2, 0.0)
    coefficients[known.mean(axis=1) < 0.5] = np.nan
    powers = np.pad(coefficients, ((0, 0), (0, 2)))[:, :3] / scale ** np.arange(3)
    return powers[:, 0], powers[:, 1], powers[:, 2]
