"""Where the skull is open: a bone mask comes in -> the openings of its vault go out, largest first.

Frames: bone in voxel (plane, row, col), directions and lengths in world mm (LPS).

The vault is looked at from a point inside the head. A ray that meets no bone leaves through an opening; rays that
leave side by side belong to the same one. Nothing has to be clicked.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..errors import InputRefused, NoOpening
from ..opening import Opening
from ..volume import Volume
from .ray_grid import extended

_EYE_DEPTH = 85.0  # mm below the vertex: above the skull base, and the whole vault is in sight
_STEP = 1.5  # degrees between rays: 2 mm on the vault
_SKY = 102.0  # degrees from the vertex down to which the vault is searched; further down lie orbits and base
_BASE = 88.0  # degrees: an opening that lies wholly further down is an orbit, an ear canal, the base
_EDGE = 3.0  # mm: a ray that leaves the image so far before its neighbours meet bone is not seen to the end
_THIN_RIM, _THIN_HOLE = 1.5, 30.0  # mm: a small hole whose rim is as thin as paper was not cut
_NEAR, _FAR = 25.0, 140.0  # mm from the eye between which the vault lies


@dataclass(frozen=True, eq=False)
class Sky:
    """The vault as seen from inside the head, on an azimuthal-equidistant chart about the vertex.

    Parameters
    ----------
    eye : ndarray, shape (3,)
        Where the rays start, world mm.
    directions : ndarray, shape (M, M, 3)
        Unit vector of each ray, LPS.
    radius : ndarray, shape (M, M)
        Distance to the outermost bone along the ray in mm; nan where there is none.
    seen : ndarray of bool, shape (M, M)
        Rays that stay in the image far enough to meet the vault.
    polar : ndarray, shape (M, M)
        Angle from the vertex, degrees.
    """

    eye: NDArray[np.float64]
    directions: NDArray[np.float64]
    radius: NDArray[np.float64]
    seen: NDArray[np.bool_]
    polar: NDArray[np.float64]


def find_openings(bone: Volume, *, min_diameter: float = 8.0) -> tuple[Opening, ...]:
    """Find every opening of the vault.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull; planes rise to the top of the head.
    min_diameter : float
        Smallest opening in mm across; sutures, vessels and pits of thin bone are narrower.

    Returns
    -------
    tuple of Opening
        Largest first.

    Raises
    ------
    NoOpening
        ``NoOpening`` when the vault is closed.
    InputRefused
        ``OpeningLeavesImage`` when an opening reaches the edge of the image, so that its rim is not all in sight;
        ``NoVault`` when the mask holds no skull vault.
    """
    sky = look(bone)
    parts = [part for part in openings(sky, min_diameter) if not _worn_through(bone, sky, part)]
    if not parts:
        raise NoOpening("NoOpening", "The vault of this skull has no opening; there is nothing to close.")
    radius = _bridge(sky, parts)
    return tuple(Opening(_sheet(bone, sky, part, radius), sky.eye) for part in parts)


def look(bone: Volume) -> Sky:
    """See the vault from inside the head.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    """
    eye = head_centre(bone)
    up, back, left = (bone.affine[:3, :3] / bone.spacing).T
    half = int(np.ceil((_SKY + 12) / _STEP))
    v, u = np.mgrid[-half : half + 1, -half : half + 1] * _STEP
    polar = np.hypot(u, v)
    azimuth, tilt = np.arctan2(v, u), np.radians(polar)
    flat = np.cos(azimuth)[..., None] * left + np.sin(azimuth)[..., None] * back
    directions = np.sin(tilt)[..., None] * flat + np.cos(tilt)[..., None] * up
    radius, seen = _cast(bone, eye, directions)
    return Sky(eye, directions, radius, seen, polar)


def head_centre(bone: Volume) -> NDArray[np.float64]:
    """A point on the head's axis about 85 mm below the vertex, shape (3,), world mm.

    Raises
    ------
    InputRefused
        ``NoVault`` when the mask spans less than a vault.
    """
    points = _thin_points(bone)  # along the grid's own axes: a rotated header moves the eye with the head
    no_vault = InputRefused(
        "NoVault", "The bone found does not span a skull vault (60 mm wanted each way).", "Is this a head CT?"
    )
    if not len(points):
        raise no_vault
    top = np.quantile(points[:, 0], 0.9995)
    vault = points[points[:, 0] > top - _EYE_DEPTH]
    low, high = np.quantile(vault[:, 1:], [0.005, 0.995], axis=0)
    if (high - low).min() < 60:
        raise no_vault
    return bone.to_world(np.array([top - _EYE_DEPTH, *(low + high) / 2]) / bone.spacing)


def openings(sky: Sky, min_diameter: float = 8.0) -> list[NDArray[np.bool_]]:
    """Sets of rays that leave through one opening each, as masks of the sky, largest first.

    Parameters
    ----------
    sky : Sky
    min_diameter : float
        Smallest opening in mm.
    """
    radius = float(np.nanmedian(sky.radius[sky.polar <= 90]))
    free = np.isnan(sky.radius) & (sky.polar <= _SKY + 10)
    reach = np.degrees(min_diameter / 2 / radius) / _STEP
    core = (ndimage.distance_transform_edt(free) > reach) & (sky.polar <= _SKY)
    grown = ndimage.binary_dilation(core, _disk(reach + 1), mask=free)
    labels, n_parts = ndimage.label(grown, np.ones((3, 3)))
    parts = []
    for part in (labels == i for i in range(1, n_parts + 1)):
        if np.min(sky.polar[part & core], initial=180.0) > _BASE:  # also a pocket beside the hole, without a core
            continue
        if not sky.seen[part].all():
            raise InputRefused(
                "OpeningLeavesImage",
                "The opening of the skull reaches the edge of the image, so part of its rim is missing.",
                "Use a scan that covers the whole opening.",
            )
        parts.append(part)
    return sorted(parts, key=np.count_nonzero, reverse=True)


def _thin_points(bone: Volume) -> NDArray[np.float64]:
    """Positions of a thinned-out set of bone voxels along the grid's axes (plane, row, col), shape (n, 3), mm."""
    step = np.maximum(1, np.round(2.0 / bone.spacing)).astype(int)
    coarse = bone.voxels[:: step[0], :: step[1], :: step[2]]
    return np.argwhere(coarse) * (step * bone.spacing)


