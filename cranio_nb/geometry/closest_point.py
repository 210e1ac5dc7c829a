"""Points and a triangle mesh -> for each point the nearest place on the mesh, exactly.

Frame: any, the same for points and mesh; distances come out in its unit (mm for world meshes).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..errors import InputRefused
from ..mesh import Mesh

_CHUNK = 20_000  # points searched at once
_ON_EDGE = 1e-9  # a barycentric weight below this puts the place on an edge or a corner


@dataclass(frozen=True, eq=False)
class Nearest:
    """The nearest place on a mesh for each of N points.

    Parameters
    ----------
    distance : ndarray, shape (N,)
        Distance of the point from the mesh.
    face : ndarray of int, shape (N,)
        Face that holds the place.
    weights : ndarray, shape (N, 3)
        Barycentric weights of the place in its face.
    """

    distance: NDArray[np.float64]
    face: NDArray[np.intp]
    weights: NDArray[np.float64]

    def places(self, mesh: Mesh) -> NDArray[np.float64]:
        """The places themselves.

        Parameters
        ----------
        mesh : Mesh
            That was searched.

        Returns
        -------
        ndarray, shape (N, 3)
        """
        return np.einsum("nk,nkd->nd", self.weights, mesh.corners[self.face])


def nearest(points: NDArray[np.float64], mesh: Mesh) -> Nearest:
    """Nearest place on a mesh.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
        Points in the frame of the mesh.
    mesh : Mesh
        Open or closed.

    Returns
    -------
    Nearest
        Exact to rounding: every face that can be nearest is tried.

    Raises
    ------
    InputRefused
        ``EmptyMesh`` if the mesh has no faces.

    Examples
    --------
    >>> triangle = Mesh(np.array([[0.0, 0, 0], [4, 0, 0], [0, 4, 0]]), np.array([[0, 1, 2]]))
    >>> nearest(np.array([[1.0, 1, 2], [-3, 0, 4]]), triangle).distance
    array([2., 5.])
    """
    if not len(mesh.faces):
        raise InputRefused("EmptyMesh", "The mesh has no faces; a distance needs a surface.")
    points = np.asarray(points, float).reshape(-1, 3)
    best = Nearest(np.full(len(points), np.inf), np.zeros(len(points), np.intp), np.zeros((len(points), 3)))
    reach = np.linalg.norm(mesh.corners - mesh.centres[:, None], axis=2).max(axis=1)
    # A few long faces would make every search wide: faces are searched in classes of like size.
    size_class = np.floor(np.log2(np.maximum(reach, np.finfo(float).tiny)))
    for size in np.unique(size_class):
        faces = np.flatnonzero(size_class == size)
        tree, radius = cKDTree(mesh.centres[faces]), reach[faces].max()
        # the face with the nearest centre gives a distance not to be exceeded
        far, near = tree.query(points)
        _take_better(best, points, mesh, np.arange(len(points)), faces[near])
        # then all faces that could be nearer are tried
        unsure = np.flatnonzero(far - radius < best.distance)
        for some in np.array_split(unsure, 1 + len(unsure) // _CHUNK):
            lists = tree.query_ball_point(points[some], best.distance[some] + radius, return_sorted=False)
            count = np.fromiter(map(len, lists), np.intp, len(lists))
            point = np.repeat(some, count)
            face = faces[np.fromiter(chain.from_iterable(lists), np.intp, count.sum())]
            hopeful = _disc_distance(points[point], mesh, face, reach) < best.distance[point]
            _take_better(best, points, mesh, point[hopeful], face[hopeful])
    return best


def _disc_distance(points: NDArray, mesh: Mesh, face: NDArray[np.intp], reach: NDArray) -> NDArray[np.float64]:
    """Distance from each point to the disc around a face: never more than to the face."""
    offset = points - mesh.centres[face]
    height = np.einsum("nd,nd->n", offset, mesh.normals[face])
    aside = np.sqrt(np.maximum(np.einsum("nd,nd->n", offset, offset) - height**2, 0))
    return np.hypot(height, np.maximum(aside - reach[face] * (1 + 1e-9), 0)) * (1 - 1e-9)


def _take_better(best: Nearest, points: NDArray, mesh: Mesh, point: NDArray[np.intp], face: NDArray[np.intp]) -> None:
    """Measure pairs of point and face, and keep for each point what is nearer than its best so far."""
    corners = mesh.corners[face] - points[point][:, None]
    weights = origin_on_triangles(corners)
    distance = np.linalg.norm(np.einsum("nk,nkd->nd", weights, corners), axis=1)
    order = np.argsort(-distance, kind="stable")
    order = order[distance[order] < best.distance[point[order]]]
    # farthest first: of several faces for one point the nearest is written last and stays
    best.distance[point[order]] = distance[order]
    best.face[point[order]] = face[order]
    best.weights[point[order]] = weights[order]


def origin_on_triangles(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Barycentric weights of the place on each triangle nearest to the origin.

    Parameters
    ----------
    corners : ndarray, shape (N, 3, 3)
        Corner positions; a triangle without area counts as its edges.

    Returns
    -------
    ndarray, shape (N, 3)
        Weights >= 0 that sum to 1.

    Notes
    -----
    The foot of the perpendicular where it falls inside; else the best of the three edges.

    Examples
    --------
    >>> origin_on_triangles(np.array([[[1.0, -1, 0], [1, 1, 0], [3, 0, 0]]]))
    array([[0.5, 0.5, 0. ]])
    """
    # the foot of the perpendicular, where it falls inside
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(b - a, c - a)
    square = np.einsum("nd,nd->n", normal, normal)
    inside = np.stack([np.einsum("nd,nd->n", np.cross(p, q), normal) for p, q in ((b, c), (c, a), (a, b))], axis=1)
    foot = (inside >= 0).all(axis=1) & (square > 0)
    weights = np.divide(inside, inside.sum(axis=1)[:, None], out=np.zeros_like(inside), where=foot[:, None])

    # elsewhere the nearest place of each edge, and of these the nearest
    start = corners[~foot]
    along = np.roll(start, -1, axis=1) - start
    square = np.einsum("nkd,nkd->nk", along, along)
    t = np.divide(-np.einsum("nkd,nkd->nk", start, along), square, out=np.zeros_like(square), where=square > 0)
    t = np.clip(t, 0, 1)
    place = start + t[..., None] * along
    edge = np.einsum("nkd,nkd->nk", place, place).argmin(axis=1)
    other, row = np.flatnonzero(~foot), np.arange(len(start))
    weights[other] = 0
    weights[other, edge] = 1 - t[row, edge]
    weights[other, (edge + 1) % 3] = t[row, edge]
    return weights


