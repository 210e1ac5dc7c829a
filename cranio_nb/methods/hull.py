"""The simplest method: the convex hull across the hole, minus bone.

Bone mask in, pieces out. The 2011 paper (doi 10.5220/0003356601370142) uses the convex hull for slices of
partial loss (its Fig. 6): hull minus bone, without small islands and without the biggest region, the cavity.

Faithful, with the preset "paper": that rule on every axial slice whose ring of bone is closed. The rule says nothing
of a slice whose ring is open, since there the hull minus bone runs into the cavity, which is the biggest region: it
would give nothing. Ours is an inner surface: the hull of the endocranial contour, the points where rays from inside
the head first meet bone. What lies between the two hulls and in the hole's cone is a plate, flat along each slice.

Ours, and the default, is the same in space: the hull of the vault's outer surface around the hole, minus the hull of
its inner surface. It needs no slicing direction, closes holes at the top of the head too, where axial slices hold no
ring, and contains the hulls of all slices.

A hull never bulges over the straight line between the rims: over a hole of diameter D in a sphere of radius R it lies
R - sqrt(R^2 - D^2 / 4) too deep, 3 mm for 40 mm and 17 mm for 95 mm at R = 75 mm. That is the point of showing it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import ConvexHull

from ..geometry import voxel_pieces
from ..grid import nearest_values
from ..opening import Opening
from ..options import Option
from ..stages import prosthesis_volume
from ..vault import radius_measurement, radius_voxels
from ..vault.ray_grid import RadiusMap
from ..volume import Volume
from .piece import Piece

_RAYS = 360  # around a slice
_ISLAND = 4.0  # mm2: smaller pieces of a slice are dropped
_ABOVE, _BELOW = 20.0, 60.0  # mm above and below the vault around the hole between which a hull may lie


@dataclass(frozen=True, eq=False)
class HullDesign:
    """What the method did for one opening; for pictures and lessons.

    Parameters
    ----------
    opening : Opening
    radius_map : RadiusMap
    outer, inner : ndarray, shape (M, M)
        Radii of the two hulls across the hole in mm, nan elsewhere; all nan where slices were used.
    slices : tuple of dict
        Of each slice used: plane, status ("hull" or "skipped") and reason; empty in space.
    """

    opening: Opening
    radius_map: RadiusMap
    outer: NDArray[np.float64]
    inner: NDArray[np.float64]
    slices: tuple[dict[str, Any], ...] = ()


PRESETS = {"paper": {"axial": True}}
"""The paper uses the hull slice by slice along the planes of the scan."""


def pieces(
    bone: Volume,
    openings: Sequence[Opening],
    *,
    axial: Annotated[bool, Option("Hulls of slices along the planes of the scan, not in space.")] = False,
) -> Iterator[Piece]:
    """Close each opening by convex hulls.

    Parameters
    ----------
    bone, openings
        As for `methods.design.design`.
    axial : bool
        Hulls of the slices along the planes of the scan, as the paper; otherwise hulls in space.

    Yields
    ------
    Piece
        With `axial`, the record's `slices` hold status and reason of every slice. `working` holds a `HullDesign`.
    """
    for opening in openings:
        made, voxels = (_by_slices if axial else _in_space)(bone, opening)
        record = {"slices": list(made.slices)} if axial else {}
        yield Piece(voxels, (made,), record)


def _in_space(bone: Volume, opening: Opening) -> tuple[HullDesign, NDArray[np.bool_]]:
    """The patch of one opening between the hulls of the vault's two surfaces."""
    radius_map = radius_measurement.measure_around(bone, opening)
    outer, inner = (_hull_radius(radius_map, radius) for radius in (radius_map.outer, radius_map.inner))
    outer, inner = radius_voxels.thickened(radius_map, outer=outer, inner=inner)
    piece = radius_voxels.voxels_between(radius_map, bone, outer=outer, inner=inner)
    return HullDesign(opening, radius_map, outer, inner), voxel_pieces.keep_solid_piece(piece, opening.sheet, bone)


