"""Stage 2, feature extraction: the bone of one slice comes in -> the ends of its gap and their tangents go out.

Frame: slice (row, col); all lengths in pixels. Source: VISAPP 2011, section 2, Figs. 2 and 3.

The paper's steps: the boundary B of the bone; its skeleton; the convex hull S of the skeleton; the outer boundary
B - S and the inner boundary B and S; some 10 boundary points at each end of the skeleton are left out, and a line is
fitted to the next ones.

What real bone adds: a square cut forks the skeleton into its two corners, and rough bone gives it spurs and loops. So
the spine is the longest path through the skeleton, and "10 points" are counted along the spine, not straight through
the air.
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

PAPER_SKIP_PX = 10.0
"""Boundary left out at each end of the skeleton, px (the paper, section 2: "typically 10 points")."""

_FULL_DEPTH = 0.8  # part of the depth of the bone behind, from which a spine is out of the corners of the cut
_EIGHT = np.ones((3, 3))  # pixels that share a corner are neighbours


class SliceProblem(CranioError):
    """A slice whose gap cannot be bridged from its own features; its neighbours may carry it."""


def extract_features(bone: NDArray[np.bool_], *, min_part: float = 0.03) -> SliceFeatures:
    """Find boundary, skeleton and hull of the bone in one slice.

    Parameters
    ----------
    bone : ndarray of bool, shape (R, C)
        The bone of the slice.
    min_part : float, 0 to 1
        Pieces smaller than this fraction of the slice's bone are left out.

    Returns
    -------
    SliceFeatures
        Boundary pixels (M, 2), one spine for each piece of bone, the hull's half-planes, and whether the bone is a
        closed ring; all in px.

    Raises
    ------
    SliceProblem
        ``NoBoneInSlice``; ``NoSkeleton`` where the bone is too small to have a spine.

    Notes
    -----
    B = bone minus its erosion. S = convex hull of the skeleton (section 2, Fig. 2).

    Examples
    --------
    A plate of 3 x 15 pixels has 32 boundary pixels, and a spine along its middle row:

    >>> bone = np.zeros((9, 21), bool)
    >>> bone[3:6, 3:18] = True
    >>> bone[5, 10] = False  # a notch: the skeleton of a perfect plate is straight and has no hull
    >>> found = extract_features(bone)
    >>> len(found.boundary), np.unique(found.skeleton[0][:, 0]), found.closed
    (32, array([4.]), False)
    """
    if not bone.any():
        raise SliceProblem("NoBoneInSlice", "The slice holds no bone.")
    # no more of the slice than the box of its bone
    box = ndimage.find_objects(bone.astype(np.uint8))[0]
    origin = np.array([side.start for side in box])
    bone = _large_parts(bone[box], min_part)
    padded = np.pad(bone, 1)  # bone at the edge of the box has its boundary there

    # boundary B: bone with a pixel beside it that is none
    boundary = np.argwhere(bone & ~ndimage.binary_erosion(padded)[1:-1, 1:-1]) + origin

    # skeleton, and in each of its parts the spine, longest first; parts of up to 3 pixels have none
    thin = skeletonize(padded)[1:-1, 1:-1]
    depth = ndimage.distance_transform_edt(padded)[1:-1, 1:-1]
    labels, n_parts = ndimage.label(thin, _EIGHT)
    paths = [find_longest_path(np.argwhere(labels == part)) for part in range(1, n_parts + 1)]
    trimmed = [_without_forks(path, depth) for path in paths]
    spines = tuple(sorted((spine + origin for spine in trimmed if len(spine) > 3), key=len, reverse=True))

    # convex hull S of the skeleton; a straight line has none
    points = np.argwhere(thin) + origin
    if not spines or np.linalg.matrix_rank(points - points[0]) < 2:
        raise SliceProblem("NoSkeleton", "The bone of the slice is too small to have a spine.")
    return SliceFeatures(boundary.astype(float), spines, ConvexHull(points).equations, _is_ring(bone))


def find_longest_path(pixels: NDArray) -> Points:
    """Find the longest of the shortest paths between two pixels of a connected skeleton.

    Spurs and forks are shorter than the spine, so they are not on it.

    Parameters
    ----------
    pixels : ndarray of int, shape (n, 2)
        One 8-connected set, slice (row, col).

    Returns
    -------
    ndarray of float, shape (K, 2)
        The path's pixels in order, (row, col) px.

    Notes
    -----
    Two passes of Dijkstra's algorithm: the pixel farthest from any pixel is an end of the longest path. In a tree this
    is exact; in a skeleton with loops it is a long path, not always the longest.

    Examples
    --------
    A bar with a spur: the spur is left out.

    >>> find_longest_path(np.array([[0, 0], [0, 1], [0, 2], [1, 2], [0, 3], [0, 4]]))[:, 0]
    array([0., 0., 0., 0., 0.])
    """
    if len(pixels) < 2:
        return pixels.astype(float)
    # neighbours share an edge (1 px) or a corner (sqrt 2 px)
    pairs = cKDTree(pixels).query_pairs(1.5, output_type="ndarray")
    lengths = np.linalg.norm(pixels[pairs[:, 0]] - pixels[pairs[:, 1]], axis=1)
    graph = coo_array((lengths, pairs.T), shape=(len(pixels),) * 2).tocsr()

    # one end is farthest from anywhere, the other farthest from that end
    start = int(np.argmax(csgraph.dijkstra(graph, directed=False, indices=0)))
    distance, before = csgraph.dijkstra(graph, directed=False, indices=start, return_predecessors=True)
    path = [int(np.argmax(distance))]
    while path[-1] != start:
        path.append(int(before[path[-1]]))
    return pixels[path].astype(float)


def find_gap_ends(
    features: SliceFeatures,
    opening: NDArray[np.bool_] | None = None,
    *,
    skip_px: float = PAPER_SKIP_PX,
    reach_px: float = 10.0,
) -> tuple[GapEnds, GapEnds]:
    """Find end points and tangents of the gap, for the outer and the inner boundary.

    Parameters
    ----------
    features : SliceFeatures
        Of a slice whose bone is not a closed ring.
    opening : ndarray of bool, shape (R, C), optional
        Where the opening crosses this slice: it says which gap is meant where there are several.
    skip_px : float
        Arc length along the spine, from its end, over which boundary points are left out (the paper: 10 points).
    reach_px : float
        Arc length after that, whose boundary points carry the tangent line. The paper gives none.

    Returns
    -------
    outer, inner : GapEnds
        Points (2, 2) and unit tangents (2, 2) into the gap, slice (row, col) px.

    Raises
    ------
    SliceProblem
        ``ClosedRing`` (no gap), ``OneEnd`` (bone on one side only), ``FewPoints`` (too little boundary to fit).

    Notes
    -----
    Section 2, Fig. 3: outer boundary B - S, inner boundary B and S, a line through the points near each end.

    Examples
    --------
    A ring of radii 30 and 40 around (50, 50) with a gap at the top: the ends lie on the two circles.

    >>> row, col = np.indices((101, 101)) - 50
    >>> radius = np.hypot(row, col)
    >>> ring = (radius >= 30) & (radius <= 40) & ~((row < 0) & (abs(col) < 15))
    >>> outer, inner = find_gap_ends(extract_features(ring), skip_px=3, reach_px=8)
    >>> [bool(abs(np.hypot(*(ends.points - 50).T) - r).max() < 1) for ends, r in ((outer, 40), (inner, 30))]
    [True, True]
    """
    if features.closed:
        raise SliceProblem("ClosedRing", "The bone is a closed ring in this slice.")
    spines = _spines_at_gap(features, opening)
    outside = ~features.in_hull  # B - S
    outer, inner = (
        _ends_on(features.boundary[side], spines, skip_px=skip_px, reach_px=reach_px) for side in (outside, ~outside)
    )
    return outer, inner


def select_tangent_points(boundary: Points, spine: Points, *, skip_px: float, reach_px: float) -> NDArray[np.bool_]:
    """Select the boundary points that carry the tangent at the start of a spine.

    Parameters
    ----------
    boundary : ndarray, shape (M, 2)
        Slice (row, col) px.
    spine : ndarray, shape (K, 2)
        Ordered from the gap into the bone, (row, col) px.
    skip_px, reach_px : float
        Arc lengths along the spine: left out first, used after that.

    Returns
    -------
    ndarray of bool, shape (M,)
        True where the nearest point of the spine lies between `skip_px` and `skip_px` + `reach_px` along it.

    Examples
    --------
    >>> spine = np.stack([np.zeros(9), np.arange(9.0)], axis=1)
    >>> select_tangent_points(spine + [2, 0], spine, skip_px=2, reach_px=3).nonzero()[0]
    array([2, 3, 4, 5])
    """
    at = arc_length(spine)
    near, index = cKDTree(spine).query(boundary)
    # a boundary far from the spine belongs to another piece of bone
    beside = near < max(skip_px, 0.5 * reach_px, 5.0) * 2
    return (at[index] >= skip_px) & (at[index] <= skip_px + reach_px) & beside


def fit_line(points: Points) -> tuple[Points, Points]:
    """Fit the line with the least sum of squared distances to points (total least squares).

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        At least two that differ.

    Returns
    -------
    centre : ndarray, shape (2,)
        Mean of the points, on the line; in their unit.
    direction : ndarray, shape (2,)
        Unit vector along the line, of either sign.

    Examples
    --------
    >>> centre, direction = fit_line(np.array([[0.0, 0], [3, 4], [6, 8]]))
    >>> centre, abs(direction).round(3)
    (array([3., 4.]), array([0.6, 0.8]))
    """
    centre = points.mean(axis=0)
    return centre, np.linalg.svd(points - centre, full_matrices=False)[2][0]


def _without_forks(spine: Points, depth: NDArray[np.float64]) -> Points:
    """The spine without its ends in the corners of the cut, where it lies shallower than in the bone behind."""
    along = depth[tuple(spine.astype(np.intp).T)]
    # a fork is no longer than two bone thicknesses; the depth of a spine is half of one
    longest = round(4 * np.median(along))
    if len(along) <= longest:
        return spine
    # at either end, the first point as deep as nearly all bone behind
    deep = [way[:longest] >= _FULL_DEPTH * np.median(way[longest : 3 * longest]) for way in (along, along[::-1])]
    first, last = (int(np.argmax(one)) for one in deep)
    return spine[first : len(spine) - last]


def _ends_on(boundary: Points, spines: tuple[Points, Points], *, skip_px: float, reach_px: float) -> GapEnds:
    """The two ends of the gap on one boundary."""
    ends = [_end_on(boundary, spine, skip_px=skip_px, reach_px=reach_px) for spine in spines]
    return GapEnds(np.array([point for point, _ in ends]), np.array([tangent for _, tangent in ends]))


def _end_on(boundary: Points, spine: Points, *, skip_px: float, reach_px: float) -> tuple[Points, Points]:
    """Last usable boundary point before the gap and the unit tangent there, pointing into the gap."""
    points = boundary[select_tangent_points(boundary, spine, skip_px=skip_px, reach_px=reach_px)]
    if len(points) < 4:
        raise SliceProblem("FewPoints", "Fewer than 4 boundary points are left to fit a tangent to.")
    centre, tangent = fit_line(points)

    # a fitted line has no sign: turn it against the way along the spine into the bone
    along = arc_length(spine)
    inward = spine[np.searchsorted(along, min(skip_px + reach_px, along[-1] - 1e-9))] - spine[0]
    tangent = -tangent * np.sign(tangent @ inward)

    last = points[np.argmax((points - centre) @ tangent)]
    return last, tangent


def _spines_at_gap(features: SliceFeatures, opening: NDArray[np.bool_] | None) -> tuple[Points, Points]:
    """The two spines that face each other across the gap, each ordered from the gap into the bone."""
    if opening is None or not opening.any():
        spine = features.skeleton[0]
        return spine, spine[::-1]
    runs = [run for spine in features.skeleton for run in (spine, spine[::-1])]
    tips = np.array([run[0] for run in runs])

    # the gap's own line: its middle, and how far it goes to either side
    points = np.argwhere(opening)
    centre, along = fit_line(points.astype(float))
    span = (points - centre) @ along

    # a tip belongs to the side of the opening on which it lies; the nearest to that rim faces the gap
    chosen = []
    for extreme in (span.min(), span.max()):
        to_rim = np.hypot(*(tips - (centre + extreme * along)).T)
        cost = to_rim + np.where((tips - centre) @ along * extreme > 0, 0, np.inf)
        chosen.append(int(np.argmin(cost)))
        if not cost[chosen[-1]] < 0.5 * np.ptp(span) + 40:
            raise SliceProblem("OneEnd", "No bone faces the gap on one of its sides.")
    return runs[chosen[0]], runs[chosen[1]]


def _large_parts(bone: NDArray[np.bool_], min_part: float) -> NDArray[np.bool_]:
    """The slice without its small islands."""
    labels, _ = ndimage.label(bone, _EIGHT)
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    return (sizes >= min_part * bone.sum())[labels]


def _is_ring(bone: NDArray[np.bool_]) -> bool:
    """Whether the bone encloses a cavity: more than a third of its own filled area."""
    filled = ndimage.binary_fill_holes(bone)
    return bool((filled & ~bone).sum() > 0.33 * filled.sum())
