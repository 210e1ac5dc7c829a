"""Where rays from inside the head enter and leave the vault: a bone mask and directions come in -> radii go out.

Frames: directions are unit vectors in the world (LPS) on a map (v, u); radii and lengths in mm from where rays start.

A coarse pass first says where the outer surface is to be expected; then each ray is sampled about there, and the run
of bone nearest to the expected surface is the vault. Scalp plates, the other side of the head and the skull base, all
further away, are not mistaken for it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..geometry.robust import cauchy_weights, reweighted_fit
from ..geometry.slice_distance import plane_distances
from ..grid import box_around
from ..volume import Volume

NEAR_MM, FAR_MM = 25.0, 140.0
"""Radii from the head's centre between which the vault lies, mm."""
_DEPTH_MM, _HEIGHT_MM = 16.0, 12.0  # below and above the expected outer surface where the vault is looked for
_SAMPLE_MM = 0.4  # along a ray
_FAR_APART_MM = 1.5  # between planes above which their stairs would show
_BREAK_MM = 3.0  # without bone along a ray that is still diploe
_BOUND_PX = 8.0  # up to which distances to an edge in a plane are told apart
_EVERY = 4  # rays of the map from one that the coarse pass follows to the next
_STRAY_MM = 4.0  # off the fit by which an outermost voxel counts half
_FADE_DEG = 25.0  # from where the fit matters most to where a ray counts a third


