"""The simplest rival: a rubber sheet over the hole, the convex hull minus bone.

Bone mask in, `Prosthesis` out. The 2011 paper (doi 10.5220/0003356601370142) uses the convex hull for slices of
partial loss (its Fig. 6): hull minus bone, without small islands and without the biggest region, the cavity.

Faithful, with `paper_options`: that rule on every axial slice whose ring of bone is closed. The rule says nothing of a
slice whose ring is open, since there the hull minus bone runs into the cavity, which is the biggest region: it would
give nothing. Ours is an inner surface: the hull of the endocranial contour, the points where rays from inside the head
first meet bone. What lies between the two hulls and in the hole's cone is a plate, flat along each slice.

Ours, and the default, is the same in space: the hull of the vault's outer surface around the hole, minus the hull of
its inner surface. It needs no slicing direction, closes holes at the top of the head too, where axial slices hold no
ring, and contains the hulls of all slices.

A hull never bulges over the straight line between the rims: over a hole of diameter D in a sphere of radius R it lies
R - sqrt(R^2 - D^2 / 4) too deep, 3 mm for 40 mm and 17 mm for 95 mm at R = 75 mm. That is the point of showing it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import ConvexHull
from skimage.draw import polygon2mask
from skimage.morphology import convex_hull_image

from .. import __version__, chart, fill, lesion, surface
from ..chart import RadialChart
from ..errors import NoOpening
from ..prosthesis import Lesion, Prosthesis
from ..volume import Volume

_RAYS = 720  # around a slice
_ISLAND = 4.0  # mm2: smaller pieces of a slice are dropped
_ABOVE, _BELOW = 20.0, 60.0  # mm above and below the vault around the hole between which a hull may lie


@dataclass(frozen=True, eq=False)
class HullDesign:
    """What the method did for one lesion; for pictures and lessons.

    Parameters
    ----------
    lesion : Lesion
    vault : RadialChart
    outer, inner : ndarray, shape (M, M)
        Radii of the two hulls across the hole in mm, nan elsewhere; all nan where slices were used.
    slices : tuple of dict
        Of each slice used: plane, status ("hull" or "skipped") and reason; empty in space.
    """

    lesion: Lesion
    vault: RadialChart
    outer: NDArray[np.float64]
    inner: NDArray[np.float64]
    slices: tuple[dict[str, Any], ...] = ()


def paper_options(bone: Volume) -> dict[str, Any]:
    """Options of `design` as the paper uses the hull: slice by slice along the planes of the scan."""
    return {"axial": True}


def design(
    bone: Volume,
    lesions: Sequence[Lesion] | None = None,
    *,
    axial: bool = False,
    smooth: bool = True,
    progress: Callable[[str, float], None] | None = None,
) -> Prosthesis:
    """Design a prosthesis by convex hulls.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull, planes rising to the top of the head.
    lesions : sequence of Lesion, optional
        Openings to close; found automatically when not given.
    axial : bool
        Hulls of the slices along the planes of the scan, as the paper; otherwise hulls in space.
    smooth : bool
        Surface without stairs (see `surface.extract`).
    progress : callable, optional
        Called with (stage, fraction done).

    Returns
    -------
    Prosthesis
        With `axial`, `record["slices"]` holds status and reason of every slice. `working` holds a `HullDesign` per
        lesion.

    Raises
    ------
    NoOpening
        When the vault is closed, or no slice of the opening holds a rim for a hull to rest on.
    """
    options = {k: v for k, v in locals().items() if k not in ("bone", "lesions", "progress")}
    tell = progress or (lambda stage, done: None)
    began = time.perf_counter()
    lesions = lesion.find(bone) if lesions is None else lesions
    made, patch = [], np.zeros(bone.shape, bool)
    for i, one in enumerate(lesions):
        tell("hull", 0.9 * i / len(lesions))
        part, piece = (_by_slices if axial else _in_space)(bone, one)
        made.append(part)
        patch |= piece
    if not patch.any():
        raise NoOpening("NothingBridged", "No slice of the opening has a rim for a hull.", "Try the hull in space.")
    tell("surface", 0.9)
    mesh = surface.extract(bone.with_voxels(patch), smooth=smooth)
    sides = surface.face_sides(mesh, bone, lesions[0].head_centre)
    record = {"version": __version__, "seconds": time.perf_counter() - began}
    if axial:
        record["slices"] = [{"lesion": i, **entry} for i, part in enumerate(made) for entry in part.slices]
    return Prosthesis(mesh, sides, bone.with_voxels(patch), "hull", options, record, tuple(made))


def _in_space(bone: Volume, one: Lesion) -> tuple[HullDesign, NDArray[np.bool_]]:
    """The patch of one lesion between the hulls of the vault's two surfaces."""
    vault = chart.look(bone, one)
    outer, inner = (_hull_radius(vault, radius) for radius in (vault.outer, vault.inner))
    outer, inner = chart.thickened(vault, outer, inner)
    piece = chart.voxelise(vault, outer, inner, bone)
    return HullDesign(one, vault, outer, inner), _solid(piece, one, bone)


