"""What vaults look like: the radii of intact skulls, and with them the most likely radii where some are unknown.

Frame: mean head (see `mean_frame`); radii in mm of the mean head along directions from its origin.

Every intact skull is laid on the mean head, and its outer and inner radius are measured along the same 6400 rays. With
the mirror images as further skulls, these are samples f_1 .. f_m of a Gaussian process with mean mu and covariance

    K(a, b) = w taper(a, b) sum (f_i(a) - mu(a)) (f_i(b) - mu(b)) / (m - 1)  +  h(a) . h(b)  +  k(a, b),

a and b each being a ray and a side. The taper, exp(-d^2 / 2 L^2) in the chord d between the rays, drops what few
skulls cannot show (far-off correlations, Houtekamer and Mitchell 2001, "localisation"), and lifts the rank from m - 1
to thousands. The twelve h are what small affine maps do to the radii of the mean head: a skull with a hole is not
laid quite as it would be without. k is a sum of squared exponentials, smooth over long and short ways: what skulls do
that none of these did. Where nothing was learned it is left alone, and continues the known bone smoothly. The known
bone y of a skull then gives the rest as the conditional mean (Rasmussen and Williams 2006, eq. 2.25)

    f* = mu* + K* (K + s^2 I)^-1 (y - mu).

Outer and inner side inform each other, and so do left and right: both are correlations like others.

Most of what 30 skulls give is their mean on well laid heads; their covariance adds little, and at full weight it misled
over the largest holes. Hence the small w, chosen on half of 30 skulls and confirmed on the other half. Nothing learned
is shipped: the licences of skull collections seldom allow it.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from .alignment import estimate_normals
from .skull_points import SkullPoints
from .vault_radii import RADIUS_MM, coarse_rays, distance_mm, mirror_radii, vault_rays

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

_SHARE = 0.1  # w: what the sample covariance of a few dozen skulls is worth beside h and k
_TAPER_MM = 80.0  # L
_KERNEL = ((3.0, 80.0), (0.7, 25.0), (0.3, 10.0))  # mm of height and of length of each part of k
_LAID_MM = 1.0  # standard deviation of each part of the affine map that lays a skull on the mean head
_SIDES = 0.5  # correlation of the outer and the inner side in k
_NOISE_MM = 0.2  # s: voxels and sutures
_FINE_MM, _MIDDLE_MM = 12.0, 45.0  # from the unknown up to which all, and a quarter, of the known rays are used


@dataclass(frozen=True, eq=False)
class Prior:
    """Radius maps of intact skulls on the mean head.

    Parameters
    ----------
    mean : SkullPoints
        The mean head, on which a skull is laid.
    radii : ndarray of float32, shape (n, 2, m)
        Outer and inner radius of each skull along the m `vault_rays`, mm of the mean head; complete.
    """

    mean: SkullPoints
    radii: NDArray[np.float32]

    @property
    def samples(self) -> Array:
        """The skulls and their mirror images.

        Returns
        -------
        ndarray, shape (2 n, 2, m)
            Outer and inner radius, mm of the mean head.
        """
        return np.concatenate([self.radii, mirror_radii(self.radii)]).astype(float)

    def subset(self, chosen: Iterable[int]) -> Prior:
        """The same with some of its skulls.

        Parameters
        ----------
        chosen : iterable of int
            Their indices.

        Returns
        -------
        Prior
        """
        return Prior(self.mean, self.radii[list(chosen)])


def conditional_mean(prior: Prior, radii: Array, wanted: Mask) -> Array:
    """Conditional mean of both radii, given some of them.

    Parameters
    ----------
    prior : Prior
    radii : ndarray, shape (2, m)
        Known radii, mm of the mean head; nan on either side where a ray is unknown.
    wanted : ndarray of bool, shape (m,)
        Rays to predict.

    Returns
    -------
    ndarray, shape (2, k)
        Outer and inner radius along the k wanted rays.
    """
    # spread: factor of the sample covariance; laid: factor of what the affine frame may be off
    samples = prior.samples
    mean = samples.mean(axis=0)
    spread = (samples - mean) * np.sqrt(_SHARE / (len(samples) - 1))
    laid = _LAID_MM * np.stack([_affine_changes(side) for side in mean])
    # of the known rays all near the unknown that is wanted, fewer further away
    given = np.logical_and(*np.isfinite(radii))
    away = distance_mm(wanted & ~given)
    fewer = (away < _FINE_MM) | (coarse_rays(4) & (away < _MIDDLE_MM)) | coarse_rays(3)
    known = np.flatnonzero(given & fewer)
    at = np.flatnonzero(wanted)
    if not len(known):
        return mean[:, at]
    # f* = mu* + K* (K + s^2 I)^-1 (y - mu)
    matrix = _covariance(spread, laid, known, known)
    matrix[np.diag_indices(len(matrix))] += _NOISE_MM**2
    factor = linalg.cho_factor(matrix, overwrite_a=True, check_finite=False)
    weights = linalg.cho_solve(factor, (radii - mean)[:, known].ravel())
    return mean[:, at] + (_covariance(spread, laid, at, known) @ weights).reshape(2, -1)


def _covariance(spread: Array, laid: Array, a: NDArray[np.intp], b: NDArray[np.intp]) -> Array:
    """K between both sides of rays a and of rays b, shape (2 len(a), 2 len(b)).

    `spread` (2 n, 2, m) holds the samples about their mean, scaled, `laid` (2, m, 12) the h.
    """
    rays = vault_rays()
    # chord between two rays: |a - b|^2 = 2 - 2 a b
    squared = np.maximum(2 - 2 * rays[a] @ rays[b].T, 0) * RADIUS_MM**2
    # taper and k depend on the chord d between the rays alone
    taper = np.exp(squared / (-2 * _TAPER_MM**2))
    kernel = sum(height**2 * np.exp(squared / (-2 * length**2)) for height, length in _KERNEL)
    # the learned part and h depend on the sides as well
    parts = []
    for i in (0, 1):
        learned = [spread[:, i, a].T @ spread[:, j, b] * taper + laid[i, a] @ laid[j, b].T for j in (0, 1)]
        parts.append([learned[j] + (1.0 if i == j else _SIDES) * kernel for j in (0, 1)])
    return np.block(parts)


def _affine_changes(radius: Array) -> Array:
    """Change of radius (m,) for 1 mm of each part of an affine map, shape (m, 12).

    A point p of a surface with normal n that moves by u changes the radius along its ray d by (n . u) / (n . d).
    """
    points = vault_rays() * radius[:, None]
    normals = estimate_normals(points)
    facing = np.maximum(np.einsum("ij,ij->i", normals, vault_rays()), 0.3)  # a ray that grazes the base gives no radius
    # n / (n d) for a shift, and times p for a turn or stretch by 1 mm at the vault
    normals = normals / facing[:, None]
    turned = normals[:, :, None] * (points / RADIUS_MM)[:, None, :]
    return np.concatenate([normals, turned.reshape(-1, 9)], axis=1)
