"""Where the skull is open: a bone mask comes in -> the openings of its vault go out, largest first.

Frames: bone in voxel (plane, row, col); rays on a map (v, u) about the vertex; lengths in mm.

Rays run from a point inside the head to the vault. A ray that meets no bone leaves through an opening; rays that leave
side by side belong to the same one. Nothing has to be clicked.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..errors import InputRefused, NoOpening
from ..grid import inside_grid
from ..opening import Opening
from ..volume import Volume
from .orientation import head_axes, head_centre
from .ray_casting import FAR_MM, NEAR_MM
from .ray_grid import RayGrid, filled_from_nearest

_STEP_DEG = 1.5  # degrees between rays: 2 mm on the vault
_SEARCHED_DEG = 102.0  # from the vertex down to which the vault is searched; further down lie orbits and base
_BESIDE_DEG = 10.0  # more, so that an opening can be followed over the border
_BASE_DEG = 88.0  # an opening that lies wholly further down is an orbit, an ear canal, the base
_SIDE_DEG = 90.0  # the vault proper, over which its radius is averaged
_SAMPLE_MM = 0.75  # along a ray
_EDGE_MM = 3.0  # a ray that leaves the image so far before its neighbours meet bone is not followed to the end
_THIN_RIM_MM, _THIN_HOLE_MM = 1.5, 30.0  # a small hole whose rim is as thin as paper was not cut


@dataclass(frozen=True, eq=False)
class OutermostBone:
    """The outermost bone along rays about the vertex.

    Parameters
    ----------
    grid : RayGrid
        n rays along each side; the middle one points to the vertex.
    radius : ndarray, shape (n, n)
        Distance to the outermost bone, mm; nan where there is none.
    followed : ndarray of bool, shape (n, n)
        Rays that stay in the image far enough to meet the vault.
    """

    grid: RayGrid
    radius: NDArray[np.float64]
    followed: NDArray[np.bool_]

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
    def typical_radius(self) -> float:
        """Median radius of the vault.

        Returns
        -------
        float
            mm.
        """
        return float(np.nanmedian(self.radius[self.within(_SIDE_DEG)]))


def find_openings(bone: Volume, *, min_diameter_mm: float = 8.0) -> tuple[Opening, ...]:
    """Find every opening of the vault.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull; planes rise to the top of the head.
    min_diameter_mm : float
        Width of the smallest opening; sutures, vessels and pits of thin bone are narrower.

    Returns
    -------
    tuple of Opening
        Largest first.

    Raises
    ------
    NoOpening
        ``NoOpening`` when the vault is closed.
    InputRefused
        ``OpeningLeavesImage`` when an opening reaches the edge of the image, so that part of its rim is missing;
        ``NoVault`` when the mask holds no skull vault.

    Examples
    --------
    >>> from data_synth import phantom_case
    >>> case = phantom_case("tiny", "multiple", 0)
    >>> len(find_openings(Volume(case.bone, case.affine)))
    3
    """
    outermost = measure_outermost_bone(bone)
    groups = [rays for rays in open_rays(outermost, min_diameter_mm) if not _is_thin_bone(bone, outermost, rays)]
    if not groups:
        raise NoOpening("NoOpening", "The vault of this skull has no opening; there is nothing to close.")
    radius = _bridged_radius(outermost, groups)
    return tuple(Opening(_sheet(bone, outermost.grid, rays, radius), outermost.grid.centre) for rays in groups)


def measure_outermost_bone(bone: Volume) -> OutermostBone:
    """Measure the vault along rays about the vertex.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.

    Returns
    -------
    OutermostBone
    """
    half = int(np.ceil((_SEARCHED_DEG + _BESIDE_DEG + 2) / _STEP_DEG))
    grid = RayGrid(head_centre(bone), head_axes(bone), np.radians(_STEP_DEG), 2 * half + 1)
    directions = grid.directions
    # outwards: the last bone met stays
    start, step = bone.to_voxel(grid.centre), bone.steps(directions)
    radius, last_inside = np.full(directions.shape[:2], np.nan), np.zeros(directions.shape[:2])
    for length in np.arange(NEAR_MM, FAR_MM, _SAMPLE_MM):
        index = start + length * step
        last_inside[inside_grid(index, bone.shape)] = length
        radius[bone.at_index(index, outside=False)] = length
    return OutermostBone(grid, radius, last_inside >= filled_from_nearest(radius) - _EDGE_MM)


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

    Raises
    ------
    InputRefused
        ``OpeningLeavesImage``.
    """
    # an opening has a core in which a disk of the smallest diameter fits; the core grows back to the rim
    reach = np.degrees(min_diameter_mm / 2 / outermost.typical_radius) / _STEP_DEG
    free = np.isnan(outermost.radius) & outermost.within(_SEARCHED_DEG + _BESIDE_DEG)
    core = (ndimage.distance_transform_edt(free) > reach) & outermost.within(_SEARCHED_DEG)
    grown = ndimage.binary_dilation(core, _disk(reach + 1), mask=free)
    labels, n_groups = ndimage.label(grown, np.ones((3, 3)))
    on_vault = outermost.within(_BASE_DEG)
    groups = []
    for rays in (labels == i for i in range(1, n_groups + 1)):
        if not (rays & core & on_vault).any():  # also a pocket beside the hole, without a core
            continue
        if not outermost.followed[rays].all():
            raise InputRefused(
                "OpeningLeavesImage",
                "The opening of the skull reaches the edge of the image, so part of its rim is missing.",
                "Use a scan that covers the whole opening.",
            )
        groups.append(rays)
    return sorted(groups, key=np.count_nonzero, reverse=True)


