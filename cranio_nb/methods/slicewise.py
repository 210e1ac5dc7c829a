"""The paper's method: every slice bridged by two balloons, the slices stacked into a patch.

Bone mask in, `Prosthesis` out. Source: the VISAPP 2011 paper, doi 10.5220/0003356601370142.

Faithful is `design(bone, **paper_options(bone))`: axial slices, skeleton and convex hull, tangent lines, the constant
pressure, 21 snaxels, the hull for slices of partial loss. The defaults are ours: slices that fan out from inside the
head and cross the hole in several directions, whose answers are averaged by their certainty; rims seen along rays;
tangents at the rim itself, shared between neighbouring slices; a start curve and a pressure that follow from them
(`curves.spiral`).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..curves import ChordFrame, GapEnds, Points, cubic, spiral
from ..errors import NoOpening
from ..geometry import voxel_pieces
from ..opening import Opening
from ..prosthesis import Prosthesis
from ..stages import deformable_model, feature_extraction, prosthesis_volume
from ..vault import opening_search, radius_measurement, radius_voxels, slicing
from ..vault.rims import RayProfile, fit_rims, share_tangents
from ..volume import Volume
from .assembly import assemble

_TANGENT_ERROR, _TURN_ERROR = 0.05, 0.3  # radians of tangent error on sound bone, and per radian its rim bends
_POINT_ERROR = 0.1  # mm: what a curve is off at its own ends


@dataclass(frozen=True, eq=False)
class SliceResult:
    """One slice of the design.

    Parameters
    ----------
    plane : int
        Index into the frames of its `SlicedDesign`.
    status : {"balloon", "hull", "carried", "skipped"}
        How the slice was filled. "carried": from its neighbours. "skipped": not at all.
    reason : str
        Why it was not bridged by its own balloon.
    ends : tuple of GapEnds
        Outer and inner gap ends, slice (row, col); empty unless status is "balloon".
    start, curves : ndarray, shape (2, n, 2)
        Outer and inner start and final curve, slice (row, col); empty for "hull" and "skipped".
    turns : ndarray, shape (2, 2)
        [boundary, end]: how much the rim's own bone bends (see `rays.RimFits`), radians; 1 where unknown.
    values : dict
        theta0, theta1 (degrees), length (slice units), n_iter, converged: lists [outer, inner].
    """

    plane: int
    status: str
    reason: str = ""
    ends: tuple[GapEnds, ...] = ()
    start: Points = field(default_factory=lambda: np.empty((0, 0, 2)))
    curves: Points = field(default_factory=lambda: np.empty((0, 0, 2)))
    turns: NDArray[np.float64] = field(default_factory=lambda: np.ones((2, 2)))
    values: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class SlicedDesign:
    """What the method did for one opening in one direction, slice by slice; for pictures, tables and lessons.

    Parameters
    ----------
    opening : Opening
    frames : ndarray, shape (P, 3, 3)
        Origin, row and column vector of each slice, world mm: point = origin + row * r + col * c.
    unit : float
        mm per unit of the slices: 1, or the pixel size where the slices are planes of the scan.
    slices : tuple of SliceResult
    """

    opening: Opening
    frames: NDArray[np.float64]
    unit: float
    slices: tuple[SliceResult, ...]


def paper_options(bone: Volume) -> dict[str, Any]:
    """Options of `design` as the paper sets them, for a given grid (10 boundary points are 10 pixels)."""
    px = float(bone.spacing[1:].mean())
    return {
        "axial": True,
        "skip": feature_extraction.PAPER_SKIP_PX * px,
        "reach": 10.0 * px,
        "pressure": deformable_model.PAPER_PRESSURE,
        "n_snaxels": 21,
        "coupling": 0.0,
        "smooth": False,
    }


def design(
    bone: Volume,
    openings: Sequence[Opening] | None = None,
    *,
    axial: bool = False,
    directions: int = 6,
    skip: float = 1.5,
    reach: float = 10.0,
    pressure: float | None = None,
    n_snaxels: int = 41,
    tension: float = 1.0,
    rigidity: float = 1.0,
    dt: float = 1.0,
    tol: float = 1e-3,
    max_iter: int = 2000,
    coupling: float = 4.0,
    smooth: bool = True,
    progress: Callable[[str, float], None] | None = None,
) -> Prosthesis:
    """Design a prosthesis slice by slice.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull, planes rising to the top of the head.
    openings : sequence of Opening, optional
        Openings to close; found automatically when not given.
    axial : bool
        As the paper: the planes of the scan, features by skeleton and convex hull.
        Otherwise fans of planes from inside the head, features along rays.
    directions : int
        In how many directions the fans cross the hole; 1 is the best single one, across its short side.
    skip, reach : float
        Boundary left out next to the gap, and fitted after that, mm of arc length.
    pressure : float, optional
        Constant k, slice units per index squared, outward positive. When not given, k follows from the end tangents.
    n_snaxels : int
        Points of a balloon, ends included.
    tension, rigidity, dt, tol, max_iter
        As for `deformable_model.inflate`.
    coupling : float
        Standard deviation in mm over which tangents are shared between neighbouring slices of a fan; 0 for none.
    smooth : bool
        Surface without stairs (see `surface_reconstruction.extract_surface`).
    progress : callable, optional
        Called with (stage, fraction done).

    Returns
    -------
    Prosthesis
        `record["slices"]` holds one entry per slice: status, reason, angles, lengths, iterations, convergence.
        `working` holds a `SlicedDesign` per opening and direction.

    Raises
    ------
    NoOpening
        When the vault is closed, or no slice of the opening could be bridged.
    """
    options = {k: v for k, v in locals().items() if k not in ("bone", "openings", "progress")}
    tell = progress or (lambda stage, done: None)
    began = time.perf_counter()
    openings = opening_search.find_openings(bone) if openings is None else openings
    scheme = {"tension": tension, "rigidity": rigidity, "dt": dt, "tol": tol, "max_iter": max_iter}
    curve = {"n": n_snaxels, "pressure": pressure, "scheme": scheme}
    working: list[SlicedDesign] = []
    patch = np.zeros(bone.shape, bool)
    for i, one in enumerate(openings):
        tell("slices", 0.9 * i / len(openings))
        if axial:
            made, piece = _axial(bone, one, skip, reach, curve)
        else:
            made, piece = _fanned(bone, one, directions, skip, reach, coupling, curve)
        working += made
        patch |= voxel_pieces.keep_main_piece(piece, one.sheet.voxels)
    if not patch.any():
        raise NoOpening("NothingBridged", "No slice of the opening could be bridged.", "Try another slicing.")
    tell("surface", 0.9)
    slices = [_entry(i, s) for i, part in enumerate(working) for s in part.slices]
    return assemble(
        patch, bone, openings, "slicewise", options, began=began, working=working, record={"slices": slices}
    )


def _axial(
    bone: Volume, one: Opening, skip: float, reach: float, curve: dict[str, Any]
) -> tuple[list[SlicedDesign], NDArray[np.bool_]]:
    """Slices and patch of one opening along the planes of the scan."""
    first, end = one.planes
    planes = range(max(first - 2, 0), min(end + 2, bone.shape[0]))
    px = float(bone.spacing[1:].mean())
    opening = one.sheet.voxels[planes.start : planes.stop]
    slices = bone.voxels[planes.start : planes.stop]
    inside = bone.to_voxel(one.head_centre)[1:]
    results = _carry(_inflate(_by_skeleton(slices, opening, skip / px, reach / px), inside, curve))
    patch = np.zeros(bone.shape, bool)
    near = ndimage.binary_dilation(opening.any(axis=0), iterations=int(np.ceil(3 / px)))
    for s in results:
        if s.status == "hull":
            filled = prosthesis_volume.fill_partial_loss(slices[s.plane], min_area_px=4 / px**2, region=near)
        elif s.curves.size:
            filled = prosthesis_volume.fill_gap(s.curves[0], s.curves[1], slices[s.plane])
        else:
            continue
        patch[planes.start + s.plane] = filled
    return [SlicedDesign(one, slicing.axial_frames(bone, planes), px, tuple(results))], patch


def _fanned(
    bone: Volume, one: Opening, directions: int, skip: float, reach: float, coupling: float, curve: dict[str, Any]
) -> tuple[list[SlicedDesign], NDArray[np.bool_]]:
    """Slices of one opening in several directions, and the patch between the means of their curves."""
    vault = radius_measurement.measure_around(bone, one)
    made, radii, weights = [], [], []
    for fan in slicing.fans(vault, directions):
        profile = slicing.profile(vault, fan)
        results = _carry(_inflate(_by_rays(profile, skip, reach, coupling), np.zeros(2), curve))
        made.append(SlicedDesign(one, fan.frames(vault.grid.centre), 1.0, tuple(results)))
        at = fan.locate(vault.grid.directions[vault.hole])
        both = [_on_rays(results, b, profile) for b in (0, 1)]
        radii.append([ndimage.map_coordinates(r, at, order=1, cval=np.nan) for r, _ in both])
        weights.append([ndimage.map_coordinates(w, at, order=1, cval=0.0) for _, w in both])
    outer, inner = np.full((2, *vault.hole.shape), np.nan)
    outer[vault.hole], inner[vault.hole] = _weighted_mean(np.array(radii), np.array(weights))
    if not np.isfinite(outer).any():
        return made, np.zeros(bone.shape, bool)
    outer, inner = radius_voxels.thickened(vault, outer=outer, inner=inner)
    return made, radius_voxels.voxels_between(vault, bone, outer=outer, inner=inner)


def _weighted_mean(values: NDArray[np.float64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean over the first axis of what is known; nan where nothing is."""
    weights = np.where(np.isfinite(values), weights, 0.0)
    total = weights.sum(axis=0)
    return np.where(total > 0, (weights * np.nan_to_num(values)).sum(axis=0) / np.where(total > 0, total, 1.0), np.nan)


