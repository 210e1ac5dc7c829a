"""A triangle mesh -> can it be built: closed, manifold, in one part, without self-intersection, nowhere too thin.

Frame: world mm.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from ..mesh import Mesh
from .self_intersection import crossings

_FACING = 30.0  # mm of distance that a wall's other side may cost before it need not face this side any more
_WALL_SAMPLES = 20_000
_LEAF = 64  # points of a cell of the search


@dataclass(frozen=True)
class MeshReport:
    """What a mesh is, as whoever must build it asks.

    Parameters
    ----------
    n_vertices, n_faces : int
        Counts.
    n_unclear : int
        Faces that make no sense by themselves: not finite, without area, or there twice.
    n_open_edges : int
        Edges that do not join exactly two faces; 0 for a closed, edge-manifold mesh.
    n_flipped_edges : int
        Edges whose two faces disagree on what is outside.
    n_pinches : int
        Vertices at which separate fans of faces meet, counted once for each fan too many; 0 if vertex-manifold.
    n_parts : int
        Pieces that no edge connects.
    volume : float
        mm3; positive if the normals point outward.
    n_crossings : int
        Pairs of faces that pass through each other.
    wall_p1 : float
        Wall thickness in mm that 99 % of the surface exceeds; nan if the mesh is not closed.
    """

    n_vertices: int
    n_faces: int
    n_unclear: int
    n_open_edges: int
    n_flipped_edges: int
    n_pinches: int
    n_parts: int
    volume: float
    n_crossings: int
    wall_p1: float

    @property
    def closed(self) -> bool:
        """Whether every edge joins exactly two faces (edge-manifold, watertight).

        Returns
        -------
        bool
        """
        return self.n_faces > 0 and self.n_open_edges == 0

    @property
    def manifold(self) -> bool:
        """Whether the mesh is closed, of one orientation, and without pinches.

        Returns
        -------
        bool
        """
        return self.closed and self.n_flipped_edges == 0 and self.n_pinches == 0

    @property
    def sound(self) -> bool:
        """Whether it is a solid: manifold, of positive volume, without unclear faces or self-intersection.

        Returns
        -------
        bool
        """
        return self.manifold and self.volume > 0 and self.n_unclear == 0 and self.n_crossings == 0


def check_mesh(mesh: Mesh) -> MeshReport:
    """Check a mesh; any mesh, also an empty or a broken one.

    Parameters
    ----------
    mesh : Mesh
        World mm.

    Returns
    -------
    MeshReport

    Examples
    --------
    >>> tetrahedron = Mesh(np.array([[0.0, 0, 0], [6, 0, 0], [0, 6, 0], [0, 0, 6]]),
    ...                    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    >>> check_mesh(tetrahedron).sound, check_mesh(Mesh(tetrahedron.vertices, tetrahedron.faces[1:])).n_open_edges
    (True, 3)
    """
    # what needs closed walls or finite vertices is not measured without them
    finite = bool(np.isfinite(mesh.vertices).all())
    first, n_faces_at = _edges(mesh)
    fans, used = _fans(mesh, first)
    closed = len(mesh.faces) > 0 and bool((n_faces_at == 2).all())
    # the search for the other side of the wall, in compiled code, leaves the processor to the rest
    with ThreadPoolExecutor(1) as beside:
        wall = beside.submit(_wall_p1, mesh) if finite and closed else None
        n_crossings = len(crossings(mesh)) if finite else 0
    return MeshReport(
        n_vertices=len(mesh.vertices),
        n_faces=len(mesh.faces),
        n_unclear=int(np.count_nonzero(_unclear_faces(mesh))),
        n_open_edges=int(np.count_nonzero(n_faces_at != 2)),
        n_flipped_edges=_flipped_edges(mesh),
        n_pinches=fans - used,
        n_parts=_parts(mesh, first),
        volume=mesh.volume if finite else float("nan"),
        n_crossings=n_crossings,
        wall_p1=float("nan") if wall is None else wall.result(),
    )


def is_closed(mesh: Mesh) -> bool:
    """Whether every edge joins two faces that are wound alike.

    Parameters
    ----------
    mesh : Mesh

    Returns
    -------
    bool

    Examples
    --------
    >>> tetrahedron = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> is_closed(Mesh(np.eye(4, 3), tetrahedron)), is_closed(Mesh(np.eye(4, 3), tetrahedron[1:]))
    (True, False)
    """
    return bool((_edges(mesh)[1] == 2).all()) and _flipped_edges(mesh) == 0


def _wall_p1(mesh: Mesh) -> float:
    """Wall thickness that a hundredth of the surface falls short of, mm."""
    return float(np.percentile(wall_thickness(mesh), 1))


def wall_thickness(mesh: Mesh) -> NDArray[np.float64]:
    """Wall thickness seen from evenly picked faces of a closed mesh.

    Parameters
    ----------
    mesh : Mesh
        Closed, with faces small against the wall.

    Returns
    -------
    ndarray, shape (min(F, 20000),)
        mm from the centre of a face to the centre of the face that best lies near and faces the other way. The
        search weighs a turn of 60 deg away from facing like 30 mm of distance.
    """
    # place and normal as one point of six numbers: the other side has the opposite normal
    # in six dimensions plain cells, not shrunk around their points, are searched in half the time; large ones, in less
    centres, facing = mesh.centres, _FACING * mesh.normals
    tree = cKDTree(np.hstack([centres, facing]), _LEAF, compact_nodes=False, balanced_tree=False)
    some = np.arange(0, len(mesh.faces), max(1, -(-len(mesh.faces) // _WALL_SAMPLES)))
    _, other = tree.query(np.hstack([centres[some], -facing[some]]))
    return np.linalg.norm(centres[other] - centres[some], axis=1)


def _unclear_faces(mesh: Mesh) -> NDArray[np.bool_]:
    """Faces that are not finite, have no area, or share all corners with an earlier face."""
    # not finite, or without area
    finite = np.isfinite(mesh.corners).all(axis=(1, 2))
    area = np.zeros(len(mesh.faces))
    area[finite] = Mesh(mesh.vertices, mesh.faces[finite]).areas
    # the same three corners as an earlier face, in whatever order
    corners = np.sort(mesh.faces, axis=1)
    order = np.lexsort(corners.T)
    again = np.zeros(len(mesh.faces), bool)
    again[order[1:]] = (corners[order[1:]] == corners[order[:-1]]).all(axis=1)
    return ~(area > 0) | again


def _directed_edges(mesh: Mesh) -> NDArray[np.intp]:
    """The three edges of every face in its winding, shape (3 F, 2)."""
    return mesh.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)


def _edge_keys(ends: NDArray[np.intp], n_vertices: int) -> NDArray[np.int64]:
    return ends[:, 0].astype(np.int64) * n_vertices + ends[:, 1]


def _edges(mesh: Mesh) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """For every directed edge the first that joins the same vertices, and how many faces each edge joins."""
    keys = _edge_keys(np.sort(_directed_edges(mesh), axis=1), len(mesh.vertices))
    _, first, which, counts = np.unique(keys, return_index=True, return_inverse=True, return_counts=True)
    return first[which], counts


def _flipped_edges(mesh: Mesh) -> int:
    """Directed edges that more than one face runs along."""
    keys = np.sort(_edge_keys(_directed_edges(mesh), len(mesh.vertices)))  # numpy.unique takes twenty times as long
    return int(np.count_nonzero(keys[1:] == keys[:-1]))


def _fans(mesh: Mesh, first: NDArray[np.intp]) -> tuple[int, int]:
    """Number of fans of faces around vertices, and of vertices in use; a fan is a run of faces joined by edges."""
    # two faces on an edge share both of its ends: their corners there belong to one fan
    edge = np.flatnonzero(first != np.arange(len(first)))
    twin = first[edge]
    start, end = edge, _next_corner(edge)
    twin_start, twin_end = twin, _next_corner(twin)
    same = mesh.faces.ravel()[start] == mesh.faces.ravel()[twin_start]
    # links join corners, numbered 3 f + k, at both ends of the edge; twins may run either way
    links = np.concatenate(
        [
            np.stack([start, np.where(same, twin_start, twin_end)], axis=1),
            np.stack([end, np.where(same, twin_end, twin_start)], axis=1),
        ]
    )
    return _count_components(links, mesh.faces.size), len(np.unique(mesh.faces))


def _next_corner(corner: NDArray[np.intp]) -> NDArray[np.intp]:
    """The next corner of the same face, for corners numbered 3 f + k."""
    return corner - corner % 3 + (corner + 1) % 3


def _parts(mesh: Mesh, first: NDArray[np.intp]) -> int:
    """Number of pieces that edges hold together."""
    faces = np.stack([np.arange(len(first)) // 3, first // 3], axis=1)
    return _count_components(faces, len(mesh.faces))


def _count_components(links: NDArray[np.intp], n_nodes: int) -> int:
    if n_nodes == 0:
        return 0
    graph = sparse.coo_array((np.ones(len(links), bool), (links[:, 0], links[:, 1])), shape=(n_nodes, n_nodes))
    return int(connected_components(graph, directed=False)[0])