def _bridged_radius(outermost: OutermostBone, groups: list[NDArray[np.bool_]]) -> NDArray[np.float64]:
    """Radius of a membrane across the openings, shape (n, n), mm: harmonic between the rims."""
    radius = filled_from_nearest(outermost.radius)
    hole = np.logical_or.reduce(groups)
    for _ in range(200):
        radius[hole] = ndimage.uniform_filter(radius, 3)[hole]
    return radius


def _is_thin_bone(bone: Volume, outermost: OutermostBone, rays: NDArray[np.bool_]) -> bool:
    """Whether a small opening is a spot where thin bone fell below the threshold, rather than a cut one."""
    diameter = 2 * np.sqrt(rays.sum() / np.pi) * np.radians(_STEP_DEG) * outermost.typical_radius
    if diameter > _THIN_HOLE_MM:
        return False
    rim = ndimage.binary_dilation(rays, iterations=2) & np.isfinite(outermost.radius)
    # how much bone lies on the rays of the rim
    depths = np.arange(-14.0, 1.5, 0.25)
    lengths = (outermost.radius[rim][:, None] + depths)[..., None]
    points = outermost.grid.centre + outermost.grid.directions[rim][:, None, :] * lengths
    thickness = bone.at(points, outside=False).sum(axis=1) * 0.25
    return bool(np.median(thickness) < _THIN_RIM_MM)


def _sheet(bone: Volume, grid: RayGrid, rays: NDArray[np.bool_], radius: NDArray[np.float64]) -> Volume:
    """Voxels of a coarse sheet across one opening, about 4 mm thick."""
    # three rays for one: they lie closer than the voxels of any scan
    grown = ndimage.zoom(rays.astype(np.uint8), 3, order=0, grid_mode=True, mode="nearest").astype(bool)
    directions, lengths = (
        np.stack([ndimage.zoom(a, 3, order=1, grid_mode=True, mode="nearest") for a in values], axis=-1)[grown]
        for values in (np.moveaxis(grid.directions, -1, 0), [radius])
    )
    depths = np.arange(0.0, 4.5, 0.5)
    points = grid.centre + directions[:, None, :] * (lengths - depths)[..., None]
    index = bone.to_voxel(points.reshape(-1, 3))
    index = np.rint(index[inside_grid(index, bone.shape)]).astype(np.intp)
    voxels = np.zeros(bone.shape, bool)
    voxels[tuple(index.T)] = True
    return bone.with_voxels(voxels & ~bone.voxels)


def _disk(radius: float) -> NDArray[np.bool_]:
    """Round structuring element."""
    r = int(np.ceil(radius))
    v, u = np.mgrid[-r : r + 1, -r : r + 1]
    return np.hypot(u, v) <= radius + 0.5
