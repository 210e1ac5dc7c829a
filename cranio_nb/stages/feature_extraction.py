"""Stage 2, features as the paper takes them: the bone of a slice comes in -> the ends of its gap go out.

Frame: slice (row, col) px. Lengths in px.

Boundary B, skeleton, convex hull S of the skeleton; outer boundary B - S, inner boundary B and S; near each end of
the skeleton some boundary points are left out (the cut face) and a line is fitted to the next ones.

A squarely cut bone forks the skeleton into its corners, and real bone adds spurs and loops. So the spine is the
longest geodesic path of the skeleton, and boundary points are chosen by arc length along it, not by straight distance.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_array, csgraph
from scipy.spatial import ConvexHull, cKDTree
from skimage.morphology import skeletonize

from ..curves import GapEnds, Points, SliceFeatures, arc_length
from ..errors import CranioError

PAPER_SKIP = 10.0
"""Boundary points dropped near a skeleton end (the paper, section 2)."""


class SliceProblem(CranioError):
    """A slice whose gap cannot be bridged from its own features; its neighbours may carry it."""


def slice_features(bone: NDArray[np.bool_], *, min_part: float = 0.03) -> SliceFeatures:
    """Boundary, skeleton and hull of the bone in one slice.

    Parameters
    ----------
    bone : ndarray of bool, shape (R, C)
    min_part : float
        Pieces smaller than this fraction of the slice's bone are left out.

    Raises
    ------
    SliceProblem
        ``NoBoneInSlice``, or ``NoSkeleton`` where the bone is too small to have a spine.
    """
    if not bone.any():
        raise SliceProblem("NoBoneInSlice", "The slice holds no bone.")
    bone = _large_parts(bone, min_part)
    padded = np.pad(bone, 1)
    boundary = np.argwhere(bone & ~ndimage.binary_erosion(padded)[1:-1, 1:-1])
    thin = skeletonize(padded)[1:-1, 1:-1]
    labels, n_parts = ndimage.label(thin, np.ones((3, 3)))
    depth = ndimage.distance_transform_edt(padded)[1:-1, 1:-1]
    spines = [_unforked(longest_path(np.argwhere(labels == part)), depth) for part in range(1, n_parts + 1)]
    spines = sorted((s for s in spines if len(s) > 3), key=len, reverse=True)
    points = np.argwhere(thin)
    if not spines or np.linalg.matrix_rank(points - points[0]) < 2:  # a straight line has no hull
        raise SliceProblem("NoSkeleton", "The bone of the slice is too small to have a spine.")
    return SliceFeatures(boundary.astype(float), tuple(spines), ConvexHull(points).equations, _is_ring(bone))


def longest_path(pixels: NDArray) -> Points:
    """The longest geodesic path through connected skeleton pixels, in order, shape (K, 2).

    Parameters
    ----------
    pixels : ndarray, shape (n, 2)
        One 8-connected set. Spurs and forks are shorter than the spine and fall away.
    """
    if len(pixels) < 2:
        return pixels.astype(float)
    pairs = cKDTree(pixels).query_pairs(1.5, output_type="ndarray")
    lengths = np.linalg.norm(pixels[pairs[:, 0]] - pixels[pairs[:, 1]], axis=1)
    graph = coo_array((lengths, pairs.T), shape=(len(pixels),) * 2).tocsr()
    start = int(np.argmax(csgraph.dijkstra(graph, directed=False, indices=0)))
    distance, before = csgraph.dijkstra(graph, directed=False, indices=start, return_predecessors=True)
    path = [int(np.argmax(distance))]
    while path[-1] != start:
        path.append(int(before[path[-1]]))
    return pixels[path].astype(float)


def gap_ends(
    features: SliceFeatures,
    opening: NDArray[np.bool_] | None = None,
    *,
    skip: float = PAPER_SKIP,
    reach: float = 10.0,
) -> tuple[GapEnds, GapEnds]:
    """End points and tangents of the gap, for the outer and the inner boundary.

    Parameters
    ----------
    features : SliceFeatures
    opening : ndarray of bool, shape (R, C), optional
        Where the opening crosses this slice; it says which gap is meant where there are several.
    skip : float
        Arc length along the spine from its end over which boundary points are left out, px (the paper: 10 points).
    reach : float
        Arc length of the neighbourhood after that, whose points carry the tangent line, px.

    Returns
    -------
    outer, inner : GapEnds

    Raises
    ------
    SliceProblem
        ``ClosedRing`` (no gap), ``OneEnd`` (bone on one side only), ``FewPoints`` (too little boundary to fit).
    """
    if features.closed:
        raise SliceProblem("ClosedRing", "The bone is a closed ring in this slice.")
    spines = _spines_at_gap(features, opening)
    outside = ~features.in_hull
    ends = [[_end(features.boundary[side], spine, skip, reach) for spine in spines] for side in (outside, ~outside)]
    outer, inner = (GapEnds(np.array([p for p, _ in pair]), np.array([t for _, t in pair])) for pair in ends)
    return outer, inner


def used_points(boundary: Points, spine: Points, skip: float, reach: float) -> NDArray[np.bool_]:
    """Which boundary points carry the tangent at the start of a spine, shape (M,).

    Parameters
    ----------
    boundary : ndarray, shape (M, 2)
    spine : ndarray, shape (K, 2)
        Ordered from the gap into the bone.
    skip, reach : float
        Arc lengths along the spine, px.
    """
    at = arc_length(spine)
    near, index = cKDTree(spine).query(boundary)
    return (at[index] >= skip) & (at[index] <= skip + reach) & (near < max(skip, 0.5 * reach, 5.0) * 2)


def fit_line(points: Points) -> tuple[Points, Points]:
    """Centre and unit direction of the total-least-squares line through points, shape (2,) each."""
    centre = points.mean(axis=0)
    return centre, np.linalg.svd(points - centre, full_matrices=False)[2][0]


def _unforked(spine: Points, depth: NDArray[np.float64]) -> Points:
    """The spine without its ends in the corners of the cut, where it lies shallower than in the bone behind."""
    along = depth[tuple(spine.astype(np.intp).T)]
    return spine[_corner(along) : len(spine) - _corner(along[::-1])]


def _corner(depth: NDArray[np.float64], full: float = 0.8) -> int:
    """Points from the start of a spine to where it has `full` of the depth behind, within two bone thicknesses."""
    longest = round(4 * np.median(depth))
    deep = depth[:longest] >= full * np.median(depth[longest : 3 * longest]) if len(depth) > longest else [True]
    return int(np.argmax(deep))


def _end(boundary: Points, spine: Points, skip: float, reach: float) -> tuple[Points, Points]:
    """Last usable boundary point before the gap and the tangent there, pointing into the gap."""
    points = boundary[used_points(boundary, spine, skip, reach)]
    if len(points) < 4:
        raise SliceProblem("FewPoints", "Fewer than 4 boundary points are left to fit a tangent to.")
    centre, tangent = fit_line(points)
    along = arc_length(spine)
    inward = spine[np.searchsorted(along, min(skip + reach, along[-1] - 1e-9))] - spine[0]
    tangent = -tangent * np.sign(tangent @ inward)
    last = points[np.argmax((points - centre) @ tangent)]
    return last, tangent


def _spines_at_gap(features: SliceFeatures, opening: NDArray[np.bool_] | None) -> tuple[Points, Points]:
    """The two spines that face each other across the gap, each ordered from the gap into the bone."""
    runs = [run for spine in features.skeleton for run in (spine, spine[::-1])]
    if opening is None or not opening.any():
        spine = features.skeleton[0]
        return spine, spine[::-1]
    points = np.argwhere(opening)
    centre, along = fit_line(points.astype(float))
    span = (points - centre) @ along
    tips = np.array([run[0] for run in runs])
    chosen = []
    for extreme in (span.min(), span.max()):
        rim = centre + extreme * along
        # a tip belongs to the side of the opening it lies on; the nearest to that rim faces the gap
        cost = np.hypot(*(tips - rim).T) + np.where((tips - centre) @ along * extreme > 0, 0, np.inf)
        chosen.append(int(np.argmin(cost)))
        if not cost[chosen[-1]] < 0.5 * np.ptp(span) + 40:
            raise SliceProblem("OneEnd", "No bone faces the gap on one of its sides.")
    return runs[chosen[0]], runs[chosen[1]]


def _large_parts(bone: NDArray[np.bool_], min_part: float) -> NDArray[np.bool_]:
    """The slice without its small islands."""
    labels, _ = ndimage.label(bone, np.ones((3, 3)))
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    return (sizes >= min_part * bone.sum())[labels]


def _is_ring(bone: NDArray[np.bool_]) -> bool:
    """Whether the bone encloses a cavity larger than itself would fill: a third of its own filled area."""
    filled = ndimage.binary_fill_holes(bone)
    return bool((filled & ~bone).sum() > 0.33 * filled.sum())