def _hull_radius(radius_map: RadiusMap, radius: NDArray[np.float64]) -> NDArray[np.float64]:
    """Radius where rays across the hole leave the convex hull of a surface around it, shape (M, M), mm; else nan."""
    known = np.isfinite(radius) & ~radius_map.hole
    directions = radius_map.grid.directions
    # the hull of the bone around the hole and of the rays' start, which so lies inside
    points = np.concatenate([directions[known] * radius[known][:, None], np.zeros((1, 3))])
    facets = ConvexHull(points).equations  # n x + b <= 0 inside
    # some hundred rays at a time: the table of rays by facets is large
    rays = directions[radius_map.hole]
    left = np.concatenate([_leaves(some, facets) for some in np.array_split(rays, 1 + len(rays) // 500)])
    out = np.full(radius.shape, np.nan)
    out[radius_map.hole] = left
    return out


def _leaves(rays: NDArray[np.float64], facets: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where rays from the origin (n, 3) leave the polyhedron of `facets` (F, 4), shape (n,); nan if at once."""
    # a ray t d leaves the facet n x + b = 0 at t = -b / (n d); the first has the greatest n d / -b,
    # above 0 as the polyhedron has an end everywhere; a ray over a facet that the origin lies on leaves at once
    inverse = (rays @ (facets[:, :3] / np.maximum(-facets[:, 3:], 1e-9)).T).max(axis=1)
    return np.where(inverse < 1.0, 1 / inverse, np.nan)


def _by_slices(bone: Volume, opening: Opening) -> tuple[HullDesign, NDArray[np.bool_]]:
    """The patch of one opening, slice by slice along the planes of the scan."""
    radius_map = radius_measurement.measure_around(bone, opening)
    # two planes more on either side: the sheet of the opening is coarse
    first, end = opening.planes
    px = float(bone.spacing[1:].mean())
    # 3 mm around the opening: dents elsewhere in a closed ring are not of this hole
    near = ndimage.binary_dilation(opening.sheet.voxels.any(axis=0), iterations=int(np.ceil(3 / px)))
    # as in the paper each plane is closed by itself; the cone keeps a plane's hull to this hole
    cone = _cone(radius_map, bone)
    piece, entries = np.zeros(bone.shape, bool), []
    for plane in range(max(first - 2, 0), min(end + 2, bone.shape[0])):
        # the cavity's wall in this plane, and which of its points are cut faces of the rim
        hits = _first_bone(bone.voxels[plane], bone.to_voxel(opening.head_centre)[1:])
        rim = _in_hole(radius_map, bone.to_world(np.insert(hits, 0, plane, axis=1)))
        piece[plane], why = _slice(bone.voxels[plane], cone[plane], hits, rim, near, _ISLAND / px**2)
        entries.append({"plane": plane, "status": "hull" if piece[plane].any() else "skipped", "reason": why})
    nothing = np.full(radius_map.hole.shape, np.nan)
    return HullDesign(opening, radius_map, nothing, nothing, tuple(entries)), voxel_pieces.keep_solid_piece(
        piece, opening.sheet, bone
    )


def _cone(radius_map: RadiusMap, bone: Volume) -> NDArray[np.bool_]:
    """Voxels without bone in the directions of the hole, at any depth; beside it only as deep as its rim."""
    far, deep = (np.where(radius_map.hole, np.nanmedian(radius_map.outer) + d, np.nan) for d in (_ABOVE, -_BELOW))
    return radius_voxels.voxels_between(radius_map, bone, outer=far, inner=deep)


def _slice(
    bone: NDArray[np.bool_],
    cone: NDArray[np.bool_],
    hits: NDArray[np.float64],
    rim: NDArray[np.bool_],
    near: NDArray[np.bool_],
    min_area: float,
) -> tuple[NDArray[np.bool_], str]:
    """What the hulls of a slice leave in the hole's cone, and of which kind the slice is.

    `hits` (n, 2) are where rays from inside first meet bone; those on the `rim` meet its cut face, not the cavity's
    wall.
    """
    nothing = np.zeros_like(bone)
    if not cone.any():
        return nothing, "outside the hole"
    # every ray meets bone: a partial loss, filled from the outer hull inwards (Fig. 6)
    if len(hits) == _RAYS:
        return prosthesis_volume.fill_partial_loss(bone, min_area_px=min_area, region=near) & cone, "closed ring"
    # a gap: between the hull of all bone and the hull of the cavity's wall
    hits = hits[~rim]
    if len(hits) < _RAYS / 2:  # their hull may not hold the inside
        return nothing, "no ring of bone in this slice"
    pixels = np.argwhere(cone)
    plate = pixels[_in_hull(pixels, np.argwhere(bone), 0.5) & ~_in_hull(pixels, hits, -0.5)]
    nothing[tuple(plate.T)] = True
    return nothing, "open ring"


def _in_hole(radius_map: RadiusMap, points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which world points (n, 3) are seen in the directions of the hole, shape (n,)."""
    return radius_map.grid.at(radius_map.hole, points - radius_map.grid.centre, outside=False)


def _in_hull(pixels: NDArray, points: NDArray, beyond: float) -> NDArray[np.bool_]:
    """Which pixels (n, 2) lie in the convex hull of points (m, 2), or at most `beyond` px outside it.

    Bone ends half a pixel beyond the centres of its pixels, and the cavity half a pixel before them.
    """
    # n x + b <= 0 for all sides; the 1e-6 keeps a tie from hinging on rounding
    sides = ConvexHull(points).equations
    return (pixels @ sides[:, :2].T + sides[:, 2] <= beyond + 1e-6).all(axis=1)


def _first_bone(bone: NDArray[np.bool_], inside: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where rays from a point inside a slice first meet bone, slice (row, col), shape (n, 2)."""
    # samples 1 px apart along each ray, up to half the diagonal of the slice
    angles = np.linspace(0, 2 * np.pi, _RAYS, endpoint=False)
    steps = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    lengths = np.arange(1.0, np.hypot(*bone.shape) / 2)
    points = inside + steps[:, None] * lengths[:, None]
    hit = nearest_values(bone, points, outside=False)
    rays = np.flatnonzero(hit.any(axis=1))
    return points[rays, hit[rays].argmax(axis=1)]
