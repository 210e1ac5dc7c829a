"""The vault around an opening as two radius maps: bone mask and opening in, chart out, and back again.

Frames: chart (v, u), an azimuthal-equidistant map of the directions seen from a point inside the head, about the
opening's direction; radii in mm along those directions; the world in mm (LPS).

On the chart the outer and the inner surface of the vault are single-valued, the hole is a region, and a prosthesis is
a pair of radii per direction. Distances on it are true along lines through its middle.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..opening import Opening
from ..volume import Volume
from . import ray_casting
from .ray_grid import extended

_STEP = 0.5  # degrees between rays: 0.65 mm on the vault
_BESIDE = 42.0  # degrees of vault looked at beside the hole
_LARGEST = 115.0  # degrees from the chart's middle: further out the chart tears
_FILM = 0.75  # mm on the bone beside a hole that nobody would build


@dataclass(frozen=True, eq=False)
class RadialChart:
    """Radius maps of the vault around an opening.

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
        Directions in which bone is missing: the opening with its bevelled or worn rim.
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


def look(bone: Volume, opening: Opening) -> RadialChart:
    """Measure the vault around an opening along rays from inside the head.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    opening : Opening

    Returns
    -------
    RadialChart
        Centred on the opening, reaching about 55 mm beyond it.
    """
    axes = _axes(opening, bone)
    step = np.radians(_STEP)
    points = opening.sheet.to_world(np.argwhere(opening.sheet.voxels)) - opening.head_centre
    widest = np.degrees(np.arccos(np.clip(points @ axes[2] / np.linalg.norm(points, axis=1), -1, 1))).max()
    half = int(min(widest + _BESIDE, _LARGEST) / _STEP)
    blank = np.full((2 * half + 1,) * 2, np.nan)
    chart = RadialChart(opening.head_centre, axes, step, blank, blank, np.zeros(blank.shape, bool))
    hole, level = _opening_on(chart, points)
    inner, outer = _radii(bone, chart, hole, level, hidden=hole)
    chart = RadialChart(opening.head_centre, axes, step, outer, inner, hole)
    return RadialChart(opening.head_centre, axes, step, outer, inner, _missing(chart))


def along(chart: RadialChart, bone: Volume, *, least: float = 4.0) -> RadialChart:
    """Measure another skull, or the same one elsewhere, along the rays of a chart.

    Parameters
    ----------
    chart : RadialChart
        Of an opening in the first skull.
    bone : Volume
        Bool mask of the other skull.
    least : float
        mm across: narrower places without bone are its pinholes.

    Returns
    -------
    RadialChart
        The same rays with the other skull's radii; its `hole` is where that skull lacks bone.
    """
    level = float(np.nanmedian(chart.outer))
    inner, outer = _radii(bone, chart, chart.hole, level, hidden=np.zeros_like(chart.hole))
    lacking = ndimage.binary_opening(np.isnan(outer), iterations=max(1, round(least / 2 / chart.mm)))
    other = RadialChart(chart.eye, chart.axes, chart.step, outer, inner, lacking)
    return replace(other, hole=_missing(other)) if lacking.any() else other


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
    spread = [extended(np.where(filled, radius, np.nan)) for radius in (outer, inner)]
    # what reaches over the rim ends with the bone's own surface: no flap and no film lies on the bone
    outside = ~chart.hole | _level(spread[0] - chart.outer)
    inside = ~chart.hole | _level(chart.inner - spread[1])
    spread[0][outside] = np.fmin(spread[0], chart.outer)[outside]
    spread[1][inside] = np.fmax(spread[1], chart.inner)[inside]
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


def _level(step: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Where a prosthesis rises so little above the bone that this bone is whole; a worn rim is a real step down."""
    return ~ndimage.binary_opening(ndimage.median_filter(np.nan_to_num(step, nan=np.inf), 5) >= _FILM, iterations=2)


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


def _axes(opening: Opening, bone: Volume) -> NDArray[np.float64]:
    """Chart axes: the middle looks at the opening, v runs along its long side, u across it."""
    middle = opening.direction
    points = opening.sheet.to_world(np.argwhere(opening.sheet.voxels)[::7])
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
    """The opening's sheet on the chart, and its typical outer radius in mm."""
    v, u = np.rint(chart.locate(points)).astype(np.intp)
    opening = np.zeros(chart.outer.shape, bool)
    inside = (v >= 0) & (v < len(opening)) & (u >= 0) & (u < len(opening))
    opening[v[inside], u[inside]] = True
    return ndimage.binary_closing(opening, iterations=2), float(np.median(np.linalg.norm(points, axis=1)))


def _radii(bone: Volume, chart: RadialChart, middle: NDArray, level: float, *, hidden: NDArray) -> tuple:
    """Inner and outer radius along the chart's rays, looked for best near the rays in `middle`."""
    degrees = ndimage.distance_transform_edt(~middle) * _STEP
    directions = chart.directions
    expected = ray_casting.expected_radius(bone, chart.eye, directions, level, degrees, hidden)
    return ray_casting.cast(bone, chart.eye, directions, expected)


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