def expected_radius(
    bone: Volume,
    centre: NDArray[np.float64],
    directions: NDArray[np.float64],
    *,
    typical: float,
    degrees: NDArray[np.float64],
    hidden: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Where the outer surface is to be expected: a smooth robust fit to the outermost bone of a coarse pass.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    centre : ndarray, shape (3,)
        Where the rays start, world mm.
    directions : ndarray, shape (M, M, 3)
        Unit vectors, world.
    typical : float
        A typical outer radius, mm.
    degrees : ndarray, shape (M, M)
        How far each ray is from where the fit matters most.
    hidden : ndarray of bool, shape (M, M)
        Rays that count for nothing.

    Returns
    -------
    ndarray, shape (M, M)
        mm.
    """
    some = np.s_[::_EVERY, ::_EVERY]
    outermost = np.where(hidden[some], np.nan, _outermost_bone(bone, centre, directions[some], typical))
    # terms v^i u^j with i + j <= 4 of a surface through it
    powers = [(i, j) for i in range(5) for j in range(5 - i)]
    v, u = np.indices(hidden.shape) / (len(hidden) - 1) * 2 - 1
    known = np.isfinite(outermost)
    basis = np.stack([v[some][known] ** i * u[some][known] ** j for i, j in powers], axis=-1)
    # most faithful where it matters most, outliers down-weighted
    base = np.sqrt(np.exp(-((degrees[some] / _FADE_DEG) ** 2))[known])
    c = reweighted_fit(
        basis,
        outermost[known],
        lambda residuals: cauchy_weights(residuals, _STRAY_MM, times=base),
        start=base,
        n_iter=8,
        ridge=1e-3,
    )
    return np.sum([k * v**i * u**j for k, (i, j) in zip(c, powers, strict=True)], axis=0)


def _outermost_bone(bone: Volume, centre: NDArray, directions: NDArray, typical: float) -> NDArray[np.float64]:
    """Radius of the last bone along each ray, about a typical one, mm; nan where it meets none."""
    lengths = np.arange(typical - 35, typical + 30, 1.0)
    steps = bone.steps(directions)[..., None, :]
    is_bone = bone.at_index(bone.to_voxel(centre) + steps * lengths[:, None], outside=False)
    last = is_bone.shape[-1] - 1 - is_bone[..., ::-1].argmax(axis=-1)
    return np.where(is_bone.any(axis=-1), lengths[last], np.nan)


def surface_radii(
    bone: Volume, centre: NDArray[np.float64], directions: NDArray[np.float64], expected: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Outer and inner radius of the run of bone nearest to the expected outer surface.

    Parameters
    ----------
    bone, centre
        As for `expected_radius`.
    directions : ndarray, shape (..., 3)
        Unit vectors, world.
    expected : ndarray, shape (...)
        Radius of the expected outer surface, mm.

    Returns
    -------
    outer, inner : ndarray, shape (...)
        mm, between voxels; nan where a ray meets no bone.
    """
    # samples about the expected surface, a few hundred rays at a time
    rays, level = directions.reshape(-1, 3), expected.ravel()
    field = _field(bone, centre, rays[::8], level[::8])
    offsets = np.arange(-_DEPTH_MM, _HEIGHT_MM, _SAMPLE_MM)
    radii = np.full((2, len(rays)), np.nan)
    start, step = field.to_voxel(centre), field.steps(rays)
    for some in np.array_split(np.arange(len(rays)), len(rays) // 250 + 1):
        at = start[:, None, None] + step[some].T[..., None] * (level[some, None] + offsets)
        values = ndimage.map_coordinates(field.voxels, at, order=1, mode="constant", cval=0.0)
        radii[:, some] = _nearest_run(values, offsets)
    outer, inner = (radii + level).reshape(2, *expected.shape)
    return outer, inner


def _field(bone: Volume, centre: NDArray, rays: NDArray, level: NDArray) -> Volume:
    """The bone around the ends of rays as a field with its surface at 0.5."""
    ends = np.concatenate([centre + rays * (level + d)[:, None] for d in (-_DEPTH_MM, _HEIGHT_MM)])
    part = bone.crop(box_around(bone.to_voxel(ends), bone.shape, margin=2))
    if bone.spacing[0] <= _FAR_APART_MM:
        return Volume(part.voxels.astype(np.float32), part.affine)
    # distances to the edge in each plane, px: 1 on its inside and 0 on its outside; bone ends with the box
    mask = np.pad(part.voxels, ((0, 0), (1, 1), (1, 1)))
    field = (plane_distances(mask, _BOUND_PX) + np.where(mask, 0.0, 1.0))[:, 1:-1, 1:-1]
    field[~part.voxels.any(axis=(1, 2))] = 0.5 - _BOUND_PX
    return Volume(field.astype(np.float32), part.affine)


def _nearest_run(values: NDArray, offsets: NDArray) -> tuple[NDArray, NDArray]:
    """Offsets where the run of bone nearest to 0 ends and begins on each ray, between samples; short breaks join."""
    n = len(offsets)
    index = np.arange(n)
    bone = values > 0.5
    breaks = int(_BREAK_MM / _SAMPLE_MM)
    none = -(10**6)
    # a run begins at bone that has none before it within a break, and ends where none follows
    before = np.maximum.accumulate(np.where(bone, index, none), axis=1)
    before = np.concatenate([np.full((len(bone), 1), none), before[:, :-1]], axis=1)
    begins = bone & (index - before > breaks)
    after = np.minimum.accumulate(np.where(bone, index, -none)[:, ::-1], axis=1)[:, ::-1]
    after = np.concatenate([after[:, 1:], np.full((len(bone), 1), -none)], axis=1)
    finishes = bone & (after - index > breaks)
    # the run that ends nearest to the expected surface
    last = np.abs(np.where(finishes, offsets, np.inf)).argmin(axis=1)
    first = np.where(begins & (index <= last[:, None]), index, -1).max(axis=1)
    rays = np.arange(len(bone))
    empty = ~bone.any(axis=1)
    inner = _crossing(values, offsets, rays, first, -1)
    outer = _crossing(values, offsets, rays, last, +1)
    return np.where(empty, np.nan, outer), np.where(empty, np.nan, inner)


def _crossing(values: NDArray, offsets: NDArray, rays: NDArray, at: NDArray, side: int) -> NDArray[np.float64]:
    """Where the field passes 0.5 between a bone sample and its neighbour on one side."""
    beside = np.clip(at + side, 0, len(offsets) - 1)
    here, there = values[rays, at], values[rays, beside]
    t = np.clip((here - 0.5) / np.maximum(here - there, 1e-6), 0, 1)
    return offsets[at] + t * side * _SAMPLE_MM * (beside != at)
