"""The vault of a skull as two maps over the rays of the head frame: a bone mask and its frame come in -> maps go out.

Frames: head (see `headframe`); radii in mm of the mean head, outer side first. All maps are over `vault_rays`, shape
(..., m); the distance between two rays is their chord on a sphere of the vault's size, in mm.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..vault.ray_casting import surface_radii
from ..volume import Volume
from . import alignment
from .alignment import HeadFrame

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

VAULT = 105.0
"""Degrees from the vertex down to which the vault is mapped."""
RADIUS = 85.0
"""mm: turns chords of the unit sphere into lengths."""
_OUTLIER = 2.5  # mm off its surroundings: a suture, a vessel, a loose chip


@cache
def vault_rays() -> Array:
    """The rays of the vault, shape (m, 3), head frame: about 3 mm apart, symmetric about x = 0; read-only."""
    rays = alignment.sphere(5)
    rays = rays[rays[:, 2] > np.cos(np.radians(VAULT))]
    rays.setflags(write=False)
    return rays


def mirrored(radii: NDArray) -> NDArray:
    """Radius maps (..., m) over `vault_rays` of the mirror images of skulls."""
    return radii[..., alignment.twins(vault_rays())]


def measure(bone: Volume, frame: HeadFrame, middle: Array) -> Array:
    """Outer and inner radius of a skull along `vault_rays`, shape (2, m), mm of the mean head; nan for none.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    frame : HeadFrame
    middle : ndarray, shape (m,)
        Outer radius of the mean head, mm.
    """
    rays = vault_rays()
    stretch = frame.stretch(rays)
    directions = rays @ frame.matrix.T / stretch[:, None]
    outer, inner = surface_radii(bone, frame.origin, directions, middle * stretch)
    return np.stack([outer, inner]) / stretch


def radius_along_rays(points: Array) -> Array:
    """Radius of a surface given by points (n, 3) along each ray: weighted mean of the four nearest directions."""
    radius = np.linalg.norm(points, axis=1)
    apart, at = cKDTree(points / radius[:, None]).query(vault_rays(), 4)
    weight = 1 / (apart + 1e-3) ** 2
    return (radius[at] * weight).sum(axis=1) / weight.sum(axis=1)


def without_outliers(radii: Array, middle: Array) -> Array:
    """Radii (2, m) with nan where a ray is far off its surroundings."""
    offset = radii - middle
    with np.errstate(invalid="ignore"):
        good = np.abs(offset - surroundings(offset)) < _OUTLIER
    return np.where(good, radii, np.nan)


def surroundings(values: Array) -> Array:
    """Median of values (2, m) over each ray and its twelve neighbours; 0 where all are nan."""
    around = values[:, _neighbours(13)]
    return np.nanmedian(np.where(np.isnan(around).all(axis=-1, keepdims=True), 0.0, around), axis=-1)


def is_open(radii: Array) -> Mask:
    """Rays without bone whose neighbours mostly meet none either: openings, not sutures."""
    free = np.isnan(radii[0])
    return free & (free[_neighbours(7)].mean(axis=1) > 0.5)


def near(marked: Mask, reach: float) -> Mask:
    """Rays up to `reach` mm beside marked ones, these included."""
    return distance(marked) <= reach


def distance(marked: Mask) -> Array:
    """Chord from each ray to the nearest marked one, mm; inf where none is marked."""
    rays = vault_rays()
    return cKDTree(rays[marked]).query(rays)[0] * RADIUS if marked.any() else np.full(len(rays), np.inf)


@cache
def coarse(halvings: int) -> Mask:
    """Which rays belong to a coarser sphere, too; read-only."""
    rays = alignment.sphere(halvings)
    coarse = cKDTree(rays).query(vault_rays())[0] < 0.02  # a tenth to a half of a step: the finer points moved a little
    coarse.setflags(write=False)
    return coarse


@cache
def _neighbours(n: int) -> NDArray[np.intp]:
    """The n nearest rays of each ray, itself first, shape (m, n); read-only."""
    nearest = cKDTree(vault_rays()).query(vault_rays(), n)[1]
    nearest.setflags(write=False)
    return nearest