def _on_rays(results: list[SliceResult], boundary: int, profile: RayProfile) -> tuple[NDArray, NDArray]:
    """Radius of a fan's curves along the rays of its slices, and its weight; shape (P, K), nan and 0 elsewhere.

    A tangent that is wrong by an angle e at the end moves a cubic by e L t (1 - t)^2, so a point is the surer the
    shorter the slice's way across the hole, the nearer its rim, and the less the rim's own bone bends.
    """
    radii, weights = np.full(profile.outer.shape, np.nan), np.zeros(profile.outer.shape)
    for s in results:
        if not s.curves.size:
            continue
        row, col = s.curves[boundary].T
        angle = np.arctan2(col, -row)
        radii[s.plane] = np.interp(profile.angles, angle, np.hypot(row, col), np.nan, np.nan)
        t = np.clip((profile.angles - angle[0]) / (angle[-1] - angle[0]), 0, 1)
        length = np.hypot(row[-1] - row[0], col[-1] - col[0])
        slips = _TANGENT_ERROR**2 + (_TURN_ERROR * s.turns[boundary]) ** 2
        error = length**2 * (slips[0] * (t * (1 - t) ** 2) ** 2 + slips[1] * (t**2 * (1 - t)) ** 2)
        weights[s.plane] = 1 / (error + _POINT_ERROR**2)
    return radii, weights


