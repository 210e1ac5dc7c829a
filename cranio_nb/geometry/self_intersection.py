"""A triangle mesh -> the pairs of its faces that pass through each other.

Frame: any. Faces that only touch, at a shared corner, along a shared edge or side by side, do not count; two faces
folded flat onto each other do.
"""

from __future__ import annotations

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
    pairs = _near_pairs(lo, hi)
    flat = np.ones(len(pairs), bool)
    for this, other in ((0, 1), (1, 0)):
        pierced, level = _against_plane(corners, mesh.normals, touch, pairs[:, this], pairs[:, other])
        pairs, flat = pairs[pierced | level], (flat & level)[pierced | level]
    # the other axes: in space, or within the common plane
    across, beside = pairs[~flat], pairs[flat]
    found = [across[_cross_in_space(corners, touch, across)], beside[_overlap_in_plane(corners, touch, beside)]]
    return np.concatenate(found)


def _near_pairs(lo: NDArray, hi: NDArray) -> NDArray[np.intp]:
    """Pairs of boxes that overlap, shape (N, 2), found by sorting the boxes into the cells of a grid."""
    # cells of about the size of a face
    origin, span = lo.min(axis=0), hi.max(axis=0) - lo.min(axis=0)
    cell = np.maximum(1.5 * (hi - lo).mean(axis=0), span / _MAX_CELLS).clip(1e-12)
    first, last = ((edge - origin) // cell for edge in (lo, hi))
    face, at = _cells_of_boxes(first.astype(np.int64), last.astype(np.int64))
    # entries of one cell lie side by side once they are sorted
    grid = at.max(axis=0) + 1
    key = np.ravel_multi_index(tuple(at.T), tuple(grid))
    order = np.argsort(key, kind="stable")
    face, key = face[order], key[order]
    found, i, gap = [np.empty((0, 2), np.intp)], np.arange(len(key)), 1
    while len(i):  # each entry against the gap-th after it, as long as both lie in one cell
        i = i[i + gap < len(key)]
        i = i[key[i] == key[i + gap]]
        pair = np.stack([face[i], face[i + gap]], axis=1)
        low = np.maximum(lo[pair[:, 0]], lo[pair[:, 1]])
        meet = (low <= np.minimum(hi[pair[:, 0]], hi[pair[:, 1]])).all(axis=1)
        home = np.ravel_multi_index(tuple(((low - origin) // cell).astype(np.int64).T), tuple(grid), mode="clip")
        found.append(np.sort(pair[meet & (home == key[i])], axis=1))  # each pair once: in the first cell they share
        gap += 1
    return np.concatenate(found)


def _cells_of_boxes(first: NDArray[np.int64], last: NDArray[np.int64]) -> tuple[NDArray[np.intp], NDArray[np.int64]]:
    """Every cell each box reaches into: box number, shape (N,), and cell, shape (N, 3)."""
    sides = last - first + 1
    count = sides.prod(axis=1)
    box = np.repeat(np.arange(len(first)), count)
    rank = np.arange(len(box)) - np.repeat(np.cumsum(count) - count, count)
    k = rank % sides[box, 2]
    j = rank // sides[box, 2] % sides[box, 1]
    i = rank // (sides[box, 2] * sides[box, 1])
    return box, first[box] + np.stack([i, j, k], axis=1)


def _against_plane(
    corners: NDArray, normals: NDArray, touch: NDArray, this: NDArray[np.intp], other: NDArray[np.intp]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Whether the other face reaches to both sides of this face's plane, and whether it lies in the plane."""
    foot, normal = corners[this, 0], normals[this]
    height = np.stack([np.einsum("nd,nd->n", corners[other, k] - foot, normal) for k in range(3)])
    lo, hi = height.min(axis=0), height.max(axis=0)
    slack = np.maximum(touch[this], touch[other])
    return (lo < -slack) & (hi > slack), (lo >= -slack) & (hi <= slack)


def _cross_in_space(corners: NDArray, touch: NDArray, pairs: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Whether no product of two edges separates the faces of each pair."""
    crossing = np.ones(len(pairs), bool)
    for i, j in ((i, j) for i in range(3) for j in range(3)):
        left = np.flatnonzero(crossing)
        both = corners[pairs[left]]
        axis = np.cross(both[:, 0, i] - both[:, 0, i - 1], both[:, 1, j] - both[:, 1, j - 1])
        crossing[left] = ~_apart(both, axis, touch[pairs[left]].max(axis=1))
    return crossing


def _overlap_in_plane(corners: NDArray, touch: NDArray, pairs: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Whether no edge separates the faces of pairs that lie in one plane; a face without area overlaps nothing."""
    both = corners[pairs]
    normal = np.cross(both[:, 0, 1] - both[:, 0, 0], both[:, 0, 2] - both[:, 0, 0])
    overlap = np.asarray(normal.any(axis=1))
    for side, i in ((side, i) for side in (0, 1) for i in range(3)):
        left = np.flatnonzero(overlap)
        axis = np.cross(normal[left], both[left, side, i] - both[left, side, i - 1])
        overlap[left] = ~_apart(both[left], axis, touch[pairs[left]].max(axis=1))
    return overlap


def _apart(both: NDArray, axis: NDArray, touch: NDArray) -> NDArray[np.bool_]:
    """Whether two triangles, shape (N, 2, 3, 3), do not overlap along an axis; an axis of length 0 says nothing."""
    length = np.linalg.norm(axis, axis=1)
    along = np.stack([np.einsum("nd,nd->n", both[:, p, k], axis) for p in (0, 1) for k in range(3)]).reshape(2, 3, -1)
    lo, hi = along.min(axis=1), along.max(axis=1)
    slack = touch * length
    return ((hi[0] <= lo[1] + slack) | (hi[1] <= lo[0] + slack)) & (length > 0)
