"""A bone mask -> its triangle mesh by marching tetrahedra.

Frame: `Volume` in voxel (plane, row, col), meshes in world mm (LPS).

Every cell between eight voxel centres is cut into the six tetrahedra of Freudenthal (1942), one for each order in
which a walk from its first to its last corner can take the three axes. All cells are cut alike, so the diagonals of
neighbours meet and the tetrahedra form one complex; the level set of the field that is linear on each of them is a
closed manifold for whatever mask, without the ambiguous cases of marching cubes (Doi and Koide 1991).
"""

from __future__ import annotations

from itertools import permutations

import numpy as np
from numpy.typing import NDArray

from ...mesh import Mesh
from ...volume import Volume

_WALKS = np.array([np.cumsum([[0, 0, 0], *np.eye(3, dtype=int)[list(p)]], axis=0) for p in permutations(range(3))])
"""Corners of the six tetrahedra in the order of their walks, shape (6, 4, 3)."""
_BITS = np.array([4, 2, 1])


def extract(mask: Volume) -> Mesh:
    """Closed surface of a mask; where the mask touches the border of its grid, it is closed there.

    Parameters
    ----------
    mask : Volume
        Bool (P, R, C), any affine.

    Returns
    -------
    Mesh
        Vertices midway between voxels of the two kinds; normals point out of the mask.
    """
    vertices, faces = march(np.pad(np.where(mask.voxels, np.float32(1), np.float32(-1)), 1, constant_values=-1))
    mirrored = np.linalg.det(mask.axes) < 0
    return Mesh(mask.to_world(vertices - 1), faces[:, ::-1].copy() if mirrored else faces)


def march(field: NDArray) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Zero level of a field that is linear on every tetrahedron.

    Parameters
    ----------
    field : ndarray, shape (P, R, C)
        Positive inside.

    Returns
    -------
    vertices : ndarray, shape (V, 3)
        Index coordinates.
    faces : ndarray of int, shape (F, 3)
        Wound so that normals point out where the axes (plane, row, col) are right-handed.
    """
    cells = _mixed_cells(field > 0)
    edges = [_cut(field, cells, walk) for walk in _WALKS]
    keys, faces = np.unique(np.concatenate(edges), return_inverse=True)
    low = np.stack(np.unravel_index(keys // 8, field.shape), axis=1)
    step = (keys[:, None] // _BITS % 8) % 2
    here, there = field[tuple(low.T)].astype(float), field[tuple((low + step).T)].astype(float)
    return low + step * (here / (here - there))[:, None], faces.reshape(-1, 3).astype(np.intp)


def _mixed_cells(inside: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Flat index of the first corner of every cell that has corners of both kinds."""
    every, some = inside, inside
    for axis in range(3):
        first, second = [slice(None)] * 3, [slice(None)] * 3
        first[axis], second[axis] = slice(None, -1), slice(1, None)
        every = every[tuple(first)] & every[tuple(second)]
        some = some[tuple(first)] | some[tuple(second)]
    return np.ravel_multi_index(np.nonzero(some & ~every), inside.shape).astype(np.int64)


def _cut(field: NDArray, cells: NDArray[np.int64], walk: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles in one tetrahedron of every cell, as keys of the cut edges, shape (n, 3).

    The key of an edge is 8 times the flat index of its first corner, plus its direction as three bits.
    """
    corners = cells[:, None] + np.ravel_multi_index(tuple(walk.T), field.shape)
    case = (field.ravel()[corners] > 0) @ (1 << np.arange(4))
    odd = np.linalg.det(walk[1:].astype(float)) < 0
    triangles = [np.empty((0, 3), np.int64)]
    for code, cuts in _CASES.items():
        hit = corners[case == code]
        for cut in cuts:
            keys = [8 * hit[:, a] + (walk[b] - walk[a]) @ _BITS for a, b in cut]
            triangles.append(np.stack(keys[::-1] if odd else keys, axis=1))
    return np.concatenate(triangles)


def _cases() -> dict[int, list[tuple[tuple[int, int], ...]]]:
    """For each set of inner corners, as bits, the triangles in a right-handed tetrahedron; a corner is a cut edge."""

    def edge(a: int, b: int) -> tuple[int, int]:
        return min(a, b), max(a, b)

    found: dict[int, list[tuple[tuple[int, int], ...]]] = {}
    for a, b, c, d in permutations(range(4)):
        if np.linalg.det(np.eye(4)[[a, b, c, d]]) < 0:
            continue
        tip = (edge(a, b), edge(a, c), edge(a, d))
        found[1 << a] = [tip]
        found[15 - (1 << a)] = [tip[::-1]]
        ring = (edge(a, c), edge(a, d), edge(b, d), edge(b, c))
        found[(1 << a) + (1 << b)] = [ring[:3], (ring[0], ring[2], ring[3])]
    return found


_CASES = _cases()
