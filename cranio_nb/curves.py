"""Plane curves: what the feature stage hands to the balloon, and the frame the balloon lives in.

Frames: slice (row, col) in px; chord (along, out) in px, with one gap end in the origin, the other at (L, 0), and
`out` pointing away from the head's inside (the paper's Fig. 4).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Points = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class GapEnds:
    """The two ends of a gap in one boundary curve.

    Parameters
    ----------
    points : ndarray, shape (2, 2)
        End points, slice (row, col) px.
    tangents : ndarray, shape (2, 2)
        Unit tangents of the boundary there, both pointing into the gap.
    """

    points: Points
    tangents: Points


@dataclass(frozen=True, eq=False)
class ChordFrame:
    """The reference system of the paper's Fig. 4.

    Parameters
    ----------
    origin : ndarray, shape (2,)
        First gap end, slice (row, col) px.
    axes : ndarray, shape (2, 2)
        Rows are the unit vectors `along` and `out` in slice (row, col).
    length : float
        Distance L between the ends, px.
    """

    origin: Points
    axes: Points
    length: float

    @classmethod
    def of(cls, ends: GapEnds, inside: ArrayLike) -> ChordFrame:
        """Frame of a gap.

        Parameters
        ----------
        ends : GapEnds
        inside : array_like, shape (2,)
            Any slice (row, col) on the head's inner side of the chord.

        Returns
        -------
        ChordFrame
        """
        # along the chord, and across it away from the inside
        chord = ends.points[1] - ends.points[0]
        length = float(np.hypot(*chord))
        along = chord / length
        out = np.array([-along[1], along[0]])
        if (np.asarray(inside, float) - ends.points.mean(axis=0)) @ out > 0:
            out = -out
        return cls(ends.points[0], np.array([along, out]), length)

    def to_chord(self, points: ArrayLike) -> Points:
        """Chord coordinates of points of the slice.

        Parameters
        ----------
        points : array_like, shape (..., 2)
            Slice (row, col), px.

        Returns
        -------
        ndarray, shape (..., 2)
            Chord (along, out), px.
        """
        return (np.asarray(points, float) - self.origin) @ self.axes.T

    def to_slice(self, points: ArrayLike) -> Points:
        """Points of the slice by their chord coordinates: the inverse of `to_chord`.

        Parameters
        ----------
        points : array_like, shape (..., 2)
            As `to_chord` returns them.

        Returns
        -------
        ndarray, shape (..., 2)
            As `to_chord` takes them.
        """
        return np.asarray(points, float) @ self.axes + self.origin

    def end_angles(self, ends: GapEnds) -> tuple[float, float]:
        """Angles of the end tangents above the chord.

        Parameters
        ----------
        ends : GapEnds

        Returns
        -------
        tuple of float
            theta0, about 0, and theta1, about pi; radians.
        """
        along, out = self.axes
        theta0, theta1 = np.arctan2(ends.tangents @ out, ends.tangents @ along)
        return float(theta0), float(theta1 % (2 * np.pi))


@dataclass(frozen=True, eq=False)
class Balloon:
    """Relaxed curves of the deformable model, and how they got there.

    Parameters
    ----------
    curve, start : ndarray, shape (..., n, 2)
        Final and initial snaxels, chord (along, out) px.
    n_iter : ndarray of int, shape (...)
        Steps until the curve stopped moving.
    converged : ndarray of bool, shape (...)
        Whether it stopped moving within the allowed steps.
    """

    curve: Points
    start: Points
    n_iter: NDArray[np.intp]
    converged: NDArray[np.bool_]


def arc_length(points: Points) -> NDArray[np.float64]:
    """Length along a polyline up to each of its points.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        px or mm.

    Returns
    -------
    ndarray, shape (n,)
        In the unit of the points, starting at 0.

    Examples
    --------
    >>> arc_length(np.array([[0.0, 0.0], [3.0, 4.0], [3.0, 5.0]]))
    array([0., 5., 6.])
    """
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])


def resample(points: Points, n: int) -> Points:
    """Points equally spaced along a polyline.

    Parameters
    ----------
    points : ndarray, shape (m, 2)
    n : int
        Number wanted.

    Returns
    -------
    ndarray, shape (n, 2)
        Ends kept.

    Examples
    --------
    >>> resample(np.array([[0.0, 0.0], [0.0, 1.0], [0.0, 4.0]]), 3)
    array([[0., 0.], [0., 2.], [0., 4.]])
    """
    # even lengths along the polyline, each coordinate linear in between
    at = arc_length(points)
    even = np.linspace(0, at[-1], n)
    return np.stack([np.interp(even, at, axis) for axis in points.T], axis=1)


def normals(curves: Points) -> Points:
    """Unit normals of curves.

    Parameters
    ----------
    curves : ndarray, shape (..., n, 2)
        Running along +x, with `out` = +y.

    Returns
    -------
    ndarray, shape (..., n, 2)
        At the ends one-sided.

    Examples
    --------
    >>> normals(np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]))[1].tolist()
    [-0.0, 1.0]
    """
    # tangent by central differences, turned by a quarter
    step = np.gradient(curves, axis=-2)
    normal = np.stack([-step[..., 1], step[..., 0]], axis=-1)
    return normal / np.maximum(np.linalg.norm(step, axis=-1, keepdims=True), 1e-12)


def cubic(length: ArrayLike, theta0: ArrayLike, theta1: ArrayLike, n: int) -> Points:
    """The paper's start curve, eq. (3).

    Parameters
    ----------
    length : array_like, shape (...)
        L, px.
    theta0, theta1 : array_like, shape (...)
        End angles in radians; theta1 is obtuse, so its tangent is negative for an outward bulge.
    n : int
        Number of snaxels.

    Returns
    -------
    ndarray, shape (..., n, 2)
        Chord (along, out): zero height at both ends, slopes tan(theta0) and tan(theta1).

    Examples
    --------
    >>> cubic(8.0, np.pi / 4, 3 * np.pi / 4, 3).round(9) + 0.0
    array([[0., 0.], [4., 2.], [8., 0.]])
    """
    # eq. (3) with s = x / L: y = L ((t0 + t1) s^3 - (2 t0 + t1) s^2 + t0 s)
    length, t0, t1 = np.broadcast_arrays(np.asarray(length, float), np.tan(theta0), np.tan(theta1))
    s = np.linspace(0, 1, n)
    length, t0, t1 = length[..., None], t0[..., None], t1[..., None]
    height = length * ((t0 + t1) * s**3 - (2 * t0 + t1) * s**2 + t0 * s)
    return np.stack([length * s, height], axis=-1)


def _gauss(n_nodes: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Places and weights of Gauss's quadrature from 0 to 1."""
    places, weights = np.polynomial.legendre.leggauss(n_nodes)
    return (places + 1) / 2, weights / 2


