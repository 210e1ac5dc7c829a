"""Where rays from inside the head enter and leave the vault: a bone mask and directions come in -> radii go out.

Frames: directions are unit vectors in the world (LPS) on a map (v, u); radii and lengths in mm from the eye.

First a coarse look tells where the outer surface is to be expected; then each ray is sampled about there, and the run
of bone nearest to the expected surface is the vault. Scalp plates, the other side of the head and the skull base, all
further away, are not mistaken for it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..volume import Volume

_DEPTH, _HEIGHT = 16.0, 12.0  # mm below and above the expected outer surface where the vault is looked for
_SAMPLE = 0.4  # mm along a ray
_FAR_APART = 1.5  # mm between planes above which their stairs would show
_BREAK = 3.0  # mm without bone along a ray that is still diploe


def expected_radius(
    bone: Volume,
    eye: NDArray[np.float64],
    directions: NDArray[np.float64],
    level: float,
    degrees: NDArray[np.float64],
    hidden: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Where the outer surface is to be expected: a smooth robust fit to the outermost bone of a coarse look.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    eye : ndarray, shape (3,)
        Where the rays start, world mm.
    directions : ndarray, shape (M, M, 3)
    level : float
        A typical outer radius, mm.
    degrees : ndarray, shape (M, M)
        How far each ray is from where the fit matters most.
    hidden : ndarray of bool, shape (M, M)
        Rays that count for nothing.

    Returns
    -------
    ndarray, shape (M, M)
    """
    skip = 4
    lengths = np.arange(level - 35, level + 30, 1.0)
    bone_at = _sample(bone, eye, directions[::skip, ::skip], lengths)
    last = bone_at.shape[-1] - 1 - bone_at[..., ::-1].argmax(axis=-1)
    outermost = np.where(bone_at.any(axis=-1), lengths[last], np.nan)
    outermost[hidden[::skip, ::skip]] = np.nan
    v, u = np.indices(hidden.shape) / (len(hidden) - 1) * 2 - 1
    weight = np.exp(-((degrees[::skip, ::skip] / 25.0) ** 2))
    return _robust_surface(v[::skip, ::skip], u[::skip, ::skip], outermost, weight)(v, u)


def _robust_surface(v: NDArray, u: NDArray, values: NDArray, weight: NDArray):
    """Fourth-order polynomial in (v, u) fitted with outliers down-weighted, as a function."""
    powers = [(i, j) for i in range(5) for j in range(5 - i)]
    known = np.isfinite(values)
    basis = np.stack([v[known] ** i * u[known] ** j for i, j in powers], axis=-1)
    target, base = values[known], np.sqrt(weight[known])
    weights = base
    for _ in range(8):
        system = np.concatenate([basis * weights[:, None], 1e-3 * np.eye(len(powers))])
        c = np.linalg.lstsq(system, np.concatenate([target * weights, np.zeros(len(powers))]), rcond=None)[0]
        residual = np.abs(target - basis @ c)
        weights = base / (1 + (residual / 4.0) ** 2)
    return lambda v, u: sum(k * v**i * u**j for k, (i, j) in zip(c, powers, strict=True))


def _sample(bone: Volume, eye: NDArray, directions: NDArray, lengths: NDArray) -> NDArray[np.bool_]:
    """Whether the nearest voxel is bone at lengths (n,) or (..., n) along directions (..., 3), shape (..., n)."""
    step = directions @ np.linalg.inv(bone.affine[:3, :3]).T
    start = bone.to_voxel(eye)
    index = [np.rint(start[i] + step[..., i, None] * lengths).astype(np.int32) for i in range(3)]
    inside = np.logical_and.reduce([(k >= 0) & (k < n) for k, n in zip(index, bone.shape, strict=True)])
    return bone.voxels[tuple(np.where(inside, k, 0) for k in index)] & inside


