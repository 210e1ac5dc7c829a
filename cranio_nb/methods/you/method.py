"""A method on triangle meshes: guiding points on the rim of the hole, and flat fills between them.

Bone mask in, pieces out. In the spirit of You et al. 2009, "A new modeling method on skull defect repair", of
which we had only what others write about it: voxels are split into tetrahedra, marching tetrahedra give the mesh of the
defective skull, a user places guiding points, and computational geometry on that mesh alone fills the hole. Nothing
asks the fill to leave the rim in the direction of the bone, hence the bias to planar shapes that it is known for:
over a spherical cap of height h the fill of least area lies h / 2 too deep in the mean, and h at most.

1. `tetrahedra.extract`: the mesh of the skull around the hole.
2. Guiding points on the outer rim: given, or found at even steps around the hole (ours). Each has a partner on the
   inner surface behind it (ours).
3. The rims: shortest paths along the edges of the mesh from guide to guide, outside and inside.
4. `membrane.span_loop`: across each rim the surface of least area, in triangles of the size of the voxels.
5. The wall between the rims closes the solid. The patch is the voxels in it, off the bone, and the mesh that is
   delivered is that of the patch: so it never overlaps the bone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, sparse
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree
from skimage.measure import find_contours

from ...errors import InputRefused
from ...geometry import voxel_pieces
from ...grid import true_indices
from ...mesh import Mesh
from ...opening import Opening
from ...options import Option
from ...vault import radius_measurement
from ...vault.ray_grid import RadiusMap
from ...volume import Volume
from ..piece import Piece
from . import membrane, mesh_to_voxels, tetrahedra
from .membrane import Loop, Membrane

_MARGIN = 12.0  # mm of skull around the hole whose mesh is made
_LEANS = 0.5  # outward part of the normal from which a vertex belongs to the outer surface, or to the inner one
_DEAREST = 10.0  # times its length an edge costs a rim's path on the cut face, where it should not run
_DEPTH_COUNTS = 0.1  # how much a mm along the line of sight counts against one across it when a partner is looked for
_SMOOTH = (1.5, 3.0, 6.0, 12.0)  # mm along the rim: the first that leaves no kink in it
_DIGITS = 6  # of lengths and costs that are compared: what is equal stays so in a turned header and on any machine


@dataclass(frozen=True, eq=False)
class Filling:
    """What the method made of one hole, world mm; for pictures and lessons.

    Parameters
    ----------
    skull : Mesh
        The defective skull around the hole.
    guides, partners : ndarray, shape (n, 3)
        Guiding points on the outer surface, and behind them on the inner one.
    outer_rim, inner_rim : Loop
        Stations count guides.
    outer, inner : Membrane
        The fills.
    solid : Mesh
        Both fills and the wall between them, closed. On a ragged rim faces of the wall may cross a fill.
    """

    skull: Mesh
    guides: NDArray[np.float64]
    partners: NDArray[np.float64]
    outer_rim: Loop
    inner_rim: Loop
    outer: Membrane
    inner: Membrane
    solid: Mesh


def pieces(
    bone: Volume,
    openings: Sequence[Opening],
    *,
    # three points make a plane; more than 48 lie closer than the rim of a small hole is known
    n_guides: Annotated[int, Option("Guiding points around each hole.", 3, 48, usual=(3, 24))] = 12,
) -> Iterator[Piece]:
    """Close each opening between guiding points that are found by themselves.

    Parameters
    ----------
    bone, openings
        As for `methods.design.design`.
    n_guides : int
        Guiding points around each hole.

    Yields
    ------
    Piece
        As `between_guides`.

    Raises
    ------
    InputRefused
        ``TooFewGuides``; ``TangledRim`` when the rim of a hole crosses itself.
    """
    guides = [find_guides(radius_measurement.measure_around(bone, opening), n_guides) for opening in openings]
    yield from between_guides(bone, openings, guides)


def between_guides(bone: Volume, openings: Sequence[Opening], guides: Sequence[NDArray[np.float64]]) -> Iterator[Piece]:
    """Close each opening between guiding points that somebody placed; `design.assemble` makes a prosthesis of it.

    Parameters
    ----------
    bone, openings
        As for `pieces`.
    guides : sequence of ndarray, shape (n, 3)
        For each opening at least 3 points near the outer edge of its rim, in order around the hole, world mm.

    Yields
    ------
    Piece
        The record's `fills` describe the outer and the inner fill; `working` holds a `Filling`.
    """
    for opening, points in zip(openings, guides, strict=True):
        # voxels are filled only in a box around the hole, and there in one piece
        filling = fill_between(bone, opening, np.asarray(points, float))
        box = _box(bone, opening, filling.guides)
        voxels = np.zeros(bone.shape, bool)
        voxels[box] = _solid(bone.crop(box), opening.sheet.voxels[box], filling.solid)
        yield Piece(voxels, (filling,), {"fills": [_entry(side) for side in (filling.outer, filling.inner)]})


def find_guides(radius_map: RadiusMap, n_guides: int) -> NDArray[np.float64]:
    """Points on the outer surface at even steps around a hole.

    Parameters
    ----------
    radius_map : RadiusMap
        The bone around the hole.
    n_guides : int

    Returns
    -------
    ndarray, shape (n_guides, 3)
        World mm.
    """
    # the outline of the hole on the map, blurred over a ray or two so that it has no stairs
    soft = ndimage.gaussian_filter(radius_map.hole.astype(float), 1.5)
    outline = max(find_contours(np.pad(soft, 1), 0.5), key=len)[:-1] - 1
    # even steps of arc length along it
    closed = np.concatenate([outline, outline[:1]])
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    at = np.arange(n_guides) * along[-1] / n_guides
    v, u = (np.rint(np.round(np.interp(at, along, c), _DIGITS)).astype(int) for c in closed.T)
    # each to the nearest ray with bone, and out along that ray to its outer surface
    unknown = radius_map.hole | ~np.isfinite(radius_map.outer)
    v, u = ndimage.distance_transform_edt(unknown, return_distances=False, return_indices=True)[:, v, u]
    return radius_map.grid.centre + radius_map.grid.directions[v, u] * radius_map.outer[v, u, None]


def fill_between(bone: Volume, opening: Opening, guides: NDArray[np.float64]) -> Filling:
    """Fill one hole between guiding points.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    opening : Opening
        The hole.
    guides : ndarray, shape (n, 3)
        Near the outer edge of the rim, in order around the hole, world mm.

    Returns
    -------
    Filling

    Raises
    ------
    InputRefused
        ``TooFewGuides``; ``TangledRim``.
    """
    if len(guides) < 3:
        raise InputRefused("TooFewGuides", f"There are {len(guides)} guiding points; 3 at least are wanted.")
    # the mesh of the defective skull, and for each vertex how far its normal points out of the head
    skull = _main_part(tetrahedra.extract(bone.crop(_box(bone, opening, guides))))
    away = skull.vertices - opening.head_centre
    radius = np.linalg.norm(away, axis=1)
    lean = np.einsum("vd,vd->v", _vertex_normals(skull), away / radius[:, None])
    # each guide goes to the nearest vertex of the outer surface
    normal = _normal(guides, opening.direction)
    outer_at = _nearest(skull.vertices, lean > _LEANS, _counter_clockwise(guides, normal))
    # its partner lies behind it on the inner surface: near it as seen from the head centre, at any depth
    sight = away / radius[:, None] * np.median(radius)
    seen = np.column_stack([sight, _DEPTH_COUNTS * radius])
    inner_at = _nearest(seen, lean < -_LEANS, seen[outer_at])
    # a rim from guide to guide and a fill across it, outside and inside, then the wall between
    step = float(bone.voxel_volume ** (1 / 3))
    outer_rim, outer = _spanned(_path_loop(skull, outer_at, lean), normal, step)
    inner_rim, inner = _spanned(_path_loop(skull, inner_at, -lean), normal, step)
    closed = membrane.join_membranes(outer, inner, outer_rim, inner_rim)
    points = skull.vertices
    return Filling(skull, points[outer_at], points[inner_at], outer_rim, inner_rim, outer, inner, closed)


def _spanned(way: Loop, normal: NDArray[np.float64], step: float) -> tuple[Loop, Membrane]:
    """The rim along a way on the mesh, and the fill across it; smoothed no more than it takes to be spanned."""
    # a rim with kinks may cross itself seen from outside: smooth more until it does not
    for smooth in _SMOOTH:
        rim = membrane.resample_loop(way, step, smooth)
        try:
            return rim, membrane.span_loop(rim.points, normal, step)
        except InputRefused as refused:
            problem = refused
    raise problem


def _solid(bone: Volume, opening: NDArray[np.bool_], closed: Mesh) -> NDArray[np.bool_]:
    """Voxels inside the solid and off the bone, in one piece, without the slivers where a fill grazes the bone."""
    return voxel_pieces.keep_main_piece(
        ndimage.binary_opening(mesh_to_voxels.fill_mesh(closed, bone) & ~bone.voxels), opening
    )


def _entry(one: Membrane) -> dict[str, Any]:
    """JSON-able record of a membrane."""
    return {"area": one.areas[-1], "harmonic_area": one.areas[0], "n_iter": len(one.areas), "converged": one.converged}


def _box(bone: Volume, opening: Opening, guides: NDArray) -> tuple[slice, slice, slice]:
    """Index box around the opening and the guides, with a margin."""
    # voxel indices of both, with a margin in mm on every side
    index = np.concatenate([true_indices(opening.sheet.voxels), bone.to_voxel(guides)])
    margin = _MARGIN / bone.spacing
    low = np.maximum(np.floor(index.min(axis=0) - margin).astype(int), 0)
    high = np.minimum(np.ceil(index.max(axis=0) + margin).astype(int) + 1, bone.shape)
    return slice(low[0], high[0]), slice(low[1], high[1]), slice(low[2], high[2])


def _main_part(mesh: Mesh) -> Mesh:
    """The largest connected part: without loose bone and without the walls of the cells inside the bone."""
    # vertices that edges join, and the part with most of them
    _, part = connected_components(_edge_graph(mesh), directed=False)
    kept = part == np.bincount(part).argmax()
    faces = mesh.faces[kept[mesh.faces[:, 0]]]
    return Mesh(mesh.vertices[kept], (np.cumsum(kept) - 1)[faces])


def _edge_graph(mesh: Mesh) -> sparse.csr_array:
    """Length of every edge, shape (V, V)."""
    a, b = mesh.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2).T  # closed: every edge comes both ways
    length = np.linalg.norm(mesh.vertices[a] - mesh.vertices[b], axis=1)
    length = np.round(length, _DIGITS)
    return sparse.csr_array((length, (a, b)), shape=(len(mesh.vertices),) * 2)


def _vertex_normals(mesh: Mesh) -> NDArray[np.float64]:
    """Mean of the normals around each vertex, weighted by area, shape (V, 3)."""
    # area vectors are normals times area: their sum is the weighted mean
    corners, shares = mesh.faces.ravel(), np.repeat(mesh.area_vectors, 3, axis=0)
    sums = np.stack([np.bincount(corners, share, len(mesh.vertices)) for share in shares.T], axis=1)
    return sums / np.linalg.norm(sums, axis=1, keepdims=True).clip(1e-12)


def _normal(guides: NDArray, direction: NDArray) -> NDArray[np.float64]:
    """Unit normal of the plane of the guides, out of the head."""
    # the direction in which the guides spread least
    normal = np.linalg.svd(guides - guides.mean(axis=0), full_matrices=False)[2][2]
    return normal if normal @ direction > 0 else -normal


def _counter_clockwise(points: NDArray, normal: NDArray) -> NDArray[np.float64]:
    """A closed polygon's points so that it runs counter-clockwise seen against the normal."""
    # the polygon's area vector, by the cross products of neighbours
    rays = points - points.mean(axis=0)
    turn = np.cross(rays, np.roll(rays, -1, axis=0)).sum(axis=0) @ normal
    return points if turn > 0 else points[::-1]