def spiral(length: ArrayLike, theta0: ArrayLike, theta1: ArrayLike, n: int) -> tuple[Points, NDArray[np.float64]]:
    """Euler spiral between two end tangents: curvature linear in arc length, an exact arc where the ends agree.

    Parameters
    ----------
    length, theta0, theta1, n
        As for `cubic`; the angles may be steep, up to about 120 degrees above the chord.

    Returns
    -------
    points : ndarray, shape (..., n, 2)
        Chord (along, out), equally spaced along the curve.
    curvature : ndarray, shape (..., n)
        1 / px, positive where the curve bulges outward.

    Notes
    -----
    With heading a(t) = a0 + (a1 - a0 - A) t + A t^2 the curve returns to the chord when the integral of sin a(t)
    vanishes; A follows by Newton's method from A = 3 (a0 + a1) (Bertolazzi and Frego 2015, G1 fitting with clothoids).
    """
    # Newton's method for the bend A that brings the curve back to the chord
    length = np.asarray(length, float)[..., None]
    a0 = np.asarray(theta0, float)[..., None]
    a1 = np.asarray(theta1, float)[..., None] - np.pi
    t, w = _gauss(24)
    bend = 3 * (a0 + a1)
    for _ in range(8):
        heading = a0 + (a1 - a0 - bend) * t + bend * t**2
        miss = (w * np.sin(heading)).sum(-1, keepdims=True)
        slope = (w * np.cos(heading) * (t**2 - t)).sum(-1, keepdims=True)
        bend = bend - miss / slope
    # the length of the curve, and its points by integration of the heading from one to the next
    total = length / (w * np.cos(a0 + (a1 - a0 - bend) * t + bend * t**2)).sum(-1, keepdims=True)
    # eight nodes a step: exact to rounding where a step turns by less than a radian
    s, (t, w) = np.linspace(0, 1, n), _gauss(8)
    steps = s[:-1, None] + t * (s[1] - s[0])
    heading = a0[..., None] + (a1 - a0 - bend)[..., None] * steps + bend[..., None] * steps**2
    walk = np.stack([(w * np.cos(heading)).sum(-1), (w * np.sin(heading)).sum(-1)], axis=-1) * (s[1] - s[0])
    points = np.zeros((*walk.shape[:-2], n, 2))
    points[..., 1:, :] = np.cumsum(walk, axis=-2) * total[..., None]
    return points, -((a1 - a0 - bend) + 2 * bend * s) / total


@dataclass(frozen=True, eq=False)
class SliceFeatures:
    """What one slice shows of the bone (the paper's Figs. 2 and 3).

    Parameters
    ----------
    boundary : ndarray, shape (M, 2)
        Boundary pixels B of the bone, slice (row, col).
    skeleton : tuple of ndarray, shape (K, 2) each
        Spine of each piece of bone, longest first: the longest geodesic path of its skeleton, in order.
    hull : ndarray, shape (H, 3)
        Convex hull S of the skeleton as half-planes a row + b col + c <= 0.
    closed : bool
        Whether the bone is a closed ring: no gap here, at most partial loss (the paper's Fig. 6).
    """

    boundary: Points
    skeleton: tuple[Points, ...]
    hull: Points
    closed: bool

    @property
    def in_hull(self) -> NDArray[np.bool_]:
        """Which boundary pixels lie in the hull.

        Returns
        -------
        ndarray of bool, shape (M,)
        """
        return np.all(self.boundary @ self.hull[:, :2].T + self.hull[:, 2] <= 1e-9, axis=1)

    @property
    def outer(self) -> Points:
        """Outer boundary B - S.

        Returns
        -------
        ndarray, shape (m, 2)
            Slice (row, col), px.
        """
        return self.boundary[~self.in_hull]

    @property
    def inner(self) -> Points:
        """Inner boundary: B and S.

        Returns
        -------
        ndarray, shape (m, 2)
            Slice (row, col), px.
        """
        return self.boundary[self.in_hull]