def cast(
    bone: Volume, eye: NDArray[np.float64], directions: NDArray[np.float64], expected: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Inner and outer radius of the run of bone nearest to the expected outer surface.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    eye : ndarray, shape (3,)
    directions : ndarray, shape (..., 3)
    expected : ndarray, shape (...)

    Returns
    -------
    inner, outer : ndarray, shape (...)
        mm; nan where a ray meets no bone.
    """
    rays, level = directions.reshape(-1, 3), expected.ravel()
    field, box = _field(bone, eye, rays[::8], level[::8])
    offsets = np.arange(-_DEPTH, _HEIGHT, _SAMPLE)
    radii = np.full((2, len(rays)), np.nan)
    step = rays @ np.linalg.inv(box.affine[:3, :3]).T
    start = box.to_voxel(eye)
    for some in np.array_split(np.arange(len(rays)), len(rays) // 250 + 1):
        at = start[:, None, None] + step[some].T[..., None] * (level[some, None] + offsets)
        values = ndimage.map_coordinates(field, at, order=1, mode="constant", cval=0.0)
        radii[:, some] = _nearest_run(values, offsets)
    inner, outer = (radii + level).reshape(2, *expected.shape)
    return inner, outer


def _field(bone: Volume, eye: NDArray, rays: NDArray, level: NDArray) -> tuple[NDArray[np.float32], Volume]:
    """The bone around the ends of rays as a field with its surface at 0.5, and the box it fills."""
    ends = np.concatenate([eye + rays * (level + d)[:, None] for d in (-_DEPTH, _HEIGHT)])
    index = bone.to_voxel(ends)
    low = np.clip(np.floor(index.min(axis=0)).astype(int) - 2, 0, np.array(bone.shape) - 1)
    high = np.clip(np.ceil(index.max(axis=0)).astype(int) + 3, low + 1, bone.shape)
    box = bone.crop((slice(low[0], high[0]), slice(low[1], high[1]), slice(low[2], high[2])))
    far_apart = bone.spacing[0] > _FAR_APART
    return (_plane_distances(box.voxels) if far_apart else box.voxels.astype(np.float32)), box


def _plane_distances(mask: NDArray[np.bool_], reach: float = 8.0) -> NDArray[np.float32]:
    """In each plane 0.5 + signed distance to the mask's edge in px, bounded by `reach`; in empty planes below 0.

    Between far-apart planes 0 and 1 would blend into stairs (shape-based interpolation, Raya and Udupa 1990).
    """
    field = np.full(mask.shape, 0.5 - reach, np.float32)
    for plane in np.flatnonzero(mask.any(axis=(1, 2))):
        inside = ndimage.distance_transform_edt(np.pad(mask[plane], 1))[1:-1, 1:-1]
        outside = ndimage.distance_transform_edt(~mask[plane])
        field[plane] = np.clip(inside - outside, -reach, reach) + np.where(mask[plane], 0.0, 1.0)
    return field


def _nearest_run(values: NDArray, offsets: NDArray) -> tuple[NDArray, NDArray]:
    """Offsets where the run of bone nearest to 0 begins and ends on each ray, between samples; short breaks join."""
    n = len(offsets)
    index = np.arange(n)
    bone = values > 0.5
    breaks = int(_BREAK / _SAMPLE)
    none = -(10**6)
    before = np.maximum.accumulate(np.where(bone, index, none), axis=1)
    before = np.concatenate([np.full((len(bone), 1), none), before[:, :-1]], axis=1)
    begins = bone & (index - before > breaks)
    after = np.minimum.accumulate(np.where(bone, index, -none)[:, ::-1], axis=1)[:, ::-1]
    after = np.concatenate([after[:, 1:], np.full((len(bone), 1), -none)], axis=1)
    finishes = bone & (after - index > breaks)
    last = np.abs(np.where(finishes, offsets, np.inf)).argmin(axis=1)
    first = np.where(begins & (index <= last[:, None]), index, -1).max(axis=1)
    rays = np.arange(len(bone))
    empty = ~bone.any(axis=1)
    inner = _crossing(values, offsets, rays, first, -1)
    outer = _crossing(values, offsets, rays, last, +1)
    return np.where(empty, np.nan, inner), np.where(empty, np.nan, outer)


def _crossing(values: NDArray, offsets: NDArray, rays: NDArray, at: NDArray, side: int) -> NDArray[np.float64]:
    """Where the field passes 0.5 between a bone sample and its neighbour on one side."""
    beside = np.clip(at + side, 0, len(offsets) - 1)
    here, there = values[rays, at], values[rays, beside]
    t = np.clip((here - 0.5) / np.maximum(here - there, 1e-6), 0, 1)
    return offsets[at] + t * side * _SAMPLE * (beside != at)