def _nearest(places: NDArray, allowed: NDArray[np.bool_], wanted: NDArray) -> NDArray[np.intp]:
    """Index of the allowed place nearest to each wanted one, neighbours that are the same place left out."""
    candidates = np.flatnonzero(allowed)
    if not len(candidates):
        raise InputRefused("NoRim", "No bone was found beside the guiding points.", "Place them on the rim.")
    return candidates[cKDTree(np.round(places[candidates], _DIGITS)).query(np.round(wanted, _DIGITS))[1]]


def _path_loop(skull: Mesh, at: NDArray[np.intp], lean: NDArray[np.float64]) -> Loop:
    """Closed way through the vertices `at` along edges; stations count them."""
    # an edge costs its length by the mean of its ends' leans: paths keep to the surface they belong to
    graph = _edge_graph(skull)
    costs = graph.tocoo()
    costs.data *= np.clip(2 / (lean[costs.row] + lean[costs.col]).clip(1e-3), 1, _DEAREST)
    costs.data = np.round(costs.data, _DIGITS)
    graph = costs.tocsr()
    way, stations = [], []
    # guide to guide; a vertex between guides k and k + 1 has a station between k and k + 1
    for k, (start, end) in enumerate(zip(at, np.roll(at, -1), strict=True)):
        path = _shortest_path(skull.vertices, graph, start, end)
        way += path[:-1]
        stations += list(k + np.arange(len(path) - 1) / max(len(path) - 1, 1))
    # paths that share edges would make a loop that touches itself
    kept = _without_detours(way)
    return Loop(skull.vertices[np.array(way)[kept]], np.array(stations)[kept], float(len(at)))


