"""The vault around a lesion as two radius maps: a bone mask and a lesion come in -> a chart goes out, and back again.

Frames: chart (v, u), an azimuthal-equidistant map of the directions seen from a point inside the head, about the
lesion's direction; radii in mm along those directions; the world in mm (LPS).

On the chart the outer and the inner surface of the vault are single-valued, the hole is a region, and a prosthesis is
a pair of radii per direction. Distances on it are true along lines through its middle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from .prosthesis import Lesion
from .volume import Volume

_STEP = 0.5  # degrees between rays: 0.65 mm on the vault
_BESIDE = 42.0  # degrees of vault looked at beside the hole
_LARGEST = 115.0  # degrees from the chart's middle: further out the chart tears
_DEPTH, _HEIGHT = 16.0, 12.0  # mm below and above the expected outer surface where the vault is looked for
_SAMPLE = 0.4  # mm along a ray
_FAR_APART = 1.5  # mm between planes above which their stairs would show
_BREAK = 3.0  # mm without bone along a ray that is still diploe


@dataclass(frozen=True, eq=False)
class RadialChart:
    """Radius maps of the vault around a lesion.

    Parameters
    ----------
    eye : ndarray, shape (3,)
        Where the rays start, world mm.
    axes : ndarray, shape (3, 3)
        Rows: unit vectors of u, v and of the chart's middle, world.
    step : float
        Radians between neighbouring rays.
    outer, inner : ndarray, shape (M, M)
        Radii of the two surfaces of the vault, mm; nan where a ray meets none.
    hole : ndarray of bool, shape (M, M)
        Directions in which bone is missing: the lesion with its bevelled or worn rim.
    """

    eye: NDArray[np.float64]
    axes: NDArray[np.float64]
    step: float
    outer: NDArray[np.float64]
    inner: NDArray[np.float64]
    hole: NDArray[np.bool_]

    @property
    def directions(self) -> NDArray[np.float64]:
        """Unit vector of each ray, shape (M, M, 3), world."""
        return _directions(len(self.outer), self.step, self.axes)

    @property
    def mm(self) -> float:
        """Distance between neighbouring rays on the vault, mm."""
        return float(np.nanmedian(self.outer) * self.step)

    def locate(self, directions: NDArray[np.float64]) -> NDArray[np.float64]:
        """Fractional chart indices (v, u) of directions of any length, shape (2, ...)."""
        x, y, z = np.moveaxis(directions @ self.axes.T, -1, 0)
        flat = np.hypot(x, y)
        scale = np.arctan2(flat, z) / np.maximum(flat, 1e-12) / self.step
        return np.stack([y * scale, x * scale]) + (len(self.outer) - 1) / 2


def look(bone: Volume, lesion: Lesion) -> RadialChart:
    """Measure the vault around a lesion along rays from inside the head.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    lesion : Lesion

    Returns
    -------
    RadialChart
        Centred on the lesion, reaching about 55 mm beyond it.
    """
    axes = _axes(lesion, bone)
    step = np.radians(_STEP)
    points = lesion.opening.to_world(np.argwhere(lesion.opening.voxels)) - lesion.head_centre
    widest = np.degrees(np.arccos(np.clip(points @ axes[2] / np.linalg.norm(points, axis=1), -1, 1))).max()
    half = int(min(widest + _BESIDE, _LARGEST) / _STEP)
    blank = np.full((2 * half + 1,) * 2, np.nan)
    chart = RadialChart(lesion.head_centre, axes, step, blank, blank, np.zeros(blank.shape, bool))
    opening, level = _opening_on(chart, points)
    expected = _expected_radius(bone, chart, opening, level)
    inner, outer = walls(bone, chart.eye, chart.directions, expected)
    chart = RadialChart(lesion.head_centre, axes, step, outer, inner, opening)
    return RadialChart(lesion.head_centre, axes, step, outer, inner, _missing(chart))


def voxelise(
    chart: RadialChart, outer: NDArray[np.float64], inner: NDArray[np.float64], bone: Volume
) -> NDArray[np.bool_]:
    """Voxels between two radius maps inside the chart's hole, off the bone.

    Parameters
    ----------
    chart : RadialChart
    outer, inner : ndarray, shape (M, M)
        Radii of the prosthesis in mm; nan outside it.
    bone : Volume
        Bool mask; the result is on its grid.

    Returns
    -------
    ndarray of bool, shape (P, R, C)
    """
    filled = np.isfinite(outer) & np.isfinite(inner)
    region = ndimage.binary_dilation(filled & chart.hole, iterations=max(1, round(1.0 / chart.mm)))
    spread = [_extended(np.where(filled, radius, np.nan)) for radius in (outer, inner)]
    beside = ~chart.hole  # what reaches over the rim ends with the bone's own surface: no flap lies on the bone
    spread[0][beside] = np.fmin(spread[0], chart.outer)[beside]
    spread[1][beside] = np.fmax(spread[1], chart.inner)[beside]
    directions = chart.directions[region]
    ends = np.concatenate([chart.eye + directions * radius[region][:, None] for radius in spread])
    index = bone.to_voxel(ends)
    low = np.maximum(np.floor(index.min(axis=0)).astype(int) - 1, 0)
    high = np.minimum(np.ceil(index.max(axis=0)).astype(int) + 2, bone.shape)
    box = (slice(low[0], high[0]), slice(low[1], high[1]), slice(low[2], high[2]))
    patch = np.zeros(bone.shape, bool)
    patch[box] = _between(chart, spread, region, bone.crop(box)) & ~bone.voxels[box]
    return patch


def thickened(chart: RadialChart, outer: NDArray[np.float64], inner: NDArray[np.float64]) -> tuple[NDArray, NDArray]:
    """Radius maps moved apart about their middle where they lie closer than sound bone near the hole ever does.

    Parameters
    ----------
    chart : RadialChart
    outer, inner : ndarray, shape (M, M)
        Radii of the prosthesis in mm; nan outside it.

    Returns
    -------
    outer, inner : ndarray, shape (M, M)
        At least as far apart as the thinnest tenth of the bone within 20 mm of the hole.
    """
    away = ndimage.distance_transform_edt(~chart.hole) * chart.mm
    near = (away > 0) & (away <= 20)
    least = float(np.nanquantile((chart.outer - chart.inner)[near], 0.1))
    short = np.maximum(least - (outer - inner), 0.0) / 2
    return outer + short, inner - short


def _between(chart: RadialChart, spread: list[NDArray], region: NDArray, box: Volume) -> NDArray[np.bool_]:
    """Voxels of a box whose direction lies in the region and whose radius lies between the two maps."""
    inside = np.zeros(box.shape, bool)
    planes = np.stack(np.meshgrid(*[np.arange(n, dtype=float) for n in box.shape[1:]], indexing="ij"), axis=-1)
    for plane in range(box.shape[0]):
        away = box.to_world(np.insert(planes, 0, plane, axis=-1)) - chart.eye
        radius = np.linalg.norm(away, axis=-1)
        at = chart.locate(away)
        near = np.rint(at).astype(np.intp)
        seen = np.logical_and.reduce((near >= 0) & (near < len(region)))
        seen[seen] = region[near[0][seen], near[1][seen]]
        upper, lower = (ndimage.map_coordinates(r, at[:, seen], order=1, mode="nearest") for r in spread)
        inside[plane][seen] = (radius[seen] <= upper) & (radius[seen] >= lower)
    return inside


def _axes(lesion: Lesion, bone: Volume) -> NDArray[np.float64]:
    """Chart axes: the middle looks at the lesion, v runs along its long side, u across it."""
    middle = lesion.direction
    points = lesion.opening.to_world(np.argwhere(lesion.opening.voxels)[::7])
    flat = points - points.mean(axis=0)
    flat = flat - np.outer(flat @ middle, middle)
    long_side = np.linalg.svd(flat, full_matrices=False)[2][0]
    up = bone.affine[:3, 0]
    long_side = long_side * (1.0 if long_side @ up >= 0 else -1.0)
    return np.stack([np.cross(long_side, middle), long_side, middle])


def _directions(n: int, step: float, axes: NDArray) -> NDArray[np.float64]:
    """Unit vectors of an azimuthal-equidistant chart, shape (n, n, 3)."""
    v, u = np.mgrid[:n, :n] * step - (n - 1) / 2 * step
    angle = np.hypot(u, v)
    scale = np.sinc(angle / np.pi)  # sin(angle) / angle
    return np.stack([u * scale, v * scale, np.cos(angle)], axis=-1) @ axes


def _opening_on(chart: RadialChart, points: NDArray) -> tuple[NDArray[np.bool_], float]:
    """The lesion's sheet on the chart, and its typical outer radius in mm."""
    v, u = np.rint(chart.locate(points)).astype(np.intp)
    opening = np.zeros(chart.outer.shape, bool)
    inside = (v >= 0) & (v < len(opening)) & (u >= 0) & (u < len(opening))
    opening[v[inside], u[inside]] = True
    return ndimage.binary_closing(opening, iterations=2), float(np.median(np.linalg.norm(points, axis=1)))


