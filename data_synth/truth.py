"""A closed-form head with defects, one plane -> the gaps in that slice: end points, tangents and true curves.

Frame: slice (row, col) px, found by intersecting the closed-form surfaces with the plane; no voxels are involved.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .head import HeadShape

Array = NDArray[np.float64]
_N_RAYS = 720
_N_CURVE = 101


@dataclass(frozen=True, eq=False)
class Gap:
    """The missing stretch of one surface in one slice.

    Parameters
    ----------
    ends : ndarray, shape (2, 2)
        Slice (row, col) px of its ends, in the order of growing angle from columns towards rows.
    tangents : ndarray, shape (2, 2)
        Unit (row, col) tangents of the true curve there, both pointing into the gap.
    curve : ndarray, shape (101, 2)
        The true curve from end to end.
    angles : ndarray, shape (2,)
        Degrees between the chord and the tangents, measured at both ends from the chord's own direction towards
        the outside of the head: the paper's theta0 and theta1.
    """

    ends: Array
    tangents: Array
    curve: Array
    angles: Array

    @property
    def chord(self) -> float:
        """Distance between the ends in px."""
        return float(np.linalg.norm(self.ends[1] - self.ends[0]))


@dataclass(frozen=True, eq=False)
class SliceTruth:
    """What one defect takes away in one slice.

    Parameters
    ----------
    plane : float
        Plane index.
    defect : int
        Index of the cutter.
    outer, inner : Gap or None
        Gap of the outer and of the inner surface; None where that surface is whole.
    """

    plane: float
    defect: int
    outer: Gap | None
    inner: Gap | None

    @property
    def is_open(self) -> bool:
        """Whether both surfaces are missing, so that the ring of bone is open."""
        return self.outer is not None and self.inner is not None

    def as_dict(self) -> dict[str, Any]:
        """JSON-able ends, tangents and angles.

        Returns
        -------
        dict
            plane, defect, open; outer and inner with ends and tangents (px) and angles (degrees), None where whole.
        """
        record: dict[str, Any] = {"plane": self.plane, "defect": self.defect, "open": self.is_open}
        for name, gap in (("outer", self.outer), ("inner", self.inner)):
            record[name] = gap and {
                "ends": gap.ends.tolist(),
                "tangents": gap.tangents.tolist(),
                "angles": gap.angles.tolist(),
            }
        return record


@dataclass(frozen=True, eq=False)
class _Plane:
    """One plane of a scan and one surface of the head, followed around by an angle."""

    head: HeadShape
    affine: Array
    index: float
    surface: int  # 0 outer, 1 inner

    def point(self, angle: Array) -> Array:
        """Offsets (..., 3) from the head's centre of the surface's points in the plane at angles (...)."""
        start, rows, cols = self.frame()
        ray = np.cos(angle)[..., None] * cols + np.sin(angle)[..., None] * rows
        low, high = np.zeros(angle.shape), np.full(angle.shape, 200.0)
        for _ in range(12):
            middle = (low + high) / 2
            inside = self.depth(start + middle[..., None] * ray) > 0
            low, high = np.where(inside, middle, low), np.where(inside, high, middle)
        for _ in range(3):
            p = start + low[..., None] * ray
            low = low + self.depth(p) / (self.head.gradients(p)[self.surface] * ray).sum(-1)
        return start + low[..., None] * ray

    def depth(self, p: Array) -> Array:
        """How far points (..., 3) lie inside the surface, mm along the ray from the centre."""
        length = np.linalg.norm(p, axis=-1)
        return self.radius(p) - length

    def radius(self, p: Array) -> Array:
        """Radii (...) of the surface in mm, along the rays through points (..., 3)."""
        d = p / np.linalg.norm(p, axis=-1, keepdims=True)
        return self.head.inner_radius(d) if self.surface else self.head.outer_radius(d)

    def missing(self, angle: Array, defect: int) -> Array:
        """Distance in mm by which the surface at these angles lies inside a cutter."""
        p = self.point(angle)
        d = p / np.linalg.norm(p, axis=-1, keepdims=True)
        return self.head.cutters[defect].distance(p, self.head.inner_radius(d), self.head.outer_radius(d))

    def tangent(self, p: Array) -> Array:
        """Unit tangents (..., 3) of the surface's curve in the plane, with the angle growing."""
        _, rows, cols = self.frame()
        along = np.cross(np.cross(cols, rows), self.head.gradients(p)[self.surface])
        return along / np.linalg.norm(along, axis=-1, keepdims=True)

    def to_slice(self, p: Array, *, vector: bool = False) -> Array:
        """Slice (row, col) px of offsets (or of vectors) that lie in the plane."""
        shift = 0 if vector else self.head.centre - self.affine[:3, 3]
        return ((p + shift) @ np.linalg.inv(self.affine[:3, :3]).T)[..., 1:]

    def frame(self) -> tuple[Array, Array, Array]:
        """A point of the plane inside the head (near the axis), and unit vectors along rows and columns."""
        rows, cols = (self.affine[:3, i] / np.linalg.norm(self.affine[:3, i]) for i in (1, 2))
        corner = self.affine[:3, :3] @ [self.index, 0, 0] + self.affine[:3, 3] - self.head.centre
        normal = np.cross(cols, rows)
        height = corner @ normal / normal[2]
        return np.array([0.0, 0.0, height + 1e-9]), rows, cols