def pseudonormals(mesh: Mesh, found: Nearest) -> NDArray[np.float64]:
    """Normal of the mesh at each found place: of the face, the edge or the corner it lies on.

    Parameters
    ----------
    mesh : Mesh
    found : Nearest
        Places on it.

    Returns
    -------
    ndarray, shape (N, 3)
        Not of unit length. Its sign against (point - place) tells outside from inside.

    Notes
    -----
    Angle-weighted at corners (Baerentzen and Aanaes 2005, doi 10.1109/TVCG.2005.49); the two faces' sum at edges.

    Examples
    --------
    >>> triangle = Mesh(np.array([[0.0, 0, 0], [4, 0, 0], [0, 4, 0]]), np.array([[0, 1, 2]]))
    >>> pseudonormals(triangle, nearest(np.array([[1.0, 1, 2]]), triangle))
    array([[0., 0., 1.]])
    """
    normals = mesh.normals.copy()[found.face]
    on_edge = (found.weights <= _ON_EDGE).sum(axis=1) == 1
    on_corner = (found.weights <= _ON_EDGE).sum(axis=1) == 2
    opposite = found.weights[on_edge].argmin(axis=1)
    normals[on_edge] = _edge_normals(mesh)[found.face[on_edge], opposite]
    corner = found.weights[on_corner].argmax(axis=1)
    normals[on_corner] = _vertex_normals(mesh)[mesh.faces[found.face[on_corner], corner]]
    return normals


def _edge_normals(mesh: Mesh) -> NDArray[np.float64]:
    """Sum of the unit normals of the faces on each edge, shape (F, 3, 3); edge k lies opposite to corner k."""
    edges = np.sort(mesh.faces[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
    _, edge = np.unique(edges @ np.array([len(mesh.vertices), 1]), return_inverse=True)
    total = np.zeros((edge.max() + 1, 3))
    np.add.at(total, edge, np.repeat(mesh.normals, 3, axis=0))
    return total[edge].reshape(-1, 3, 3)


def _vertex_normals(mesh: Mesh) -> NDArray[np.float64]:
    """Sum of the unit normals of the faces at each vertex, weighted by their angle there, shape (V, 3)."""
    to_next = np.roll(mesh.corners, -1, axis=1) - mesh.corners
    to_last = -np.roll(to_next, 1, axis=1)
    across = np.linalg.norm(np.cross(to_next, to_last), axis=2)
    angle = np.arctan2(across, np.einsum("nkd,nkd->nk", to_next, to_last))
    total = np.zeros((len(mesh.vertices), 3))
    np.add.at(total, mesh.faces, angle[..., None] * mesh.normals[:, None])
    return total
