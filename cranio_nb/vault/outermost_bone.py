"""The outermost bone along rays about the vertex, and where there is none: a bone mask comes in -> maps go out.

Frames: bone in voxel (plane, row, col); rays on a map (v, u) about the vertex; lengths in mm.

Rays run from a point inside the head to the vault. A ray that meets no bone leaves through an opening; rays that leave
side by side belong to the same one. Nothing has to be clicked.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.interpolate import RBFInterpolator

from ..volume import Volume
from .orientation import head_centre
from .ray_casting import FAR_MM, NEAR_MM
from .ray_grid import RayGrid, filled_from_nearest

STEP_DEG = 1.5
"""Degrees between rays: 2 mm on the vault."""
_SEARCHED_DEG = 102.0  # from the vertex down to which the vault is searched; further down lie orbits and base
_BESIDE_DEG = 10.0  # more, so that an opening can be followed over the border
_BASE_DEG = 88.0  # an opening that lies wholly further down is an orbit, an ear canal, the base
_BROW_DEG = 10.0  # by which the line between vault and base rises in front and falls behind
_BAND_DEG = 6.0  # below the line between vault and base, where no natural opening begins and a cut one may lie
_HINT = 0.5  # of the width that is seen through: so much of it coarse voxels may leave
_HINT_RAYS = 3  # side by side; what is smaller is a pit or a vessel
_APART_RAYS = 3  # beside an opening: what is open within is a part of its rim
_SIDE_DEG = 90.0  # the vault proper, over which its radius is averaged
_SEEN = 0.75  # of the width of a small opening that is seen through, where rays cross a thick wall aslant
_SAMPLE_MM = 0.75  # along a ray
_EDGE_MM = 3.0  # a ray that leaves the image so far before its neighbours meet bone is not followed to the end
_RIM_RAYS, _AROUND_RAYS = 2, 10  # beside an opening: left out as its rim, and up to where the vault is bent across
_KNOTS = 500  # rays from which the vault is bent across


@dataclass(frozen=True, eq=False)
class OutermostBone:
    """The outermost bone along rays about the vertex.

    Parameters
    ----------
    grid : RayGrid
        n rays along each side; the middle one points to the vertex.
    radius : ndarray, shape (n, n)
        Distance to the outermost bone, mm; nan where there is none.
    seen : ndarray, shape (n, n)
        How far each ray stays in the image, mm.
    """

    grid: RayGrid
    radius: NDArray[np.float64]
    seen: NDArray[np.float64]

    def within(self, degrees: float) -> NDArray[np.bool_]:
        """Rays up to an angle from the vertex.

        Parameters
        ----------
        degrees : float

        Returns
        -------
        ndarray of bool, shape (n, n)
        """
        return self.grid.polar <= np.radians(degrees) + 1e-9

    @property
    def above_base(self) -> NDArray[np.bool_]:
        """Rays above the line between vault and base, which rises to the brow in front and falls to the nape behind.

        Returns
        -------
        ndarray of bool, shape (n, n)
        """
        return self.below_line_deg <= 1e-7

    @property
    def below_line_deg(self) -> NDArray[np.float64]:
        """How far the rays lie below the line between vault and base.

        Returns
        -------
        ndarray, shape (n, n)
            Degrees; below 0 on the vault.
        """
        v, _ = self.grid.offsets
        front = -v / np.maximum(self.grid.polar, 1e-9)
        return np.degrees(self.grid.polar) - _BASE_DEG + _BROW_DEG * front

    @property
    def typical_radius(self) -> float:
        """Median radius of the vault.

        Returns
        -------
        float
            mm.
        """
        return float(np.nanmedian(self.radius[self.within(_SIDE_DEG)]))


def vertex_rays(bone: Volume, axes: NDArray[np.float64]) -> RayGrid:
    """Rays about the vertex from a point inside the head.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    axes : ndarray, shape (3, 3)
        Rows: the head's left, back and up, orthonormal, world.

    Returns
    -------
    RayGrid
    """
    half = int(np.ceil((_SEARCHED_DEG + _BESIDE_DEG + 2) / STEP_DEG))
    return RayGrid(head_centre(bone, axes), axes, np.radians(STEP_DEG), 2 * half + 1)


def measure_outermost_bone(bone: Volume, grid: RayGrid) -> OutermostBone:
    """Measure the vault along rays about the vertex.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    grid : RayGrid
        From `vertex_rays`.

    Returns
    -------
    OutermostBone
    """
    n_rays = grid.n**2
    return _followed(bone, grid, np.full(n_rays, np.nan), np.zeros(n_rays), np.arange(n_rays))


def measured_again(outermost: OutermostBone, bone: Volume) -> OutermostBone:
    """The same rays in less bone: only those are followed again that met what is gone.

    Parameters
    ----------
    outermost : OutermostBone
    bone : Volume
        Bool mask of a part of the bone that was measured.

    Returns
    -------
    OutermostBone
        As `measure_outermost_bone` gives it.
    """
    grid, radius = outermost.grid, outermost.radius.ravel().copy()
    met = np.flatnonzero(np.isfinite(radius))
    index = bone.to_voxel(grid.centre) + radius[met, None] * bone.steps(grid.directions).reshape(-1, 3)[met]
    gone = met[~bone.at_index(index, outside=False)]
    radius[gone] = np.nan
    return _followed(bone, grid, radius, outermost.seen.ravel().copy(), gone)


def _followed(
    bone: Volume, grid: RayGrid, radius: NDArray[np.float64], seen: NDArray[np.float64], left: NDArray[np.intp]
) -> OutermostBone:
    """The maps of all rays, once those that are left are followed inwards, each up to the first bone it meets."""
    start = bone.to_voxel(grid.centre)[:, None]
    step = np.ascontiguousarray(bone.steps(grid.directions).reshape(-1, 3)[left].T)
    marked = bone.with_voxels(bone.voxels.view(np.int8))
    for length in np.arange(NEAR_MM, FAR_MM, _SAMPLE_MM)[::-1]:
        found = marked.at_index((start + length * step).T, outside=-1)
        inside, met = found >= 0, found > 0
        seen[left[inside]] = np.maximum(seen[left[inside]], length)
        if met.any():
            radius[left[met]] = length
            left, step = left[~met], step[:, ~met]
    return OutermostBone(grid, radius.reshape(grid.n, grid.n), seen.reshape(grid.n, grid.n))


def open_rays(outermost: OutermostBone, min_diameter_mm: float) -> list[NDArray[np.bool_]]:
    """Rays that leave through one opening each.

    Parameters
    ----------
    outermost : OutermostBone
    min_diameter_mm : float
        Width of the smallest opening.

    Returns
    -------
    list of ndarray of bool, shape (n, n)
        Largest first.
    """
    # an opening has a core in which a disk of the smallest diameter fits; the core grows back to the rim
    reach = _core_reach(outermost, min_diameter_mm)
    free = _free_rays(outermost)
    core = (ndimage.distance_transform_edt(free) > reach) & outermost.within(_SEARCHED_DEG)
    grown = ndimage.binary_dilation(core, _disk(reach + 1), mask=free)
    # without a core on the vault it is a pocket beside the hole, or at the base
    return _pieces(grown, core & outermost.above_base)


def hinted_rays(
    outermost: OutermostBone, groups: list[NDArray[np.bool_]], min_diameter_mm: float, *, blurred: bool
) -> list[NDArray[np.bool_]]:
    """Rays that leave where an opening may be: too narrow to be seen well, or just below the vault.

    Parameters
    ----------
    outermost : OutermostBone
    groups : list of ndarray of bool, shape (n, n)
        The openings, from `open_rays`.
    min_diameter_mm : float
        As for `open_rays`.
    blurred : bool
        Whether the voxels are so coarse that they blur small openings; else narrower places are none.

    Returns
    -------
    list of ndarray of bool, shape (n, n)
        Largest first, apart from the openings.
    """
    free = _free_rays(outermost)
    known = np.logical_or.reduce([np.zeros_like(free), *groups])
    reach = _core_reach(outermost, min_diameter_mm) * (_HINT if blurred else 1.0)
    core = ndimage.distance_transform_edt(free) > reach
    near = core & outermost.within(_SEARCHED_DEG) & (outermost.below_line_deg <= _BAND_DEG)
    beside = ndimage.binary_dilation(known, iterations=_APART_RAYS)
    pieces = _pieces(free, near)
    return [rays for rays in pieces if np.count_nonzero(rays) >= _HINT_RAYS and not (rays & beside).any()]


def _free_rays(outermost: OutermostBone) -> NDArray[np.bool_]:
    """Rays that meet no bone, over the vault and a little more."""
    return np.isnan(outermost.radius) & outermost.within(_SEARCHED_DEG + _BESIDE_DEG)


def _core_reach(outermost: OutermostBone, min_diameter_mm: float) -> float:
    """Radius of the core of the smallest opening, rays."""
    return float(_SEEN * np.degrees(min_diameter_mm / 2 / outermost.typical_radius) / STEP_DEG)


def _pieces(mask: NDArray[np.bool_], seeds: NDArray[np.bool_]) -> list[NDArray[np.bool_]]:
    """The connected pieces of a mask that hold a seed, largest first."""
    labels, _ = ndimage.label(mask, np.ones((3, 3)))
    held = np.setdiff1d(labels[seeds & mask], 0)
    return sorted((labels == i for i in held), key=np.count_nonzero, reverse=True)


def room_in_image(outermost: OutermostBone, rays: NDArray[np.bool_]) -> float:
    """How far the bone that is missing in an opening stays from the edge of the image.

    Parameters
    ----------
    outermost : OutermostBone
    rays : ndarray of bool, shape (n, n)
        Those of the opening.

    Returns
    -------
    float
        mm; below 0 where a part of it would lie outside.

    Notes
    -----
    The outer surface is bent across the opening as a thin plate (Duchon's spline) that meets the bone around it. Where
    the bone around it is cut off as well, that surface is not to be trusted, and the bone nearest to it counts.
    """
    near = filled_from_nearest(outermost.radius)[rays] - _EDGE_MM
    return float((outermost.seen[rays] - np.maximum(near, _bent_across(outermost, rays))).min())


def _bent_across(outermost: OutermostBone, rays: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Radius of the outer surface expected along the rays of an opening, shape (k,), mm."""
    beside, beyond = (ndimage.binary_dilation(rays, iterations=n) for n in (_RIM_RAYS, _AROUND_RAYS))
    around = np.isfinite(outermost.radius) & beyond & ~beside
    # about the opening's own middle, where the map of rays is true to angles
    directions = outermost.grid.directions
    middle = directions[rays].mean(axis=0)
    axes = np.stack([*np.linalg.svd(middle[None])[2][1:], middle / np.linalg.norm(middle)])
    own = RayGrid(outermost.grid.centre, axes, 1.0, 1)
    every = max(1, np.count_nonzero(around) // _KNOTS)
    knots, radius = own.locate(directions[around]).T[::every], outermost.radius[around][::every]
    plate = RBFInterpolator(knots, radius, kernel="thin_plate_spline", smoothing=1.0)
    return np.asarray(plate(own.locate(directions[rays]).T))


def _disk(radius: float) -> NDArray[np.bool_]:
    """Round structuring element."""
    r = int(np.ceil(radius))
    v, u = np.mgrid[-r : r + 1, -r : r + 1]
    return np.hypot(u, v) <= radius + 0.5
