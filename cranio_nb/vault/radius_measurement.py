"""The vault around an opening, measured along rays: bone mask and opening come in -> a radius map goes out.

Frames: map (v, u) about the opening's direction, see `ray_grid`; radii in mm; the world in mm (LPS).
"""

from __future__ import annotations

import hashlib

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..errors import InputRefused
from ..geometry.robust import huber_weights, reweighted_fit, spread
from ..grid import touched, true_indices
from ..opening import Opening
from ..volume import Volume
from .ray_casting import expected_radius, surface_radii
from .ray_grid import RadiusMap, RayGrid

_STEP_DEG = 0.5  # between rays: 0.65 mm on the vault
_BESIDE_DEG = 42.0  # of vault measured beside the hole
_LARGEST_DEG = 115.0  # from the map's middle: further out the map tears
_SOUND = 0.85  # of the usual thickness: bone below it is a bevelled or thinned rim
_RIM_MM = 6.0  # beside a hole up to which bone may be its rim
_AROUND_MM = 20.0  # of bone beside the rim that gives the usual thickness
_FLAT_MM = 1e-3  # across the line of sight: an opening of less is a point
_ROUGH_MM = 1.0  # of voxels that would tell a surface as badly as a scan's blur and the bone's bumps do on any grid
_LEAST_RAYS = 12  # into a hole, and to bone beside it: some 2 mm across
_KEPT = 12  # maps of the newest openings, up to some MB each: a few heads at a few thresholds
_maps: dict[tuple[bytes, ...], RadiusMap] = {}  # by what they were measured in, the newest last


def measure_around(bone: Volume, opening: Opening) -> RadiusMap:
    """Measure the vault around an opening along rays from inside the head.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    opening : Opening

    Returns
    -------
    RadiusMap
        Centred on the opening, to about 55 mm beyond it. Its hole is the opening with its bevelled or thinned rim.
        Its arrays are read-only: methods and settings that are tried on one skull share it.

    Raises
    ------
    InputRefused
        ``NoHole`` where the opening is no hole with bone around it, seen from the head's centre.
    """
    # known by the voxels themselves: an array that was changed in between is another skull
    place = bone.affine.tobytes() + opening.head_centre.tobytes()
    asked = (_digest(bone.voxels), _digest(opening.sheet.voxels), place)
    found = _maps.pop(asked, None) or _measured(bone, opening)
    _maps[asked] = found
    for old in list(_maps)[:-_KEPT]:
        _maps.pop(old, None)  # another thread may have done so
    return found


def _digest(mask: NDArray[np.bool_]) -> bytes:
    """What tells a mask from others."""
    return repr(mask.shape).encode() + hashlib.blake2b(np.packbits(mask).tobytes()).digest()


def _measured(bone: Volume, opening: Opening) -> RadiusMap:
    """The map of `measure_around`."""
    # a grid that reaches beyond the opening on all sides
    axes = _axes(opening, bone)
    points = opening.sheet.to_world(true_indices(opening.sheet.voxels)) - opening.head_centre
    widest = np.degrees(np.arccos(np.clip(points @ axes[2] / np.linalg.norm(points, axis=1), -1, 1))).max()
    half = int(min(widest + _BESIDE_DEG, _LARGEST_DEG) / _STEP_DEG)
    grid = RayGrid(opening.head_centre, axes, np.radians(_STEP_DEG), 2 * half + 1)
    # the radii beside it, and where bone is missing
    hole = _rays_to(grid, points)
    typical = float(np.median(np.linalg.norm(points, axis=1)))
    outer, inner = _radii(bone, grid, hole, typical=typical, hidden=hole)
    seen = np.isfinite(outer)
    hole = _missing(outer - inner, hole, float(np.median(outer[seen]) * grid.step_rad)) if seen.any() else hole
    _check_hole(grid, hole, seen)
    for array in (outer, inner, hole):
        array.setflags(write=False)
    return RadiusMap(grid, outer=outer, inner=inner, hole=hole)


def measure_along(radius_map: RadiusMap, bone: Volume, *, min_width_mm: float = 4.0) -> RadiusMap:
    """Measure another skull, or the same one elsewhere, along the rays of a map.

    Parameters
    ----------
    radius_map : RadiusMap
        Of an opening in the first skull.
    bone : Volume
        Bool mask of the other skull.
    min_width_mm : float
        Narrower places without bone are its pinholes.

    Returns
    -------
    RadiusMap
        The same rays with the other skull's radii; its `hole` is where that skull lacks bone.
    """
    grid, typical = radius_map.grid, float(np.nanmedian(radius_map.outer))
    hidden = np.zeros_like(radius_map.hole)
    outer, inner = _radii(bone, grid, radius_map.hole, typical=typical, hidden=hidden)
    lacking = ndimage.binary_opening(np.isnan(outer), iterations=max(1, round(min_width_mm / 2 / radius_map.step_mm)))
    if lacking.any():
        lacking = _missing(outer - inner, lacking, float(np.nanmedian(outer) * grid.step_rad))
    return RadiusMap(grid, outer=outer, inner=inner, hole=lacking)


