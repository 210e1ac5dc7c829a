"""Where the skull is open: a bone mask comes in -> the openings of its vault go out, largest first.

Frames: bone in voxel (plane, row, col); rays on a map (v, u) about the vertex; lengths in mm.

Rays run from a point inside the head to the vault. A ray that meets no bone leaves through an opening; rays that leave
side by side belong to the same one. Nothing has to be clicked.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..grid import box_around, touched
from ..opening import Opening
from ..volume import Volume
from .head_frame import HeadFrame, find_head_frame
from .opening_choice import JudgedOpening, choose_openings
from .outermost_bone import (
    STEP_DEG,
    OutermostBone,
    hinted_rays,
    measure_outermost_bone,
    measured_again,
    open_rays,
    room_in_image,
    vertex_rays,
)
from .ray_grid import filled_from_nearest
from .smallest_hole import LEAST_MM, THICK_MM, smallest_hole_mm
from .thin_bone import SOFT_HU, Material
from .verdict import Signs, judge

_MIDDLE, _BLUR_MM = 0.7, 4.0  # of the distance from the rim to the innermost ray; from the rim, in which it is blurred
_ABOVE_MM, _BULGE = 2.0, 0.2  # by which bone may stand above the surface bridged from the rim; and for each mm to it
_AROUND_MM = 12.0  # of the sheet of an opening: as thick as the vault is
_WALL_MM = 16.0  # under the outer surface, beyond which bone is another wall


def find_openings(
    bone: Volume, *, scan: Volume | None = None, frame: HeadFrame | None = None, min_diameter_mm: float = LEAST_MM
) -> tuple[Opening, ...]:
    """Find every opening of the vault that was cut.

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
    found = survey_openings(bone, scan=scan, frame=frame, min_diameter_mm=min_diameter_mm)
    return tuple(one.opening for one in choose_openings(found, smallest_mm=smallest_hole_mm(float(bone.spacing.max()))))


def survey_openings(
    bone: Volume, *, scan: Volume | None = None, frame: HeadFrame | None = None, min_diameter_mm: float = LEAST_MM
) -> tuple[JudgedOpening, ...]:
    """Find every opening, cut or natural, and judge it.

    Parameters
    ----------
    bone, scan, frame, min_diameter_mm
        As for `find_openings`.

    Returns
    -------
    tuple of JudgedOpening
        Largest first, numbered from 1; after them those of which a scan gives no more than a hint, all doubtful.

    Raises
    ------
    InputRefused
        ``NoVault``.

    Examples
    --------
    >>> from data_synth import phantom_case
    >>> case = phantom_case("tiny", "bilateral", 0)
    >>> [(one.number, one.verdict.kind) for one in survey_openings(Volume(case.bone, case.affine))]
    [(1, 'cut'), (2, 'cut')]
    """
    frame = frame or find_head_frame(bone)
    grid = vertex_rays(bone, frame.trusted_axes)
    outermost = measure_outermost_bone(bone, grid)
    groups = open_rays(outermost, min_diameter_mm)
    unfilled = unfilled_bone(bone, scan)
    seen = outermost if unfilled is bone else measured_again(outermost, unfilled)
    across_voxel_mm = float(np.linalg.norm(bone.spacing))
    hints = hinted_rays(seen, groups, min_diameter_mm, blurred=across_voxel_mm >= THICK_MM)
    judged: list[JudgedOpening] = []
    for some, mask, rays_of, plain in ((groups, bone, outermost, True), (hints, unfilled, seen, False)):
        if not some:
            continue
        radius = _bridged_radius(rays_of, some)
        met = rays_of.grid.directions[np.isfinite(rays_of.radius)]
        material = Material.of(mask, scan, rays_of.grid.centre, met)
        for rays in some:
            verdict = judge(replace(_signs(mask, rays_of, rays, radius, material, frame), plain=plain))
            if plain or verdict.kind == "doubtful":
                opening = Opening(_sheet(mask, rays_of, rays, radius), rays_of.grid.centre, frame.ray_axes)
                judged.append(JudgedOpening(len(judged) + 1, opening, verdict, room_in_image(rays_of, rays)))
    return tuple(judged)


