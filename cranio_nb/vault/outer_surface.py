"""The outer surface of the vault along rays: a bone mask comes in -> radii and normals between voxels go out.

Frames: map (v, u) about the top of the head, see `ray_grid`; world (mm, LPS).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..volume import Volume
from .head_frame import head_or_grid_axes
from .ray_casting import FAR_MM, NEAR_MM
from .ray_grid import RayGrid

Array = NDArray[np.float64]

COMPARED_RAD = np.radians(105.0)
"""Angle from the top of the head down to which the surface is measured."""
_STEP_RAD = np.radians(2.0)  # between rays: 2.6 mm on the vault
_RIM = 2  # rays beside a hole that are left out: its edge is bevelled or thinned
_STRIDE_MM, _HALVINGS = 0.75, 20  # between samples of a ray; the edge between two is found to 1e-6 mm
_HALF = 0.5 - 1e-6  # of a blended mask is bone; so a ray midway between bone and none is in bone despite rounding


@dataclass(frozen=True, eq=False)
class OuterSurface:
    """The outer surface of the vault.

    Parameters
    ----------
    grid : RayGrid
        n rays along each side, about the top of the head.
    radius : ndarray, shape (n, n)
        mm; nan where the surface is not known.
    normals : ndarray, shape (n, n, 3)
        Outward unit normals, world; nan where the surface is not known.
    """

    grid: RayGrid
    radius: Array
    normals: Array

    @cached_property
    def known(self) -> NDArray[np.bool_]:
        """Rays along which the surface and its normal are known.

        Returns
        -------
        ndarray of bool, shape (n, n)
        """
        return np.asarray(np.isfinite(self.normals).all(axis=-1))

    @cached_property
    def interior(self) -> Array:
        """1 on rays along which the surface is known with all their neighbours, else 0.

        Returns
        -------
        ndarray, shape (n, n)
        """
        return ndimage.binary_erosion(self.known, np.ones((3, 3))).astype(float)

    @property
    def offsets(self) -> Array:
        """Known points of the surface, from the grid's centre.

        Returns
        -------
        ndarray, shape (k, 3)
            mm along the axes of the world.
        """
        return self.grid.points(self.radius)[self.known] - self.grid.centre

    def distances(self, offsets: Array) -> tuple[Array, Array]:
        """Distances of points from the surface, along its normals.

        Parameters
        ----------
        offsets : ndarray, shape (k, 3)
            From the grid's centre, mm.

        Returns
        -------
        distance : ndarray, shape (k,)
            mm, positive outside; nan where a point's own ray does not meet the surface.
        normals : ndarray, shape (k, 3)
            Of the surface where the points' rays meet it.
        """
        # radius and normal where each point's own ray meets the surface
        at = self.grid.locate(offsets)
        radius, *normal = (
            ndimage.map_coordinates(values, at, order=1, cval=np.nan)
            for values in (self.radius, *np.moveaxis(self.normals, -1, 0))
        )
        normals = np.stack(normal, axis=-1)
        length = np.linalg.norm(offsets, axis=1)
        lean = np.einsum("ni,ni->n", normals, offsets) / length
        return (length - radius) * lean, normals


def measure_outer_surface(bone: Volume, centre: Array, axes: Array | None = None) -> OuterSurface:
    """Measure the outer surface of the vault, smoothed over neighbouring rays, without the edges of holes.

    Parameters
    ----------
    bone : Volume
        Bool mask, planes rising to the top of the head.
    centre : ndarray, shape (3,)
        World mm of a point inside the cranial cavity.
    axes : ndarray, shape (3, 3), optional
        `Opening.head_axes`; found in the bone when not given.

    Returns
    -------
    OuterSurface
    """
    axes = head_or_grid_axes(bone) if axes is None else axes
    half = int(np.ceil(COMPARED_RAD / _STEP_RAD)) + _RIM + 2
    grid = RayGrid(np.asarray(centre, float), axes, _STEP_RAD, 2 * half + 1)
    raw, directions = np.full((grid.n, grid.n), np.nan), grid.directions
    inside = grid.polar <= COMPARED_RAD + (_RIM + 1) * _STEP_RAD
    raw[inside] = outermost_edge(bone, grid.centre, directions[inside])
    radius = _blurred(raw)
    # normals point across the two directions of the map, outwards
    points = grid.points(radius)
    normals = np.cross(np.gradient(points, axis=1), np.gradient(points, axis=0))
    normals *= np.sign(np.einsum("vui,vui->vu", normals, directions))[..., None]
    return OuterSurface(grid, radius, normals / np.linalg.norm(normals, axis=-1, keepdims=True))


def outermost_edge(bone: Volume, centre: Array, directions: Array) -> Array:
    """Where rays leave the outermost bone, between voxels.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    centre : ndarray, shape (3,)
        Where the rays start, world mm.
    directions : ndarray, shape (k, 3)
        Unit vectors, world.

    Returns
    -------
    ndarray, shape (k,)
        mm; nan where a ray meets no bone.

    Notes
    -----
    Bone is where the mask, blended between its voxels, exceeds a half. This has no leaps from voxel to voxel, so that
    a rounding of the affine moves no edge.
    """
    start, step = bone.to_voxel(centre), bone.steps(directions)

    def in_bone(rays: NDArray[np.intp], length: Array | float) -> NDArray[np.bool_]:
        at = start[:, None] + length * step[rays].T
        return ndimage.map_coordinates(bone.voxels, at, order=1, mode="grid-constant", output=float) > _HALF

    # the outermost sample in bone, from where a ray enters the box of the bone on
    low, high = np.array([(side.start - 1, side.stop) for side in bone.box()], float).T
    with np.errstate(divide="ignore", invalid="ignore"):
        reach = np.fmax((low - start) / step, (high - start) / step).min(axis=1)
    radius = np.full(len(directions), np.nan)
    for length in np.arange(FAR_MM, NEAR_MM, -_STRIDE_MM):
        open_rays = np.flatnonzero(np.isnan(radius) & (length <= reach))
        radius[open_rays[in_bone(open_rays, length)]] = length
    # the edge between it and the next one outwards, by bisection
    found = np.flatnonzero(np.isfinite(radius))
    for halving in range(1, _HALVINGS + 1):
        further = radius[found] + _STRIDE_MM / 2**halving
        radius[found] = np.where(in_bone(found, further), further, radius[found])
    return radius


def _blurred(radius: Array) -> Array:
    """Radii averaged with their neighbours that are known; nan within `_RIM` rays of those that are not."""
    known = np.isfinite(radius)
    weight = ndimage.gaussian_filter(known.astype(float), 1.0, truncate=_RIM)
    value = ndimage.gaussian_filter(np.where(known, radius, 0.0), 1.0, truncate=_RIM)
    return np.where(ndimage.binary_erosion(known, iterations=_RIM), value / np.maximum(weight, 1e-9), np.nan)