def firmness(radius_map: RadiusMap, bone: Volume) -> NDArray[np.float64]:
    """How well the mask tells the radii: the inverse variance of a rough surface that is known to a voxel.

    Parameters
    ----------
    radius_map : RadiusMap
    bone : Volume
        The mask that was measured.

    Returns
    -------
    ndarray, shape (M, M)
        1 along the voxels' short side, less across slices: a voxel's width w along a ray gives a variance of w^2 / 12,
        the scan's blur and the bone's own bumps as much as a voxel of 1 mm, on any grid.

    Examples
    --------
    Slices of 3 mm and pixels of 1 mm, looked at from below and from the side:

    >>> bone = Volume(np.zeros((2, 2, 2), bool), np.array([[0, 0, 1, 0], [0, 1, 0, 0], [3, 0, 0, 0], [0, 0, 0, 1.0]]))
    >>> rays = [RayGrid(np.zeros(3), np.roll(np.eye(3), by, axis=0), 0.1, n=1) for by in (0, 1)]
    >>> one = np.ones((1, 1))
    >>> maps = [RadiusMap(ray, outer=one, inner=one, hole=one > 1) for ray in rays]
    >>> [float(firmness(m, bone)[0, 0].round(3)) for m in maps]
    [0.2, 1.0]
    """
    width = np.linalg.norm(radius_map.grid.directions @ bone.edges.T, axis=-1)
    return (bone.spacing.min() ** 2 + _ROUGH_MM**2) / (width**2 + _ROUGH_MM**2)


def _check_hole(grid: RayGrid, hole: NDArray[np.bool_], seen: NDArray[np.bool_]) -> None:
    """Refuse an opening that rays do not see as a hole with bone around it."""
    if hole.sum() < _LEAST_RAYS:
        problem = "is no hole: the rays through it meet bone, or it is a few voxels"
    elif (seen & ~hole).sum() < _LEAST_RAYS:
        problem = "has no bone around it"
    elif (grid.directions[hole] @ grid.axes[2] <= 0).any():
        problem = "is wider than half the head"
    else:
        return
    raise _no_hole(problem)


def _no_hole(problem: str) -> InputRefused:
    """The refusal of an opening that is none."""
    message = f"Seen from inside the head the opening {problem}."
    return InputRefused("NoHole", message, "Give an opening as `find_openings` finds it; with planes, more of them.")


def _axes(opening: Opening, bone: Volume) -> NDArray[np.float64]:
    """Axes of the map: the middle points to the opening, v runs along its long side, u across it."""
    middle = opening.direction
    points = opening.sheet.to_world(true_indices(opening.sheet.voxels)[::7])
    flat = points - points.mean(axis=0)
    flat = flat - np.outer(flat @ middle, middle)
    if np.abs(flat).max() < _FLAT_MM:  # the place of the map's axes would hinge on rounding
        raise _no_hole("is no more than a few voxels")
    long_side = np.linalg.svd(flat, full_matrices=False)[2][0]
    long_side = long_side * (1.0 if long_side @ bone.edges[0] >= 0 else -1.0)
    return np.stack([np.cross(long_side, middle), long_side, middle])


def _rays_to(grid: RayGrid, points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """The rays that pass through an opening's sheet, given by points (n, 3) from the grid's centre."""
    return ndimage.binary_closing(touched(grid.locate(points).T, (grid.n, grid.n)), iterations=2)


def _radii(
    bone: Volume, grid: RayGrid, middle: NDArray[np.bool_], *, typical: float, hidden: NDArray[np.bool_]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Outer and inner radius along the rays, looked for best near the rays in `middle`."""
    degrees = ndimage.distance_transform_edt(~middle) * _STEP_DEG
    directions = grid.directions
    expected = expected_radius(bone, grid.centre, directions, typical=typical, degrees=degrees, hidden=hidden)
    return surface_radii(bone, grid.centre, directions, expected)


def _missing(thickness: NDArray[np.float64], opening: NDArray[np.bool_], step_mm: float) -> NDArray[np.bool_]:
    """The hole: rays of an opening without bone, and the bevelled or thinned rim beside them."""
    # no bone at all, but for the sutures beside it
    free = np.isnan(thickness)
    hole = free & ndimage.binary_dilation(opening, iterations=3)
    # a rim thinner than the sound bone around it
    away = ndimage.distance_transform_edt(~hole) * step_mm
    usual = _usual_thickness(thickness, (away > _RIM_MM) & (away < _RIM_MM + _AROUND_MM) & ~free)
    with np.errstate(invalid="ignore"):
        thin = (thickness < _SOUND * usual) & (away <= _RIM_MM)
    # what of that hangs together with the hole
    labels, _ = ndimage.label(hole | thin)
    kept = np.unique(labels[hole])
    return ndimage.binary_opening(np.isin(labels, kept[kept > 0]), iterations=2) | hole


def _usual_thickness(thickness: NDArray[np.float64], around: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Plane through the thickness of the sound bone around the hole, continued across it, shape (M, M), mm."""
    v, u = np.nonzero(around)
    if len(v) < 10:
        return np.full(thickness.shape, np.nanmedian(thickness))
    # thickness = a + b v + c u
    basis = np.stack([np.ones(len(v)), v, u], axis=1).astype(float)
    plane = reweighted_fit(
        basis, thickness[v, u], lambda off: huber_weights(off, spread(off) + 1e-6), start=np.ones(len(v)), n_iter=5
    )
    rows, cols = np.ogrid[: thickness.shape[0], : thickness.shape[1]]
    return plane[0] + plane[1] * rows + plane[2] * cols