def _hull_radius(vault: RadialChart, radius: NDArray[np.float64]) -> NDArray[np.float64]:
    """Radius where rays across the hole leave the convex hull of a surface around it, shape (M, M), mm; else nan."""
    known = np.isfinite(radius) & ~vault.hole
    directions = vault.directions
    points = np.concatenate([directions[known] * radius[known][:, None], np.zeros((1, 3))])
    facets = ConvexHull(points).equations  # n x + b <= 0 inside
    rays = directions[vault.hole]
    left = np.concatenate([_leaves(some, facets) for some in np.array_split(rays, 1 + len(rays) // 500)])
    out = np.full(radius.shape, np.nan)
    out[vault.hole] = left
    return out


def _leaves(rays: NDArray[np.float64], facets: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where rays from the origin (n, 3) leave the polyhedron of `facets` (F, 4), shape (n,); nan if at once."""
    lean = rays @ facets[:, :3].T
    with np.errstate(divide="ignore", invalid="ignore"):
        length = np.where(lean > 1e-9, -facets[:, 3] / lean, np.inf).min(axis=1)
    return np.where((length > 1.0) & np.isfinite(length), length, np.nan)


def _by_slices(bone: Volume, one: Lesion) -> tuple[HullDesign, NDArray[np.bool_]]:
    """The patch of one lesion, slice by slice along the planes of the scan."""
    vault = chart.look(bone, one)
    first, end = one.planes
    px = float(bone.spacing[1:].mean())
    near = ndimage.binary_dilation(one.opening.voxels.any(axis=0), iterations=int(np.ceil(3 / px)))
    inside = np.rint(np.round(bone.to_voxel(one.head_centre)[1:], 6))  # a half falls the same way in every header
    cone = _cone(vault, bone)
    piece, entries = np.zeros(bone.shape, bool), []
    for plane in range(max(first - 2, 0), min(end + 2, bone.shape[0])):
        filled, why = _slice(bone.voxels[plane], inside, near, _ISLAND / px**2)
        piece[plane] = filled & cone[plane]
        entries.append({"plane": plane, "status": "hull" if filled.any() else "skipped", "reason": why})
    nothing = np.full(vault.hole.shape, np.nan)
    return HullDesign(one, vault, nothing, nothing, tuple(entries)), _solid(piece, one, bone)


def _cone(vault: RadialChart, bone: Volume) -> NDArray[np.bool_]:
    """Voxels without bone in the directions of the hole, at any depth; beside it only as deep as its rim."""
    far, deep = (np.where(vault.hole, np.nanmedian(vault.outer) + d, np.nan) for d in (_ABOVE, -_BELOW))
    return chart.voxelise(vault, far, deep, bone)


def _slice(
    bone: NDArray[np.bool_], inside: NDArray[np.float64], near: NDArray[np.bool_], min_area: float
) -> tuple[NDArray[np.bool_], str]:
    """What the hulls of a slice leave, and of which kind the slice is."""
    row, col = inside.astype(int)
    hits = _first_bone(bone, inside)
    if len(hits) < 3:
        return np.zeros_like(bone), "no ring of bone in this slice"
    outside, _ = ndimage.label(~np.pad(bone, 1))
    if outside[row + 1, col + 1] not in (0, outside[0, 0]):
        return fill.partial_loss(bone, min_area=min_area, region=near), "closed ring"
    cavity = polygon2mask(bone.shape, hits[ConvexHull(hits).vertices])
    return convex_hull_image(bone) & ~cavity & ~bone, "open ring"


def _first_bone(bone: NDArray[np.bool_], inside: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where rays from a point inside a slice first meet bone, slice (row, col), shape (n, 2)."""
    angles = np.linspace(0, 2 * np.pi, _RAYS, endpoint=False)
    steps = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    lengths = np.arange(1.0, np.hypot(*bone.shape))
    points = inside + steps[:, None] * lengths[:, None]
    index = np.rint(points).astype(int)
    known = ((index >= 0) & (index < bone.shape)).all(axis=-1)
    row, col = np.moveaxis(np.where(known[..., None], index, 0), -1, 0)
    hit = bone[row, col] & known
    rays = np.flatnonzero(hit.any(axis=1))
    return points[rays, hit[rays].argmax(axis=1)]


def _solid(piece: NDArray[np.bool_], one: Lesion, bone: Volume) -> NDArray[np.bool_]:
    """The piece of a patch that fills most of the opening, without enclosed pores; nothing if none reaches it."""
    solid = np.zeros_like(piece)
    if not (piece & one.opening.voxels).any():
        return solid
    for box in ndimage.find_objects(piece.view(np.uint8)):
        main = fill.main_piece(piece[box], one.opening.voxels[box])
        solid[box] = ndimage.binary_fill_holes(main) & ~bone.voxels[box]
    return solid
