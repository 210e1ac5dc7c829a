"""Where the skull is open: a bone mask comes in -> the openings of its vault go out, largest first.

Frames: bone in voxel (plane, row, col); rays on a map (v, u) about the vertex; lengths in mm.

Rays run from a point inside the head to the vault. A ray that meets no bone leaves through an opening; rays that leave
side by side belong to the same one. Nothing has to be clicked.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..errors import InputRefused, NoOpening
from ..grid import inside_grid
from ..opening import Opening
from ..volume import Volume
from .head_frame import HeadFrame, find_head_frame
from .orientation import head_centre
from .ray_casting import FAR_MM, NEAR_MM
from .ray_grid import RayGrid, filled_from_nearest
from .thin_bone import Material
from .verdict import Signs, Verdict, judge

_STEP_DEG = 1.5  # degrees between rays: 2 mm on the vault
_SEARCHED_DEG = 102.0  # from the vertex down to which the vault is searched; further down lie orbits and base
_BESIDE_DEG = 10.0  # more, so that an opening can be followed over the border
_BASE_DEG = 88.0  # an opening that lies wholly further down is an orbit, an ear canal, the base
_BROW_DEG = 10.0  # by which the line between vault and base rises in front and falls behind
_SIDE_DEG = 90.0  # the vault proper, over which its radius is averaged
_SEEN = 0.75  # of the width of a small opening that is seen through, where rays cross a thick wall aslant
_SAMPLE_MM = 0.75  # along a ray
_EDGE_MM = 3.0  # a ray that leaves the image so far before its neighbours meet bone is not followed to the end
_MIDDLE = 0.7  # of the distance from the rim to the innermost ray
_ABOVE_MM, _BULGE = 2.0, 0.2  # by which bone may stand above the surface bridged from the rim; and for each mm to it
_WALL_MM = 16.0  # under the outer surface, beyond which bone is another wall


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
    def above_base(self) -> NDArray[np.bool_]:
        """Rays above the line between vault and base, which rises to the brow in front and falls to the nape behind.

        Returns
        -------
        ndarray of bool, shape (n, n)
        """
        v, _ = self.grid.offsets
        front = -v / np.maximum(self.grid.polar, 1e-9)
        return self.grid.polar <= np.radians(_BASE_DEG - _BROW_DEG * front) + 1e-9

    @property
    def typical_radius(self) -> float:
        """Median radius of the vault.

        Returns
        -------
        float
            mm.
        """
        return float(np.nanmedian(self.radius[self.within(_SIDE_DEG)]))


def find_openings(
    bone: Volume, *, scan: Volume | None = None, frame: HeadFrame | None = None, min_diameter_mm: float = 8.0
) -> tuple[Opening, ...]:
    """Find every opening of the vault.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    scan : Volume, optional
        HU on the same grid, which shows bone too thin for the threshold; a mask says no more than `bone`.
    frame : HeadFrame, optional
        How the head lies; found when not given.
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
    return tuple(
        one.opening
        for one in require_cut(survey_openings(bone, scan=scan, frame=frame, min_diameter_mm=min_diameter_mm))
    )


@dataclass(frozen=True, eq=False)
class JudgedOpening:
    """An opening with the verdict on it.

    Parameters
    ----------
    opening : Opening
    verdict : Verdict
    whole : bool
        Whether all of it lies inside the image.
    """

    opening: Opening
    verdict: Verdict
    whole: bool


def survey_openings(
    bone: Volume, *, scan: Volume | None = None, frame: HeadFrame | None = None, min_diameter_mm: float = 8.0
) -> tuple[JudgedOpening, ...]:
    """Find every opening, cut or natural, and judge it.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    scan : Volume, optional
        HU on the same grid, which shows bone too thin for the threshold; a mask says no more than `bone`.
    frame : HeadFrame, optional
        How the head lies; found when not given.
    min_diameter_mm : float
        Width of the smallest opening.

    Returns
    -------
    tuple of JudgedOpening
        Largest first.

    Raises
    ------
    InputRefused
        ``NoVault``.
    """
    frame = frame or find_head_frame(bone)
    outermost = measure_outermost_bone(bone, frame.trusted_axes)
    groups = open_rays(outermost, min_diameter_mm)
    if not groups:
        return ()
    radius = _bridged_radius(outermost, groups)
    material = Material.of(bone, scan, outermost.grid.centre, outermost.grid.directions[np.isfinite(outermost.radius)])
    judged = []
    for rays in groups:
        signs = _signs(bone, outermost, rays, radius, material, frame)
        opening = Opening(_sheet(bone, outermost.grid, rays, radius), outermost.grid.centre)
        surface = outermost.grid.centre + outermost.grid.directions[rays] * radius[rays][:, None]
        whole = outermost.followed[rays].all() and inside_grid(bone.to_voxel(surface), bone.shape).all()
        judged.append(JudgedOpening(opening, judge(signs), bool(whole)))
    return tuple(judged)