def gaps_in_slice(head: HeadShape, affine: Array, plane: float) -> tuple[SliceTruth, ...]:
    """Every gap in one plane, one `SliceTruth` per defect that takes bone there.

    Parameters
    ----------
    head : HeadShape
        With its cutters.
    affine : ndarray, shape (4, 4)
        Voxel (plane, row, col) -> world mm.
    plane : float
        Plane index.

    Returns
    -------
    tuple of SliceTruth
        In the order of the defects; empty where none takes bone, and for planes that stand steeper than 75 degrees in
        the head: there the skull is no ring about its axis.

    Notes
    -----
    A defect that crosses the slice's ring twice (only near the vertex) is reported by its widest gap. Where the
    defect takes the whole ring, both surfaces count as whole: such a slice has no ends.
    """
    upright = head.upright(affine)
    normal = np.cross(upright[:3, 1], upright[:3, 2])
    if abs(normal[2]) < np.cos(np.deg2rad(75)) * np.linalg.norm(normal):
        return ()
    truths = []
    for defect in range(len(head.cutters)):
        outer, inner = (_gap(_Plane(head, upright, plane, surface), defect) for surface in (0, 1))
        if outer or inner:
            truths.append(SliceTruth(float(plane), defect, outer, inner))
    return tuple(truths)


def _gap(plane: _Plane, defect: int) -> Gap | None:
    if plane.depth(plane.frame()[0]) <= 0:
        return None
    step = 2 * np.pi / _N_RAYS
    missing = plane.missing(np.arange(0.0, _N_RAYS) * step, defect) > 0
    if not missing.any() or missing.all():
        return None
    first, last = _widest_run(missing)
    return _measure(plane, _crossings(plane, defect, step * np.array([[first - 1, first], [last + 1, last]])))


def _crossings(plane: _Plane, defect: int, brackets: Array) -> Array:
    """Angles (n,) where the cutter's rim crosses the curve, between brackets (n, 2) from outside to inside it."""
    share = np.linspace(0, 1, 65)
    for _ in range(4):
        angles = brackets[:, :1] + share * np.diff(brackets)
        inside = plane.missing(angles, defect) > 0
        inside[:, -1] = True
        first = inside.argmax(axis=1)
        brackets = np.take_along_axis(angles, np.column_stack([first - 1, first]), axis=1)
    return brackets.mean(axis=1)


def _widest_run(missing: NDArray[np.bool_]) -> tuple[int, int]:
    """First and last index of the longest circular run of True; the last may exceed the length."""
    n = missing.size
    turn = int(np.flatnonzero(~missing)[0])
    edges = np.flatnonzero(np.diff(np.r_[0, np.roll(missing, -turn).astype(int), 0]))
    runs = edges.reshape(-1, 2)
    start, stop = runs[np.argmax(runs[:, 1] - runs[:, 0])]
    first = int(start + turn) % n
    return first, first + int(stop - start) - 1


def _measure(plane: _Plane, ends: Array) -> Gap:
    """Gap between two angles of a plane's curve."""
    curve = plane.point(np.linspace(ends[0], ends[1], _N_CURVE))
    directions = plane.tangent(curve[[0, -1]]) * [[1], [-1]]
    points, tangents = plane.to_slice(curve), plane.to_slice(directions, vector=True)
    tangents /= np.linalg.norm(tangents, axis=-1, keepdims=True)
    along = (curve[-1] - curve[0]) / np.linalg.norm(curve[-1] - curve[0])
    _, rows, cols = plane.frame()
    out = np.cross(along, np.cross(cols, rows))
    angles = np.rad2deg(np.arctan2(directions @ out, directions @ along))
    return Gap(points[[0, -1]], tangents, points, angles)