def _shortest_path(vertices: NDArray[np.float64], graph: sparse.csr_array, start: int, end: int) -> list[int]:
    """Vertices of the cheapest way between two of them; straight across where no bone joins them."""
    # searched only in a ball around both ends: the whole skull's graph is large
    middle, apart = (vertices[start] + vertices[end]) / 2, np.linalg.norm(vertices[start] - vertices[end])
    inside = np.flatnonzero(np.linalg.norm(vertices - middle, axis=1) < apart + _MARGIN / 2)
    first, last = np.searchsorted(inside, (start, end))
    # Dijkstra's predecessors, followed back from the end
    _, before = dijkstra(graph[inside][:, inside], indices=first, return_predecessors=True)
    path = [int(last)]
    while path[-1] != first and before[path[-1]] >= 0:
        path.append(int(before[path[-1]]))
    return [int(inside[k]) for k in path[::-1]] if path[-1] == first else [int(start), int(end)]


def _without_detours(way: list[int]) -> NDArray[np.intp]:
    """Positions in a closed way that stay when, wherever it meets itself, the shorter of the two rounds is left out."""
    kept: list[int] = []
    place: dict[int, int] = {}
    for position, vertex in enumerate(way):
        # a new vertex: remember where in the kept way it stands
        if vertex not in place:
            place[vertex] = len(kept)
            kept.append(position)
            continue
        # a vertex met before: the round since then is dropped, or all before it if that is shorter
        met = place[vertex]
        if 2 * (len(kept) - met) > len(way):
            return np.array(kept[met:])
        for dropped in kept[met + 1 :]:
            del place[way[dropped]]
        del kept[met + 1 :]
    return np.array(kept)
