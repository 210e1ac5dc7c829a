"""The paper's method: every slice bridged by two balloons, the slices stacked into a patch.

Bone mask in, `Prosthesis` out. Source: the VISAPP 2011 paper, doi 10.5220/0003356601370142.

Faithful is `design(bone, **paper_options(bone))`: axial slices, skeleton and convex hull, tangent lines, the constant
pressure, 21 snaxels, the hull for slices of partial loss. The defaults are ours: slices cut across the short side of
the hole, features seen along rays from the head's axis, tangents from arcs and shared between neighbouring slices,
a start curve and a pressure that follow from the end tangents (`curves.spiral`).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from .. import __version__, balloon, features, fill, lesion, rays, slicing, surface
from ..curves import ChordFrame, GapEnds, Points, cubic, spiral
from ..errors import NoOpening
from ..prosthesis import Lesion, Prosthesis
from ..volume import Volume

_ANGLE_STEP = 0.005  # radians between rays: 0.4 mm on the vault
_SIDE = 0.9  # radians of bone looked at on each side of the opening


@dataclass(frozen=True, eq=False)
class SliceResult:
    """One slice of the design.

    Parameters
    ----------
    plane : int
        Index on the slice grid.
    status : {"balloon", "hull", "carried", "skipped"}
        How the slice was filled. "carried": from its neighbours. "skipped": not at all.
    reason : str
        Why it was not bridged by its own balloon.
    ends : tuple of GapEnds
        Outer and inner gap ends, slice px; empty unless status is "balloon".
    start, curves : ndarray, shape (2, n, 2)
        Outer and inner start and final curve, slice (row, col) px; empty for "hull".
    values : dict
        theta0, theta1 (degrees), length (px), n_iter, converged: lists [outer, inner].
    """

    plane: int
    status: str
    reason: str = ""
    ends: tuple[GapEnds, ...] = ()
    start: Points = field(default_factory=lambda: np.empty((0, 0, 2)))
    curves: Points = field(default_factory=lambda: np.empty((0, 0, 2)))
    values: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class SlicedDesign:
    """What the method did for one lesion, slice by slice; for pictures, tables and lessons.

    Parameters
    ----------
    grid : Volume
        Bone on the slice grid; its planes are the slices.
    opening : Volume
        The lesion's sheet on the slice grid.
    patch : Volume
        Patch on the slice grid.
    slices : tuple of SliceResult
    """

    grid: Volume
    opening: Volume
    patch: Volume
    slices: tuple[SliceResult, ...]


def paper_options(bone: Volume) -> dict[str, Any]:
    """Options of `design` as the paper sets them, for a given grid (10 boundary points are 10 pixels)."""
    px = float(bone.spacing[1:].mean())
    return {
        "axial": True,
        "skeleton": True,
        "skip": features.PAPER_SKIP * px,
        "reach": 10.0 * px,
        "pressure": balloon.PAPER_PRESSURE,
        "n_snaxels": 21,
        "coupling": 0.0,
        "smooth": False,
    }


def design(
    bone: Volume,
    lesions: Sequence[Lesion] | None = None,
    *,
    axial: bool = False,
    skeleton: bool = False,
    skip: float = 2.0,
    reach: float = 12.0,
    pressure: float | None = None,
    n_snaxels: int = 41,
    tension: float = 1.0,
    rigidity: float = 1.0,
    dt: float = 1.0,
    tol: float = 1e-3,
    max_iter: int = 2000,
    coupling: float = 6.0,
    smooth: bool = True,
    progress: Callable[[str, float], None] | None = None,
) -> Prosthesis:
    """Design a prosthesis slice by slice.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull, planes rising to the top of the head.
    lesions : sequence of Lesion, optional
        Openings to close; found automatically when not given.
    axial : bool
        Cut along the planes of the scan, as the paper does. Otherwise across the short side of each opening.
    skeleton : bool
        Features by skeleton and convex hull, as the paper does. Otherwise along rays from the head's axis.
    skip, reach : float
        Boundary left out next to the gap, and fitted after that, mm of arc length.
    pressure : float, optional
        Constant k, px per index squared, outward positive. When not given, k follows from the end tangents.
    n_snaxels : int
        Points of a balloon, ends included.
    tension, rigidity, dt, tol, max_iter
        As for `balloon.inflate`.
    coupling : float
        Standard deviation in mm over which tangents are shared between neighbouring slices; 0 for none.
    smooth : bool
        Surface without stairs (see `surface.extract`).
    progress : callable, optional
        Called with (stage, fraction done).

    Returns
    -------
    Prosthesis
        `record["slices"]` holds one entry per slice: status, reason, angles, lengths, iterations, convergence.

    Raises
    ------
    NoOpening
        When the vault is closed, or no slice of the opening could be bridged.
    """
    options = {k: v for k, v in locals().items() if k not in ("bone", "lesions", "progress")}
    tell = progress or (lambda stage, done: None)
    began = time.perf_counter()
    lesions = lesion.find(bone) if lesions is None else lesions
    sliced = []
    for i, one in enumerate(lesions):
        tell("slices", i / len(lesions))
        sliced.append(bridge(bone, one, **{k: v for k, v in options.items() if k != "smooth"}))
    pieces = [_onto(part, bone, one) for part, one in zip(sliced, lesions, strict=True)]
    patch = bone.with_voxels(np.logical_or.reduce(pieces))
    if not patch.voxels.any():
        raise NoOpening(
            "NothingBridged", "No slice of the opening could be bridged.", "Try another slicing or threshold."
        )
    tell("surface", 0.9)
    mesh = surface.extract(patch, smooth=smooth)
    sides = surface.face_sides(mesh, bone, lesions[0].head_centre)
    record = {
        "version": __version__,
        "seconds": time.perf_counter() - began,
        "slices": [_entry(i, s) for i, part in enumerate(sliced) for s in part.slices],
    }
    return Prosthesis(mesh, sides, patch, "slicewise", options, record, tuple(sliced))


def bridge(
    bone: Volume,
    lesion: Lesion,
    *,
    axial: bool,
    skeleton: bool,
    skip: float,
    reach: float,
    pressure: float | None,
    n_snaxels: int,
    coupling: float,
    **scheme: Any,
) -> SlicedDesign:
    """Bridge one lesion slice by slice; parameters as for `design`.

    Returns
    -------
    SlicedDesign
    """
    grid, opening = _slice_grid(bone, lesion, axial)
    px = float(grid.spacing[1:].mean())
    centre = grid.to_voxel(lesion.head_centre)[1:]
    if skeleton:
        results = _by_skeleton(grid, opening, skip / px, reach / px)
    else:
        results = _by_rays(grid, opening, centre, skip / px, reach / px, coupling / float(grid.spacing[0]))
    results = _inflate(results, centre, n_snaxels, pressure, scheme)
    results = _carry(results)
    patch = np.zeros(grid.shape, bool)
    near = ndimage.binary_dilation(opening.voxels.any(axis=0), iterations=int(np.ceil(3 / px)))
    for s in results:
        if s.status == "hull":
            patch[s.plane] = fill.partial_loss(grid.voxels[s.plane], min_area=4 / px**2, region=near)
        elif s.curves.size:
            patch[s.plane] = fill.patch(s.curves[0], s.curves[1], grid.voxels[s.plane])
    return SlicedDesign(grid, opening, grid.with_voxels(patch), tuple(results))


def _slice_grid(bone: Volume, lesion: Lesion, axial: bool) -> tuple[Volume, Volume]:
    """Bone and opening on the grid whose planes are the slices to work on."""
    if not axial:
        grid = slicing.cut(bone, lesion, slicing.best_axes(lesion))
        opening = slicing.resample(lesion.opening, grid.affine, grid.shape) > 0.3
        return grid, grid.with_voxels(opening)
    first, end = lesion.planes
    box = (slice(max(first - 2, 0), min(end + 2, bone.shape[0])), slice(None), slice(None))
    return bone.crop(box), lesion.opening.crop(box)


def _by_skeleton(grid: Volume, opening: Volume, skip: float, reach: float) -> list[SliceResult]:
    """Gap ends of every slice by skeleton and hull."""
    results = []
    for plane in range(grid.shape[0]):
        try:
            seen = features.slice_features(grid.voxels[plane])
            if seen.closed:
                results.append(SliceResult(plane, "hull", "closed ring"))
                continue
            ends = features.gap_ends(seen, opening.voxels[plane], skip=skip, reach=reach)
            results.append(SliceResult(plane, "balloon", ends=ends))
        except features.SliceProblem as problem:
            results.append(SliceResult(plane, "skipped", problem.message))
    return results


def _by_rays(
    grid: Volume, opening: Volume, centre: NDArray, skip: float, reach: float, coupling: float
) -> list[SliceResult]:
    """Gap ends of every slice along rays, tangents shared between neighbours."""
    _, row, col = np.nonzero(opening.voxels)
    angle = np.arctan2(col - centre[1], centre[0] - row)
    angles = np.arange(angle.min() - _SIDE, angle.max() + _SIDE, _ANGLE_STEP)
    profile = rays.look(grid.voxels, centre, angles, px=float(grid.spacing[1]))
    gap = rays.find_gaps(profile, opening.voxels, px=float(grid.spacing[1]), apart=float(grid.spacing[0]))
    rims = rays.fit_rims(profile, gap, skip=skip, reach=reach)
    tangents = rays.share_tangents(rims.tangents, coupling)
    results = []
    for plane in np.flatnonzero(gap[:, 0] >= 0):
        if np.isfinite(tangents[plane]).all():
            ends = tuple(GapEnds(rims.points[plane, b], tangents[plane, b]) for b in (0, 1))
            results.append(SliceResult(int(plane), "balloon", ends=ends))
        else:
            results.append(SliceResult(int(plane), "skipped", "too little bone beside the gap to fit a tangent to"))
    return results


def _inflate(
    results: list[SliceResult], inside: NDArray, n: int, pressure: float | None, scheme: dict[str, Any]
) -> list[SliceResult]:
    """Relax the balloons of all slices together and put the curves into the results."""
    own = [i for i, s in enumerate(results) if s.status == "balloon"]
    if not own:
        return results
    gaps = [results[i].ends for i in own]
    frames = [[ChordFrame.of(ends, inside) for ends in pair] for pair in gaps]
    angles = np.array(
        [[f.end_angles(e) for f, e in zip(*pair, strict=True)] for pair in zip(frames, gaps, strict=True)]
    )
    length = np.array([[f.length for f in pair] for pair in frames])
    start, slopes, push = _initial(length, angles[..., 0], angles[..., 1], n, pressure)
    relaxed = balloon.inflate(start, slopes, pressure=push, **scheme)
    out = list(results)
    for j, i in enumerate(own):
        values = {
            "theta0": np.degrees(angles[j, :, 0]).tolist(),
            "theta1": np.degrees(angles[j, :, 1]).tolist(),
            "length": length[j].tolist(),
            "n_iter": relaxed.n_iter[j].tolist(),
            "converged": relaxed.converged[j].tolist(),
        }
        out[i] = replace(
            results[i], start=_placed(start[j], frames[j]), curves=_placed(relaxed.curve[j], frames[j]), values=values
        )
    return out


def _placed(curves: Points, frames: list[ChordFrame]) -> Points:
    """Outer and inner curve from their chord frames to the slice."""
    return np.stack([frame.to_slice(curve) for frame, curve in zip(frames, curves, strict=True)])


def _initial(
    length: NDArray, theta0: NDArray, theta1: NDArray, n: int, pressure: float | None
) -> tuple[Points, Points, NDArray]:
    """Start curves, their slopes per snaxel at the ends, and the pressure: the paper's, or the spiral's own."""
    if pressure is not None:
        start = cubic(length, theta0, theta1, n)
        slopes = np.stack([np.stack([length, length * np.tan(t)], axis=-1) for t in (theta0, theta1)], axis=-2) / (
            n - 1
        )
        return start, slopes, np.full(length.shape, pressure)
    start, curvature = spiral(length, theta0, theta1, n)
    along = np.linalg.norm(np.diff(start, axis=-2), axis=-1).sum(-1)
    heads = [np.stack([np.cos(t), np.sin(t)], axis=-1) for t in (theta0, theta1 - np.pi)]
    slopes = np.stack(heads, axis=-2) * (along / (n - 1))[..., None, None]
    return start, slopes, balloon.curvature_pressure(along, curvature)


def _carry(results: list[SliceResult]) -> list[SliceResult]:
    """Fill skipped slices that lie between bridged ones with curves interpolated from those, marked as carried."""
    known = np.array([s.plane for s in results if s.curves.size])
    curves = {s.plane: s.curves for s in results if s.curves.size}
    out = []
    for s in results:
        below, above = known[known < s.plane], known[known > s.plane]
        if s.status != "skipped" or not len(below) or not len(above):
            out.append(s)
            continue
        a, b = int(below[-1]), int(above[0])
        t = (s.plane - a) / (b - a)
        out.append(replace(s, status="carried", curves=(1 - t) * curves[a] + t * curves[b]))
    return out


def _onto(part: SlicedDesign, bone: Volume, lesion: Lesion) -> NDArray[np.bool_]:
    """The patch of one lesion on the bone's own grid, off the bone, in one piece; shape of `bone`."""
    out = np.zeros(bone.shape, bool)
    where = ndimage.find_objects(part.patch.voxels.view(np.uint8))
    if not where:
        return out
    corners = np.array(np.meshgrid(*[(s.start - 1, s.stop) for s in where[0]])).reshape(3, -1).T
    index = bone.to_voxel(part.patch.to_world(corners))
    low = np.maximum(np.floor(index.min(axis=0)).astype(int), 0)
    high = np.minimum(np.ceil(index.max(axis=0)).astype(int) + 1, bone.shape)
    box = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
    sub = bone.crop((box[0], box[1], box[2]))
    patch = (slicing.resample(part.patch, sub.affine, sub.shape) > 0.5) & ~sub.voxels
    out[box] = fill.main_piece(patch, lesion.opening.voxels[box])
    return out


def _entry(lesion_index: int, s: SliceResult) -> dict[str, Any]:
    """JSON-able record of a slice."""
    return {"lesion": lesion_index, "plane": s.plane, "status": s.status, "reason": s.reason, **s.values}