def unfilled_bone(bone: Volume, scan: Volume | None) -> Volume:
    """The bone without the pores of its slices that were filled: where a slice cuts the vault flat, a hole is one.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    scan : Volume or None
        HU or a bool mask on the same grid; without one the bone is taken as it is.

    Returns
    -------
    Volume
        Bool mask.
    """
    if scan is None:
        return bone
    # only where there is bone
    box, kept = bone.box(), np.zeros(bone.shape, bool)
    solid = scan.voxels[box]
    np.logical_and(bone.voxels[box], solid if solid.dtype == bool else solid >= int(SOFT_HU), out=kept[box])
    return bone.with_voxels(kept)


def bone_around(bone: Volume, scan: Volume, openings: Sequence[Opening]) -> Volume:
    """The bone that a method gets: an opening that was filled as a pore, where a slice cuts it flat, is open there.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    scan : Volume
        HU or a bool mask on the same grid.
    openings : sequence of Opening
        Those to close.

    Returns
    -------
    Volume
        Bool mask; the same one where no such opening is closed.
    """
    filled = [opening.sheet for opening in openings if _meets(opening, bone)]
    if not filled:
        return bone
    voxels, unfilled = bone.voxels.copy(), unfilled_bone(bone, scan)
    for sheet in filled:
        box = sheet.box(margin=np.ceil(_AROUND_MM / sheet.spacing))
        voxels[box] = unfilled.voxels[box]
    return bone.with_voxels(voxels)


def _meets(opening: Opening, bone: Volume) -> bool:
    """Whether the sheet of an opening lies in bone: seldom, for it keeps out of the bone it was found in."""
    planes = slice(*opening.planes)
    return bool((opening.sheet.voxels[planes] & bone.voxels[planes]).any())


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
    grid, step_mm = outermost.grid, np.radians(STEP_DEG) * outermost.typical_radius
    # bone in the opening away from the blurred rim, of most of it: a drain that crosses it is no bone
    width, blur_mm = ndimage.distance_transform_edt(rays), max(_BLUR_MM, float(bone.spacing.max()))
    middle = width >= min(_MIDDLE * width.max(), blur_mm / step_mm)
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
        covered=float((across > 0).mean()),
        with_hu=material.volume.voxels.dtype != bool,
    )


def _sheet(bone: Volume, outermost: OutermostBone, rays: NDArray[np.bool_], radius: NDArray[np.float64]) -> Volume:
    """Voxels of a coarse sheet across one opening, about 4 mm thick; at the edge of the image where it is outside."""
    grid, radius = outermost.grid, np.minimum(radius, outermost.seen)
    # three rays for one: they lie closer than the voxels of any scan; one ray beside them is enough to find their place
    (sides,) = ndimage.find_objects(rays.astype(np.uint8))
    near = tuple(slice(max(side.start - 1, 0), side.stop + 1) for side in sides)
    grown = ndimage.zoom(rays[near].astype(np.uint8), 3, order=0, grid_mode=True, mode="nearest").astype(bool)
    directions, lengths = (
        np.stack([ndimage.zoom(a[near], 3, order=1, grid_mode=True, mode="nearest") for a in values], axis=-1)[grown]
        for values in (np.moveaxis(grid.directions, -1, 0), [radius])
    )
    depths = np.arange(0.0, 4.5, 0.5)
    points = grid.centre + directions[:, None, :] * (lengths - depths)[..., None]
    index = bone.to_voxel(points.reshape(-1, 3))
    # memory that is never written to takes no room: the rest of the volume stays as it was made
    voxels, box = touched(index, bone.shape), box_around(index, bone.shape, margin=1)
    voxels[box] &= ~bone.voxels[box]
    return bone.with_voxels(voxels)