def _cast(bone: Volume, eye: NDArray, directions: NDArray) -> tuple[NDArray, NDArray]:
    """Outermost bone along each ray (mm, nan for none) and whether the ray stays in the image to meet the vault."""
    lengths = np.arange(_NEAR, _FAR, 0.75)
    start = bone.to_voxel(eye)
    steps = directions.reshape(-1, 3) @ np.linalg.inv(bone.affine[:3, :3]).T
    radius: NDArray[np.float64] = np.full(len(steps), np.nan)
    last_seen: NDArray[np.float64] = np.zeros(len(steps))
    upper = np.array(bone.shape) - 0.5
    for length in lengths:
        at = start + length * steps
        inside = ((at >= -0.5) & (at < upper)).all(axis=1)
        last_seen[inside] = length
        plane, row, col = np.rint(at[inside]).astype(np.intp).T
        hit = np.flatnonzero(inside)[bone.voxels[plane, row, col]]
        radius[hit] = length
    shape = directions.shape[:2]
    radius, last_seen = radius.reshape(shape), last_seen.reshape(shape)
    return radius, last_seen >= extended(radius) - _EDGE


def _bridge(sky: Sky, parts: list[NDArray[np.bool_]]) -> NDArray[np.float64]:
    """Radius of a membrane across the openings, shape (M, M), mm: harmonic between the rims."""
    radius = extended(sky.radius)
    hole = np.logical_or.reduce(parts)
    for _ in range(200):
        radius[hole] = ndimage.uniform_filter(radius, 3)[hole]
    return radius


def _worn_through(bone: Volume, sky: Sky, part: NDArray[np.bool_]) -> bool:
    """Whether a small opening is a spot where thin bone fell below the threshold, rather than a cut one."""
    typical = float(np.nanmedian(sky.radius[sky.polar <= 90]))
    if 2 * np.sqrt(part.sum() / np.pi) * np.radians(_STEP) * typical > _THIN_HOLE:
        return False
    rim = ndimage.binary_dilation(part, iterations=2) & np.isfinite(sky.radius)
    depths = np.arange(-14.0, 1.5, 0.25)
    points = sky.eye + sky.directions[rim][:, None, :] * (sky.radius[rim][:, None] + depths)[..., None]
    index = np.clip(np.rint(bone.to_voxel(points)).astype(np.intp), 0, np.array(bone.shape) - 1)
    thickness = bone.voxels[tuple(np.moveaxis(index, -1, 0))].sum(axis=1) * 0.25
    return bool(np.median(thickness) < _THIN_RIM)


def _sheet(bone: Volume, sky: Sky, part: NDArray[np.bool_], radius: NDArray) -> Volume:
    """Voxels of a coarse sheet across one opening, about 4 mm thick."""
    grown = ndimage.zoom(part.astype(np.uint8), 3, order=0, grid_mode=True, mode="nearest").astype(bool)
    fine = [ndimage.zoom(a, 3, order=1, grid_mode=True, mode="nearest") for a in np.moveaxis(sky.directions, -1, 0)]
    directions = np.stack(fine, axis=-1)[grown]
    lengths = ndimage.zoom(radius, 3, order=1, grid_mode=True, mode="nearest")[grown]
    depths = np.arange(0.0, 4.5, 0.5)
    points = sky.eye + directions[:, None, :] * (lengths[:, None] - depths)[..., None]
    index = np.rint(bone.to_voxel(points.reshape(-1, 3))).astype(np.intp)
    index = index[((index >= 0) & (index < bone.shape)).all(axis=1)]
    voxels = np.zeros(bone.shape, bool)
    voxels[tuple(index.T)] = True
    return bone.with_voxels(voxels & ~bone.voxels)


def _disk(radius: float) -> NDArray[np.bool_]:
    """Round structuring element."""
    r = int(np.ceil(radius))
    v, u = np.mgrid[-r : r + 1, -r : r + 1]
    return np.hypot(u, v) <= radius + 0.5