def _by_skeleton(slices: NDArray[np.bool_], opening: NDArray[np.bool_], skip: float, reach: float) -> list[SliceResult]:
    """Gap ends of every slice by skeleton and hull."""
    results = []
    for plane in range(len(slices)):
        try:
            seen = feature_extraction.extract_features(slices[plane])
            if seen.closed:
                results.append(SliceResult(plane, "hull", "closed ring"))
                continue
            ends = feature_extraction.find_gap_ends(seen, opening[plane], skip_px=skip, reach_px=reach)
            results.append(SliceResult(plane, "balloon", ends=ends))
        except feature_extraction.SliceProblem as problem:
            results.append(SliceResult(plane, "skipped", problem.message))
    return results


def _by_rays(profile: RayProfile, skip: float, reach: float, coupling: float) -> list[SliceResult]:
    """Gap ends of every slice of a fan, tangents shared between neighbours."""
    rims = fit_rims(profile, skip=skip, reach=reach)
    tangents = share_tangents(rims.tangents, coupling)
    turns = ndimage.median_filter(np.nan_to_num(rims.turns, nan=1.0), size=(2 * round(coupling) + 1, 1, 1))
    results = []
    for plane in np.flatnonzero(profile.missing.any(axis=1)):
        if np.isfinite(tangents[plane]).all():
            ends = tuple(GapEnds(rims.points[plane, b], tangents[plane, b]) for b in (0, 1))
            results.append(SliceResult(int(plane), "balloon", ends=ends, turns=turns[plane]))
        else:
            results.append(SliceResult(int(plane), "skipped", "too little bone beside the gap to fit a tangent to"))
    return results


def _inflate(results: list[SliceResult], inside: NDArray, curve: dict[str, Any]) -> list[SliceResult]:
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
    start, slopes, push = _initial(length, angles[..., 0], angles[..., 1], curve["n"], curve["pressure"])
    relaxed = deformable_model.inflate(start, slopes, pressure=push, **curve["scheme"])
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
    return start, slopes, deformable_model.curvature_pressure(along, curvature)


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


def _entry(index_of_opening: int, s: SliceResult) -> dict[str, Any]:
    """JSON-able record of a slice."""
    return {"opening": index_of_opening, "plane": s.plane, "status": s.status, "reason": s.reason, **s.values}
