"""A designed surface and the true one as meshes -> how far apart they are; how thick a prosthesis is.

Frame: meshes in world mm; distances in mm, unless both meshes were taken `in_voxels` first.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..errors import InputRefused
from ..geometry.closest_point import nearest, pseudonormals
from ..mesh import INNER, OUTER, Mesh
from ..prosthesis import DistanceStats, Prosthesis
from ..volume import Volume


def surface_distance(nodes: NDArray[np.float64], other: Mesh) -> NDArray[np.float64]:
    """Distance from each node to the nearest place on another surface, one way, as in the paper's Table 3.

    Parameters
    ----------
    nodes : ndarray, shape (N, 3)
        Nodes of the surface to be judged: the top or the inner side of a prosthesis.
    other : Mesh
        The surface taken as the truth, open or closed.

    Returns
    -------
    ndarray, shape (N,)
        Unsigned, exact (to triangles, not to nodes); mm, or voxels where both were taken `in_voxels`.
    """
    return nearest(nodes, other).distance


def signed_distance(nodes: NDArray[np.float64], other: Mesh) -> NDArray[np.float64]:
    """`surface_distance` with a sign: positive where the node lies on the outer side of the other surface.

    Parameters
    ----------
    nodes : ndarray, shape (N, 3)
    other : Mesh

    Returns
    -------
    ndarray, shape (N,)
        mm. Where outer sides are compared, a positive one bulges and a negative one sinks in.

    Examples
    --------
    >>> triangle = Mesh(np.array([[0.0, 0, 0], [4, 0, 0], [0, 4, 0]]), np.array([[0, 1, 2]]))
    >>> signed_distance(np.array([[1.0, 1, 2], [1, 1, -3]]), triangle)
    array([ 2., -3.])
    """
    # sign by the angle-weighted normal at the nearest place, which holds at edges and corners too
    found = nearest(nodes, other)
    side = np.einsum("nd,nd->n", nodes - found.places(other), pseudonormals(other, found))
    return np.copysign(found.distance, side)


def distance_stats(distances: NDArray[np.float64]) -> DistanceStats:
    """A row of the paper's Table 3.

    Parameters
    ----------
    distances : ndarray, shape (N,)
        N > 0.

    Returns
    -------
    DistanceStats
        In the unit of the distances.

    Raises
    ------
    InputRefused
        ``EmptyMesh`` when there is none.

    Examples
    --------
    >>> distance_stats(np.array([1.0, 3.0]))
    DistanceStats(min=1.0, max=3.0, mean=2.0, std=1.0)
    """
    if not len(distances):
        raise InputRefused("EmptyMesh", "There are no distances to sum up; the surface has no nodes.")
    return DistanceStats(
        float(distances.min()), float(distances.max()), float(distances.mean()), float(distances.std())
    )


def in_voxels(mesh: Mesh, grid: Volume) -> Mesh:
    """The mesh in the (plane, row, col) frame of a grid, where distances count voxels as in the paper.

    Parameters
    ----------
    mesh : Mesh
        World mm.
    grid : Volume

    Returns
    -------
    Mesh
        Voxels.
    """
    return Mesh(grid.to_voxel(mesh.vertices), mesh.faces)


def thickness(prosthesis: Prosthesis) -> NDArray[np.float64]:
    """Distance from each node of the outer side to the inner side.

    Parameters
    ----------
    prosthesis : Prosthesis
        With both sides.

    Returns
    -------
    ndarray, shape (nodes of the outer surface,)
        mm.
    """
    return surface_distance(prosthesis.surface(OUTER).vertices, prosthesis.surface(INNER))


def thickness_rmse(prosthesis: Prosthesis, truth: Prosthesis) -> float:
    """Root mean square difference of thickness, at each outer node and the true outer node nearest to it.

    Parameters
    ----------
    prosthesis, truth : Prosthesis

    Returns
    -------
    float
        mm.
    """
    return thickness_error(prosthesis, thickness(prosthesis), truth, thickness(truth))


def thickness_error(
    prosthesis: Prosthesis, values: NDArray[np.float64], truth: Prosthesis, true_values: NDArray[np.float64]
) -> float:
    """`thickness_rmse` from the `thickness` of both, where that is known already.

    Parameters
    ----------
    prosthesis, truth : Prosthesis
    values, true_values : ndarray
        Their `thickness`, mm.

    Returns
    -------
    float
        mm.
    """
    nodes, true_nodes = prosthesis.surface(OUTER).vertices, truth.surface(OUTER).vertices
    if not len(nodes) or not len(true_nodes):
        raise InputRefused("EmptyMesh", "A prosthesis without an outer side has no thickness.")
    # the two meshes share no nodes: the nearest true node stands for the same place
    _, twin = cKDTree(true_nodes).query(nodes)
    return float(np.sqrt(np.square(values - true_values[twin]).mean()))