def _expected_radius(bone: Volume, chart: RadialChart, opening: NDArray, level: float) -> NDArray[np.float64]:
    """Where the outer surface is to be expected: a smooth robust fit to the outermost bone of a coarse look."""
    skip = 4
    directions = chart.directions[::skip, ::skip]
    lengths = np.arange(level - 35, level + 30, 1.0)
    bone_at = _sample(bone, chart.eye, directions, lengths)
    last = bone_at.shape[-1] - 1 - bone_at[..., ::-1].argmax(axis=-1)
    outermost = np.where(bone_at.any(axis=-1), lengths[last], np.nan)
    outermost[opening[::skip, ::skip]] = np.nan
    v, u = np.indices(chart.outer.shape) / (len(chart.outer) - 1) * 2 - 1
    near = ndimage.distance_transform_edt(~opening)[::skip, ::skip] * _STEP
    weight = np.exp(-((near / 25.0) ** 2))
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


def walls(
    bone: Volume, eye: NDArray[np.float64], directions: NDArray[np.float64], expected: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Inner and outer radius, shape (...), mm, of the run of bone nearest to `expected` on each ray; nan for none.

    Rays start at `eye` (3,), world mm, along unit vectors `directions` (..., 3); `expected` (...) is the radius of the
    outer surface, roughly: the run is looked for from 16 mm below to 12 mm above it.
    """
    rays, level = directions.reshape(-1, 3), expected.ravel()
    field, box = _field(bone, eye, rays[::8], level[::8])
    offsets = np.arange(-_DEPTH, _HEIGHT, _SAMPLE)
    radii = np.full((2, len(rays)), np.nan)
    step = rays @ np.linalg.inv(box.affine[:3, :3]).T
    start = box.to_voxel(eye)
    for some in np.array_split(np.arange(len(rays)), len(rays) // 500 + 1):
        at = start[:, None, None] + step[some].T[..., None] * (level[some, None] + offsets)
        values = ndimage.map_coordinates(field, at, order=1, mode="constant", cval=0.0)
        radii[:, some] = _nearest_run(values, offsets)
    inner, outer = radii + level
    return inner.reshape(expected.shape), outer.reshape(expected.shape)


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


def _missing(chart: RadialChart, *, full: float = 0.85, worn: float = 6.0) -> NDArray[np.bool_]:
    """The hole: rays of the opening without bone, and beside them up to `worn` mm of rim below `full` thickness."""
    thickness = chart.outer - chart.inner
    free = np.isnan(thickness)
    hole = free & ndimage.binary_dilation(chart.hole, iterations=3)  # not the sutures beside it
    away = ndimage.distance_transform_edt(~hole) * chart.mm
    usual = _usual_thickness(thickness, (away > worn) & (away < worn + 20) & ~free)
    with np.errstate(invalid="ignore"):
        thin = (thickness < full * usual) & (away <= worn)
    labels, _ = ndimage.label(hole | thin)
    kept = np.unique(labels[hole])
    return ndimage.binary_opening(np.isin(labels, kept[kept > 0]), iterations=2) | hole


def _usual_thickness(thickness: NDArray[np.float64], around: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Plane through the thickness of the sound bone around the hole, continued across it, shape (M, M), mm."""
    v, u = np.nonzero(around)
    if len(v) < 10:
        return np.full(thickness.shape, np.nanmedian(thickness))
    basis = np.stack([np.ones(len(v)), v, u], axis=1)
    values = thickness[v, u]
    weight = np.ones(len(v))
    for _ in range(5):
        plane = np.linalg.lstsq(basis * weight[:, None], values * weight, rcond=None)[0]
        residual = np.abs(values - basis @ plane)
        weight = 1 / np.maximum(1, residual / (1.4826 * np.median(residual) + 1e-6))
    rows, cols = np.ogrid[: thickness.shape[0], : thickness.shape[1]]
    return plane[0] + plane[1] * rows + plane[2] * cols


def _extended(radius: NDArray[np.float64]) -> NDArray[np.float64]:
    """Radius map with its unknown parts filled from the nearest known ray."""
    nearest = ndimage.distance_transform_edt(np.isnan(radius), return_distances=False, return_indices=True)
    return radius[tuple(nearest)]
