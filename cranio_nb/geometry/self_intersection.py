"""A triangle mesh -> the pairs of its faces that pass through each other.

Frame: any. Faces that only touch, at a shared corner, along a shared edge or side by side, do not count; two faces
folded flat onto each other do.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..mesh import Mesh

_TOUCH = 1e-9  # overlap, relative to the size of the faces, that still counts as touching
_MAX_CELLS = 96  # cells of the search grid along an axis, at most


def crossings(mesh: Mesh) -> NDArray[np.intp]:
    """Pairs of faces that intersect.

    Parameters
    ----------
    mesh : Mesh
        Finite vertices.

    Returns
    -------
    ndarray of int, shape (N, 2)
        Face indices, the smaller first.

    Notes
    -----
    Two triangles are apart, or touch, exactly if one of a few axes separates them: their normals and the cross
    products of their edges, or, in one plane, the normals of their edges (separating axis theorem).
    """
    if len(mesh.faces) < 2:
        return np.empty((0, 2), np.intp)
    corners = mesh.corners - mesh.vertices.mean(axis=0)  # near the origin: no cancellation
    lo, hi = corners.min(axis=1), corners.max(axis=1)
    touch = _TOUCH * (hi - lo).max(axis=1)
    # pairs whose boxes meet, and whose planes do not separate them
    first, last = _ranges_of_cells(lo, hi)
    pairs = _near_pairs(lo, hi, first, *_boxes_in_cells(first, last))
    flat = np.ones(len(pairs), bool)
    places, normals = np.ascontiguousarray(corners.T), np.ascontiguousarray(mesh.normals.T)
    for this, other in ((0, 1), (1, 0)):
        pierced, level = _against_plane(places, normals, touch, pairs[:, this], pairs[:, other])
        pairs, flat = pairs[pierced | level], (flat & level)[pierced | level]
    # the other axes: in space the products of two edges, in a common plane the normals of the edges
    space, plane = pairs[~flat], pairs[flat]
    edge, side = (corners[some] - np.roll(corners[some], 1, axis=2) for some in (space, plane))
    products = [(edge[:, 0, i], edge[:, 1, j]) for i in range(3) for j in range(3)]
    normal = np.cross(side[:, 0, 1], -side[:, 0, 0])
    in_plane = [(normal, side[:, k, i]) for k in (0, 1) for i in range(3)]
    cross = _overlap(corners[space], touch[space].max(axis=1), products)
    cover = _overlap(corners[plane], touch[plane].max(axis=1), in_plane) & normal.any(axis=1)  # not without area
    return np.concatenate([space[cross], plane[cover]])


def _ranges_of_cells(lo: NDArray, hi: NDArray) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First and last cell of each box, shape (N, 3), in a grid of cells of about the size of a face."""
    origin, span = lo.min(axis=0), hi.max(axis=0) - lo.min(axis=0)
    cell = np.maximum(1.5 * (hi - lo).mean(axis=0), span / _MAX_CELLS).clip(1e-12)
    first, last = ((edge - origin) // cell for edge in (lo, hi))
    return first.astype(np.int64), last.astype(np.int64)


def _boxes_in_cells(first: NDArray[np.int64], last: NDArray[np.int64]) -> tuple[NDArray[np.intp], NDArray[np.int64]]:
    """Every cell each box reaches into: box number, shape (N,), and cell, shape (N, 3)."""
    sides = last - first + 1
    count = sides.prod(axis=1)
    box = np.repeat(np.arange(len(first)), count)
    rank = np.arange(len(box)) - np.repeat(np.cumsum(count) - count, count)
    k = rank % sides[box, 2]
    j = rank // sides[box, 2] % sides[box, 1]
    i = rank // (sides[box, 2] * sides[box, 1])
    return box, first[box] + np.stack([i, j, k], axis=1)


def _near_pairs(
    lo: NDArray, hi: NDArray, first: NDArray[np.int64], box: NDArray[np.intp], cell: NDArray[np.int64]
) -> NDArray[np.intp]:
    """Pairs of boxes that overlap, shape (N, 2), given the first cell of each box and the boxes in each cell."""
    # entries of one cell lie side by side once they are sorted
    key = np.ravel_multi_index(tuple(cell.T), tuple(cell.max(axis=0) + 1)).astype(np.int32)
    order = np.argsort(key, kind="stable")
    box, cell, key = box[order], cell[order], key[order]
    low, high = lo[box].T.copy(), hi[box].T.copy()
    begins = ((first[box] == cell) << np.arange(3)).sum(axis=1).astype(np.uint8)  # a bit for each axis
    found, i, gap = [np.empty((0, 2), np.intp)], np.arange(len(key)), 1
    while len(i):  # each entry against the gap-th after it, as long as both lie in one cell
        i = i[: np.searchsorted(i, len(key) - gap)]
        i = i[key[i] == key[i + gap]]
        # each pair once: in the first cell both share, where along each axis one of them begins
        a = i[(begins[i] | begins[i + gap]) == 7]
        for lows, highs in zip(low, high, strict=True):
            b = a + gap
            a = a[(lows[a] <= highs[b]) & (lows[b] <= highs[a])]
        pair = box[a], box[a + gap]
        found.append(np.stack([np.minimum(*pair), np.maximum(*pair)], axis=1))
        gap += 1
    return np.concatenate(found)


def _against_plane(
    places: NDArray, normals: NDArray, touch: NDArray, this: NDArray[np.intp], other: NDArray[np.intp]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Whether the other face reaches to both sides of this face's plane, and whether it lies in the plane.

    `places` are corners by axis, corner and face, shape (3, 3, F), and `normals` by axis and face, shape (3, F).
    """
    height = np.zeros((3, len(this)))
    for place, normal in zip(places, normals, strict=True):
        foot, share = place[0][this], normal[this]
        for k in range(3):
            height[k] += (place[k][other] - foot) * share
    lo, hi = height.min(axis=0), height.max(axis=0)
    slack = np.maximum(touch[this], touch[other])
    return (lo < -slack) & (hi > slack), (lo >= -slack) & (hi <= slack)


def _overlap(
    both: NDArray, touch: NDArray[np.float64], products: Sequence[tuple[NDArray, NDArray]]
) -> NDArray[np.bool_]:
    """Whether pairs of triangles, shape (N, 2, 3, 3), overlap along all axes, each the product of two vectors (N, 3).

    An axis of length 0 separates nothing.
    """
    overlap = np.ones(len(both), bool)
    for a, b in products:
        left = np.flatnonzero(overlap)  # what no earlier axis has separated
        axis, corners = np.cross(a[left], b[left]), both[left]
        along = [np.einsum("nd,nd->n", corners[:, p, k], axis) for p in (0, 1) for k in range(3)]
        heights = np.stack(along).reshape(2, 3, -1)
        lo, hi, length = heights.min(axis=1), heights.max(axis=1), np.linalg.norm(axis, axis=1)
        slack = touch[left] * length
        apart = ((hi[0] <= lo[1] + slack) | (hi[1] <= lo[0] + slack)) & (length > 0)
        overlap[left] = ~apart
    return overlap