def require_cut(found: Sequence[JudgedOpening]) -> tuple[JudgedOpening, ...]:
    """The openings that are closed without being chosen: this decides whether a skull is intact.

    Parameters
    ----------
    found : sequence of JudgedOpening

    Returns
    -------
    tuple of JudgedOpening
        At least one, in the same order.

    Raises
    ------
    NoOpening
        ``NoOpening`` when none was cut for sure; the message says what is doubtful.
    InputRefused
        ``OpeningLeavesImage``.
    """
    cut = tuple(one for one in found if one.verdict.designed)
    if any(not one.whole for one in cut):
        raise InputRefused(
            "OpeningLeavesImage",
            "The opening of the skull reaches the edge of the image, so part of its rim is missing.",
            "Use a scan that covers the whole opening.",
        )
    if not cut:
        doubtful = [one for one in found if one.verdict.doubtful]
        reasons = "".join(f" Doubtful: {one.verdict.reason}" for one in doubtful)
        raise NoOpening("NoOpening", f"The vault of this skull has no opening; there is nothing to close.{reasons}")
    return cut


def measure_outermost_bone(bone: Volume, axes: NDArray[np.float64]) -> OutermostBone:
    """Measure the vault along rays about the vertex.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    axes : ndarray, shape (3, 3)
        Rows: the head's left, back and up, orthonormal, world.

    Returns
    -------
    OutermostBone
    """
    half = int(np.ceil((_SEARCHED_DEG + _BESIDE_DEG + 2) / _STEP_DEG))
    grid = RayGrid(head_centre(bone, axes), axes, np.radians(_STEP_DEG), 2 * half + 1)
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
    """
    # an opening has a core in which a disk of the smallest diameter fits; the core grows back to the rim
    reach = _SEEN * np.degrees(min_diameter_mm / 2 / outermost.typical_radius) / _STEP_DEG
    free = np.isnan(outermost.radius) & outermost.within(_SEARCHED_DEG + _BESIDE_DEG)
    core = (ndimage.distance_transform_edt(free) > reach) & outermost.within(_SEARCHED_DEG)
    grown = ndimage.binary_dilation(core, _disk(reach + 1), mask=free)
    labels, n_groups = ndimage.label(grown, np.ones((3, 3)))
    on_vault = outermost.above_base
    groups = []
    for rays in (labels == i for i in range(1, n_groups + 1)):
        if not (rays & core & on_vault).any():  # also a pocket beside the hole, without a core
            continue
        groups.append(rays)
    return sorted(groups, key=np.count_nonzero, reverse=True)


def _bridged_radius(outermost: OutermostBone, groups: list[NDArray[np.bool_]]) -> NDArray[np.float64]:
    """Radius of a membrane across the openings, shape (n, n), mm: harmonic between the rims."""
    radius = filled_from_nearest(outermost.radius)
    hole = np.logical_or.reduce(groups)
    for _ in range(200):
        radius[hole] = ndimage.uniform_filter(radius, 3)[hole]
    return radius


def _signs(
    bone: Volume,
    outermost: OutermostBone,
    rays: NDArray[np.bool_],
    radius: NDArray[np.float64],
    material: Material,
    frame: HeadFrame,
) -> Signs:
    """What an opening and its surroundings show."""
    grid, step_mm = outermost.grid, np.radians(_STEP_DEG) * outermost.typical_radius
    # bone in the middle of the opening, away from the blurred rim
    width = ndimage.distance_transform_edt(rays)
    middle = width >= _MIDDLE * width.max()
    above_mm = _ABOVE_MM + _BULGE * width.max() * step_mm
    across = material.thickness(grid.centre, grid.directions[middle], radius[middle], above_mm=above_mm)
    rim = ndimage.binary_dilation(rays, iterations=2) & np.isfinite(outermost.radius)
    # what stands along the rays of the rim, from the outer surface inwards
    depths = np.arange(-60.0, 1.5, 0.5)
    points = grid.centre + grid.directions[rim][:, None, :] * (outermost.radius[rim][:, None] + depths)[..., None]
    is_bone = bone.at(points, outside=False)
    return Signs(
        diameter_mm=2 * np.sqrt(rays.sum() / np.pi) * step_mm,
        across_mm=float(np.median(across)),
        on_vault=float(outermost.above_base[rays].mean()),
        two_walls=float(is_bone[:, depths < -_WALL_MM].any(axis=1).mean()),
        rim_mm=float(np.median(is_bone[:, depths >= -_WALL_MM].sum(axis=1) * 0.5)),
        frame=frame.confidence,
    )


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
