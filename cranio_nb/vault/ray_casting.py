"""Where rays from inside the head enter and leave the vault: a bone mask and directions come in -> radii go out.

Frames: directions are unit vectors in the world (LPS) on a map (v, u); radii and lengths in mm from where rays start.

A coarse pass first says where the outer surface is to be expected; then each ray is sampled about there, and the run
of bone nearest to the expected surface is the vault. Scalp plates, the other side of the head and the skull base, all
further away, are not mistaken for it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..geometry.robust import cauchy_weights, reweighted_fit
from ..geometry.side_by_side import side_by_side
from ..geometry.slice_distance import plane_distances
from ..grid import box_around
from ..volume import Volume

NEAR_MM, FAR_MM = 25.0, 140.0
"""Radii from the head's centre between which the vault lies, mm."""
_DEPTH_MM, _HEIGHT_MM = 16.0, 12.0  # below and above the expected outer surface where the vault is looked for
_SAMPLE_MM = 0.4  # along a ray
_FAR_APART_MM = 1.5  # between planes above which their stairs would show
_BREAK_MM = 3.0  # without bone along a ray that is still diploe
_FREE, _BONE, _NEITHER = 0, 1, 2  # what the corners of a cell have in common
_BOUND_PX = 8.0  # up to which distances to an edge in a plane are told apart
_AT_ONCE = 1000  # rays sampled at once: their samples stay in the cache
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
    rays, level = directions.reshape(-1, 3), expected.ravel()
    field = _field(bone, centre, rays[::8], level[::8])
    offsets = np.arange(-_DEPTH_MM, _HEIGHT_MM, _SAMPLE_MM)
    cells, start, step = _cells(field.voxels), field.to_voxel(centre), field.steps(rays).T
    last, first = np.empty((2, len(rays)), np.int16)
    met = np.empty(len(rays), bool)

    def sample(some: NDArray[np.intp]) -> None:
        """Sample some rays about the expected surface."""
        at = start[:, None, None] + step[:, some, None] * (level[some, None] + offsets)
        in_bone = _is_bone(field.voxels, cells, at)
        last[some], first[some] = _nearest_run(in_bone, offsets)
        met[some] = in_bone.any(axis=1)

    side_by_side(sample, np.array_split(np.arange(len(rays)), len(rays) // _AT_ONCE + 1))

    def place(sample: NDArray[np.int16]) -> NDArray[np.float64]:
        """One sample of each ray, as an index into the field."""
        return start[:, None] + step * (level + offsets[sample])

    ends = [_crossing(field.voxels, place, offsets, *end) for end in ((last, +1), (first, -1))]
    radii = np.where(met, ends, np.nan) + level
    outer, inner = radii.reshape(2, *expected.shape)
    return outer, inner


def _field(bone: Volume, centre: NDArray, rays: NDArray, level: NDArray) -> Volume:
    """The bone around the ends of rays as a field with its surface at 0.5."""
    ends = np.concatenate([centre + rays * (level + d)[:, None] for d in (-_DEPTH_MM, _HEIGHT_MM)])
    part = bone.crop(box_around(bone.to_voxel(ends), bone.shape, margin=2))
    if bone.spacing[0] <= _FAR_APART_MM:
        return Volume(part.voxels.view(np.uint8), part.affine)
    # distances to the edge in each plane, px: 1 on its inside and 0 on its outside; bone ends with the box
    mask = np.pad(part.voxels, ((0, 0), (1, 1), (1, 1)))
    field = (plane_distances(mask, _BOUND_PX) + np.where(mask, 0.0, 1.0))[:, 1:-1, 1:-1]
    field[~part.voxels.any(axis=(1, 2))] = 0.5 - _BOUND_PX
    return Volume(field.astype(np.float32), part.affine)


def _cells(field: NDArray) -> NDArray[np.uint8]:
    """What the cubes between eight neighbours of a field are: bone, free of it, or neither; those beyond it neither."""
    cells = np.full([n + 1 for n in field.shape], _NEITHER, np.uint8)
    # two planes at a time, which stay in the processor's cache
    bone, free = _agree(field[0] > 0.5), _agree(field[0] < 0.5)
    for plane, own in zip(field[1:], cells[1:-1, 1:-1, 1:-1], strict=True):
        next_bone, next_free = _agree(plane > 0.5), _agree(plane < 0.5)
        own[bone & next_bone] = _BONE
        own[free & next_free] = _FREE
        bone, free = next_bone, next_free
    return cells


def _agree(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Whether the four pixels around each corner of a plane, the outermost left out, are all true."""
    rows = mask[:-1] & mask[1:]
    return rows[:, :-1] & rows[:, 1:]


def _is_bone(field: NDArray, cells: NDArray[np.uint8], at: NDArray) -> NDArray[np.bool_]:
    """Whether a field is above 0.5 at places (3, ...): between neighbours that agree without interpolation."""
    corner = np.floor(at).astype(np.int32)
    corner += 1
    for index, n in zip(corner, field.shape, strict=True):
        np.clip(index, 0, n, out=index)
    # one number for each place in the array is looked up faster than three
    plane, row, col = corner
    cell = cells.ravel()[(plane * cells.shape[1] + row) * cells.shape[2] + col]
    bone, neither = cell == _BONE, cell == _NEITHER
    bone[neither] = _sampled(field, at[:, neither]) > 0.5
    return bone


def _sampled(field: NDArray, at: NDArray) -> NDArray[np.float32]:
    """A field between its voxels; 0 beyond them."""
    return np.asarray(ndimage.map_coordinates(field, at, order=1, mode="constant", cval=0.0, output=np.float32))


def _nearest_run(bone: NDArray[np.bool_], offsets: NDArray) -> tuple[NDArray, NDArray]:
    """The last and the first sample of the run of bone nearest to 0 on each ray.

    Short breaks join.
    """
    n = len(offsets)
    index = np.arange(n, dtype=np.int16)
    breaks = int(_BREAK_MM / _SAMPLE_MM)
    none = np.int16(-10_000)
    # a run begins at bone that has none before it within a break, and ends where none follows
    before = np.maximum.accumulate(np.where(bone, index, none), axis=1)
    before = np.concatenate([np.full((len(bone), 1), none, np.int16), before[:, :-1]], axis=1)
    begins = bone & (index - before > breaks)
    after = np.minimum.accumulate(np.where(bone, index, -none)[:, ::-1], axis=1)[:, ::-1]
    after = np.concatenate([after[:, 1:], np.full((len(bone), 1), -none, np.int16)], axis=1)
    finishes = bone & (after - index > breaks)
    # the run that ends nearest to the expected surface
    last = np.abs(np.where(finishes, offsets, np.inf)).argmin(axis=1)
    first = np.where(begins & (index <= last[:, None]), index, np.int16(-1)).max(axis=1)
    return last, first


def _crossing(
    field: NDArray, place: Callable[[NDArray], NDArray], offsets: NDArray, end: NDArray, side: int
) -> NDArray[np.float64]:
    """Offset where a field passes 0.5 between a bone sample of each ray and its neighbour on one side."""
    beside = np.clip(end + side, 0, len(offsets) - 1)
    here, there = (_sampled(field, place(sample)) for sample in (end, beside))
    t = np.clip((here - 0.5) / np.maximum(here - there, 1e-6), 0, 1)
    return np.asarray(offsets[end] + t * side * _SAMPLE_MM * (beside != end))
