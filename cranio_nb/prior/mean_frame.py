"""The frame of the mean head: its place in a skull, and directions spread evenly about it.

Frames: head (x, y, z), the mean head's own: x to the left, y to the back, z up, its plane of symmetry at x = 0, in mm
of the mean head; world mm (LPS).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, cKDTree

Array = NDArray[np.float64]

MIRROR = np.array([-1.0, 1.0, 1.0])
"""Turns a point of the mean frame into its mirror image."""


@dataclass(frozen=True, eq=False)
class MeanFrame:
    """An affine map from the mean head to a skull: world = origin + matrix @ head.

    Parameters
    ----------
    matrix : ndarray, shape (3, 3)
    origin : ndarray, shape (3,)
        World mm of the mean frame's origin, inside the cranial cavity.
    misfit_mm : float
        70 % of the skull's points lie closer to the mean head than this, mm.

    Examples
    --------
    >>> MeanFrame(2 * np.eye(3), np.array([0.0, 0.0, 10.0])).to_world(np.array([1.0, 0.0, 3.0]))
    array([ 2.,  0., 16.])
    """

    matrix: Array
    origin: Array
    misfit_mm: float = 0.0

    def stretch(self, directions: Array) -> Array:
        """How long a mm of the mean frame is in the world.

        Parameters
        ----------
        directions : ndarray, shape (..., 3)
            Unit vectors, mean frame.

        Returns
        -------
        ndarray, shape (...)
            World mm for each mm along the directions.
        """
        return np.linalg.norm(directions @ self.matrix.T, axis=-1)

    def to_world(self, points: Array) -> Array:
        """World positions of points of the mean frame.

        Parameters
        ----------
        points : ndarray, shape (..., 3)
            mm of the mean frame.

        Returns
        -------
        ndarray, shape (..., 3)
            World mm.
        """
        return self.origin + points @ self.matrix.T


def even_directions(halvings: int) -> Array:
    """Unit vectors spread evenly over all directions, symmetric about x = 0: a halved icosahedron.

    Parameters
    ----------
    halvings : int
        How often each edge is halved.

    Returns
    -------
    ndarray, shape (10 * 4 ** halvings + 2, 3)

    Examples
    --------
    >>> even_directions(2).shape
    (162, 3)
    """
    # the corners of an icosahedron
    golden = (1 + np.sqrt(5)) / 2
    corners = np.array([(0, a, b * golden) for a in (-1, 1) for b in (-1, 1)])
    points = np.concatenate([np.roll(corners, k, axis=1) for k in range(3)])
    # each halving adds the middle of every edge
    for _ in range(halvings):
        points /= np.linalg.norm(points, axis=1)[:, None]
        faces = np.sort(ConvexHull(points).simplices, axis=1)
        edges = np.unique(np.concatenate([faces[:, [0, 1]], faces[:, [0, 2]], faces[:, [1, 2]]]), axis=0)
        points = np.concatenate([points, points[edges].mean(axis=1)])
    points /= np.linalg.norm(points, axis=1)[:, None]
    return points[np.lexsort(np.round(points, 9).T)]


def mirror_index(directions: Array) -> NDArray[np.intp]:
    """Which direction is the mirror image of which.

    Parameters
    ----------
    directions : ndarray, shape (n, 3)
        Unit vectors, symmetric about x = 0.

    Returns
    -------
    ndarray of int, shape (n,)

    Examples
    --------
    >>> mirror_index(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]]))
    array([2, 1, 0])
    """
    return cKDTree(directions).query(directions * MIRROR)[1]
