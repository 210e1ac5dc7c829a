"""The vault of a skull as two maps over the rays of the mean frame: a bone mask and its frame come in -> maps go out.

Frame: mean head (see `mean_frame`); radii in mm of it, outer side first. All maps are over `vault_rays`, shape
(..., m); the distance between two rays is their chord on a sphere of the vault's size, in mm.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..vault.ray_casting import surface_radii
from ..volume import Volume
from .mean_frame import MeanFrame, even_directions, mirror_index

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

VAULT_DEG = 105.0
"""From the vertex down to which the vault is mapped."""
RADIUS_MM = 85.0
"""Turns chords of the unit sphere into lengths."""
_OUTLIER_MM = 2.5  # off its surroundings: a suture, a vessel, a loose chip


@cache
def vault_rays() -> Array:
    """The rays of the vault.

    Returns
    -------
    ndarray, shape (m, 3)
        Unit vectors of the mean frame, about 3 mm apart on the vault, symmetric about x = 0; read-only.

    Examples
    --------
    >>> vault_rays().shape
    (6437, 3)
    """
    # of a sphere of directions those above the skull base
    rays = even_directions(5)
    rays = rays[rays[:, 2] > np.cos(np.radians(VAULT_DEG))]
    rays.setflags(write=False)
    return rays


def mirror_radii(radii: NDArray) -> NDArray:
    """Radius maps of the mirror images of skulls.

    Parameters
    ----------
    radii : ndarray, shape (..., m)

    Returns
    -------
    ndarray, shape (..., m)
    """
    return radii[..., mirror_index(vault_rays())]


def measure_vault(bone: Volume, frame: MeanFrame, middle: Array) -> Array:
    """Outer and inner radius of a skull along `vault_rays`.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    frame : MeanFrame
    middle : ndarray, shape (m,)
        Outer radius of the mean head, mm.

    Returns
    -------
    ndarray, shape (2, m)
        Outer and inner radius, mm of the mean head; nan where a ray meets no bone.
    """
    rays = vault_rays()
    # a ray of the mean frame in the world, and its length there: radii in mm of the mean head
    stretch = frame.stretch(rays)
    directions = rays @ frame.matrix.T / stretch[:, None]
    outer, inner = surface_radii(bone, frame.origin, directions, middle * stretch)
    return np.stack([outer, inner]) / stretch


def interpolate_radius(points: Array) -> Array:
    """Radius of a surface along each ray.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Of the surface, mean frame.

    Returns
    -------
    ndarray, shape (m,)
        Mean over the four nearest directions, weighted by the inverse square of their chord.
    """
    # the surface as one radius per direction, then the directions nearest to each ray
    radius = np.linalg.norm(points, axis=1)
    apart, at = cKDTree(points / radius[:, None]).query(vault_rays(), 4)
    weight = 1 / (apart + 1e-3) ** 2
    return (radius[at] * weight).sum(axis=1) / weight.sum(axis=1)


def without_outliers(radii: Array, usual: Array) -> Array:
    """Radii with nan where a ray is far off what is usual around it.

    Parameters
    ----------
    radii : ndarray, shape (2, m)
        mm; nan where unknown.
    usual : ndarray, shape (2, m)
        The mean head's radii moved by the `local_median` of what the skull differs from them, mm.

    Returns
    -------
    ndarray, shape (2, m)
        mm.
    """
    with np.errstate(invalid="ignore"):
        good = np.abs(radii - usual) < _OUTLIER_MM
    return np.where(good, radii, np.nan)


def local_median(values: Array) -> Array:
    """Median over each ray and its twelve neighbours.

    Parameters
    ----------
    values : ndarray, shape (2, m)
        nan where unknown.

    Returns
    -------
    ndarray, shape (2, m)
        0 where all are nan.
    """
    # rays without any known neighbour get 0: no offset from the mean head
    around = values[:, _neighbours(13)]
    return np.nanmedian(np.where(np.isnan(around).all(axis=-1, keepdims=True), 0.0, around), axis=-1)


def rays_without_bone(radii: Array) -> Mask:
    """Rays without bone whose neighbours mostly meet none either: openings, not sutures.

    Parameters
    ----------
    radii : ndarray, shape (2, m)
        nan where a ray meets no bone.

    Returns
    -------
    ndarray of bool, shape (m,)
    """
    # a suture lets single rays through, an opening a whole neighbourhood
    free = np.isnan(radii[0])
    return free & (free[_neighbours(7)].mean(axis=1) > 0.5)


def rays_near(marked: Mask, reach_mm: float) -> Mask:
    """Rays beside marked ones.

    Parameters
    ----------
    marked : ndarray of bool, shape (m,)
    reach_mm : float
        Largest chord.

    Returns
    -------
    ndarray of bool, shape (m,)
        With the marked ones.
    """
    return distance_mm(marked) <= reach_mm


def distance_mm(marked: Mask) -> Array:
    """Chord from each ray to the nearest marked one.

    Parameters
    ----------
    marked : ndarray of bool, shape (m,)

    Returns
    -------
    ndarray, shape (m,)
        mm; inf where none is marked.
    """
    rays = vault_rays()
    return cKDTree(rays[marked]).query(rays)[0] * RADIUS_MM if marked.any() else np.full(len(rays), np.inf)


@cache
def coarse_rays(halvings: int) -> Mask:
    """Which rays belong to a coarser set of directions, too.

    Parameters
    ----------
    halvings : int
        Of `even_directions`; fewer than those of the rays.

    Returns
    -------
    ndarray of bool, shape (m,)
        Read-only.
    """
    rays = even_directions(halvings)
    # a tenth to a half of a step: the finer points moved a little
    coarse = cKDTree(rays).query(vault_rays())[0] < 0.02
    coarse.setflags(write=False)
    return coarse


@cache
def _neighbours(n: int) -> NDArray[np.intp]:
    """The n nearest rays of each ray, itself first, shape (m, n); read-only."""
    nearest = cKDTree(vault_rays()).query(vault_rays(), n)[1]
    nearest.setflags(write=False)
    return nearest
