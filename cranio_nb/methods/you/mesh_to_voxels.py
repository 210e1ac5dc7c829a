"""A closed mesh -> the voxels inside it.

Frame: the mesh in world mm (LPS), the answer on a grid in voxel (plane, row, col).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...mesh import Mesh
from ...volume import Volume

_ASIDE = np.array([1.37e-6, 2.11e-6])  # voxels: no line through voxel centres meets an edge of the mesh


def fill_mesh(mesh: Mesh, grid: Volume) -> NDArray[np.bool_]:
    """Voxels whose centre a closed mesh winds around.

    Parameters
    ----------
    mesh : Mesh
        Closed; parts that overlap count once.
    grid : Volume
        Only its shape and place are used.

    Returns
    -------
    ndarray of bool, shape (P, R, C)

    Notes
    -----
    Every face adds its sign where a line of voxels along the planes passes through it; their sum from below is the
    winding number.
    """
    # columns of voxels along the planes, moved aside by far less than a voxel: none meets an edge
    corners = grid.to_voxel(mesh.corners)
    flat = corners[:, :, 1:] - _ASIDE
    # the columns within each face's box
    first = np.maximum(np.ceil(flat.min(axis=1)).astype(int), 0)
    last = np.minimum(np.floor(flat.max(axis=1)).astype(int), np.array(grid.shape[1:]) - 1)
    face, line = _lines(first, last)
    # where a column passes a face, and whether it leaves (+1) or enters (-1) there
    height, sign = _pierced(corners[face, :, 0], flat[face] - line[:, None])
    hit = sign != 0
    # a crossing counts from the first voxel above it on; the running sum is the winding number
    plane = np.clip(np.ceil(height[hit]), 0, grid.shape[0]).astype(int)
    turns = np.zeros((grid.shape[0] + 1, *grid.shape[1:]), np.int8)
    np.add.at(turns, (plane, *line[hit].T), sign[hit])
    found: NDArray[np.bool_] = np.cumsum(turns[:-1], axis=0, dtype=np.int8) != 0
    return found


def _lines(first: NDArray[np.intp], last: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Every (row, col) in the boxes first..last: the box's number, shape (N,), and the line, shape (N, 2)."""
    # box sizes, one entry for each line
    sides = np.maximum(last - first + 1, 0)
    count = sides.prod(axis=1)
    box = np.repeat(np.arange(len(first)), count)
    # each entry's number within its box -> (row, col)
    rank = np.arange(len(box)) - np.repeat(np.cumsum(count) - count, count)
    width = sides[box, 1]
    return box, first[box] + np.stack([rank // width, rank % width], axis=1)


def _pierced(planes: NDArray, flat: NDArray) -> tuple[NDArray[np.float64], NDArray[np.int8]]:
    """Plane coordinate where the line (0, 0) passes each triangle, and the sense: +1 or -1, 0 where it misses."""
    # barycentric weights of (0, 0): areas of the triangles it makes with each edge
    a, b, c = np.moveaxis(flat, 1, 0)
    parts = np.stack([_cross(b, c), _cross(c, a), _cross(a, b)])
    total = parts.sum(axis=0)
    missed = ~((parts > 0).all(axis=0) | (parts < 0).all(axis=0))
    # plane coordinate by these weights; all of one sign means inside
    height = np.einsum("kn,nk->n", parts, planes) / np.where(missed, 1.0, total)
    return height, np.where(missed, 0, np.sign(total)).astype(np.int8)


def _cross(a: NDArray, b: NDArray) -> NDArray[np.float64]:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
