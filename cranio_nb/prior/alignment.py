"""A skull laid on the mean head: points of both come in -> the affine frame that lays one on the other goes out.

Frames: mean head (see `mean_frame`); world mm (LPS).

Skulls can be compared ray by ray only where the same ray meets the same anatomy. A skull is laid on the mean head by
its endocranium and by the outside of its vault. The fit is robust and has no landmarks, so a hole only takes points
away. Iterated closest points with the point-to-plane residual (Chen and Medioni 1992): first a similarity, then an
affine map. Nothing knows left from right: the mean head is symmetric, and the mirror image of a skull lies in the
mirror image of its frame.
"""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from ..geometry.robust import geman_mcclure_weights, spread
from .mean_frame import MIRROR, MeanFrame, mirror_index
from .skull_points import SkullPoints

Array = NDArray[np.float64]

_TILTS_DEG = (-20.0, 0.0, 20.0)  # of nodding, from which the fit starts
_APART_MM = 15.0  # beyond which two points are not the same anatomy
_LEAST_SPREAD_MM = 0.7  # what voxels alone do


def mean_head(outlines: Array, directions: Array) -> SkullPoints:
    """The mean head of outlines and of their mirror images.

    Parameters
    ----------
    outlines : ndarray, shape (n, 2, m)
        `measure_outline` of each skull in its own frame, outer and inner, along m symmetric directions; rays that fewer
        than half meet are left.
    directions : ndarray, shape (m, 3)
        Unit vectors, mean frame.

    Returns
    -------
    SkullPoints
        In the mean frame.
    """
    # with the mirror images the mean is symmetric about x = 0; the median heeds no outlier
    both = np.concatenate([outlines, outlines[:, :, mirror_index(directions)]])
    common = np.isfinite(both).mean(axis=0) > 0.5
    outer, inner = (
        directions[common[side]] * np.nanmedian(both[:, side, common[side]], axis=0)[:, None] for side in (0, 1)
    )
    return SkullPoints(outer=outer, inner=inner, centre=np.zeros(3), axes=np.eye(3))


def align(skull: SkullPoints, mean: SkullPoints, *, affine: bool = True) -> MeanFrame:
    """Lay a skull on the mean head.

    Parameters
    ----------
    skull : SkullPoints
        From `sample_surface`.
    mean : SkullPoints
        The mean head.
    affine : bool
        Whether to end with an affine map rather than a similarity.

    Returns
    -------
    MeanFrame
    """
    goal, some = _Goal.of(mean), skull.every_other()
    # the best of three starts, then all points, then all maps
    starts = [goal.fit(some, _nod(tilt), np.zeros(3), 8, affine=False) for tilt in _TILTS_DEG]
    matrix, shift, misfit = min(starts, key=lambda found: found[2])
    matrix, shift, misfit = goal.fit(skull, matrix, shift, 8, affine=False)
    if affine:
        matrix, shift, misfit = goal.fit(skull, matrix, shift, 16, affine=True)
    # what lays the skull on the mean head, turned round: head -> world
    back = skull.axes @ np.linalg.inv(matrix)
    return MeanFrame(back, skull.centre - back @ shift, misfit)


def centre_frames(frames: list[MeanFrame], skulls: list[SkullPoints]) -> list[MeanFrame]:
    """Move the frames of all skulls together, so that the mean frame is that of their mean head.

    Parameters
    ----------
    frames : list of MeanFrame
    skulls : list of SkullPoints
        As many.

    Returns
    -------
    list of MeanFrame
    """
    # each frame relative to its skull's axes and centre, and the mean of these
    local = [skull.axes.T @ frame.matrix for frame, skull in zip(frames, skulls, strict=True)]
    places = [skull.axes.T @ (frame.origin - skull.centre) for frame, skull in zip(frames, skulls, strict=True)]
    mean, place = np.mean(local, axis=0), np.mean(places, axis=0)
    # without what would leave the plane of symmetry
    mean = (mean + mean * np.outer(MIRROR, MIRROR)) / 2
    # that mean becomes the identity: the mean frame neither turns, grows nor drifts over the rounds
    turned, shift = np.linalg.inv(mean), place * [0.0, 1.0, 1.0]
    return [MeanFrame(f.matrix @ turned, f.origin - f.matrix @ turned @ shift, f.misfit_mm) for f in frames]


@dataclass(frozen=True, eq=False)
class _Surface:
    """A surface to lie on: points (n, 3), their normals and a tree."""

    points: Array
    normals: Array
    tree: cKDTree

    @classmethod
    def of(cls, points: Array) -> _Surface:
        return cls(points, estimate_normals(points), cKDTree(points))

    def pairs(self, points: Array) -> tuple[Array, Array, Array, NDArray[np.bool_]]:
        """Points, normals and distances along them to the closest points, and whether those are near."""
        apart, at = self.tree.query(points)
        along = np.einsum("ij,ij->i", points - self.points[at], self.normals[at])
        return points, self.normals[at], along, apart < _APART_MM


@dataclass(frozen=True, eq=False)
class _Goal:
    """The two surfaces of the mean head."""

    _: KW_ONLY
    outer: _Surface
    inner: _Surface

    @classmethod
    def of(cls, mean: SkullPoints) -> _Goal:
        return cls(outer=_Surface.of(mean.outer), inner=_Surface.of(mean.inner))

    def fit(
        self, skull: SkullPoints, matrix: Array, shift: Array, n_iter: int, *, affine: bool
    ) -> tuple[Array, Array, float]:
        """Iterate closest points from matrix, shift; the last value is the misfit in mm."""
        for _ in range(n_iter):
            # partners on both surfaces, and the distance along their normals (point to plane)
            moved = skull.moved(matrix, shift)
            found = self.outer.pairs(moved.outer), self.inner.pairs(moved.inner)
            points, normals, residual, near = (np.concatenate(part) for part in zip(*found, strict=True))
            # outliers fade, pairs that are far apart do not count
            scale = max(spread(residual), _LEAST_SPREAD_MM)
            weight = geman_mcclure_weights(residual, 2 * scale, times=near)
            # the step that makes n (A p + t - q) small, added to the map so far
            turn, move = (_affine_step if affine else _similar_step)(points, normals, residual, weight)
            matrix, shift = turn @ matrix, turn @ shift + move
        return matrix, shift, float(np.quantile(np.abs(residual), 0.7))


def _affine_step(points: Array, normals: Array, residual: Array, weight: Array) -> tuple[Array, Array]:
    """The small affine map that best takes points (n, 3) along normals to their planes."""
    # d n (A p + t) / dA_ij = n_i p_j, and / dt = n
    slopes = np.concatenate([(normals[:, :, None] * points[:, None, :]).reshape(-1, 9), normals], axis=1)
    ridge = weight.sum() * np.repeat([1e-3, 1e-6], [9, 3])  # mm2: a thousandth of what a point weighs
    step = _solve(slopes, residual, weight, ridge)
    return np.eye(3) + step[:9].reshape(3, 3), step[9:]


def _similar_step(points: Array, normals: Array, residual: Array, weight: Array) -> tuple[Array, Array]:
    """The same with a rotation, a scale and a shift."""
    # d / d(turn) = p x n, d / d(log scale) = p n, d / dt = n
    along = np.einsum("ij,ij->i", points, normals)[:, None]
    slopes = np.concatenate([np.cross(points, normals), along, normals], axis=1)
    step = _solve(slopes, residual, weight, np.full(7, 1e-9 * weight.sum()))
    return (1 + step[3]) * _rotation(step[:3]), step[4:]


def _solve(slopes: Array, residual: Array, weight: Array, ridge: Array) -> Array:
    """Weighted least squares, damped."""
    # normal equations; the ridge keeps directions that no pair fixes at rest
    weighted = slopes * weight[:, None]
    step = np.linalg.solve(slopes.T @ weighted + np.diag(ridge), -weighted.T @ residual)
    return np.asarray(step, float)


def _rotation(turn: Array) -> Array:
    """Rotation about a vector by its length in radians (Rodrigues)."""
    angle = float(np.linalg.norm(turn))
    x, y, z = turn.tolist()
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sinc(angle / np.pi) * cross + 0.5 * np.sinc(angle / 2 / np.pi) ** 2 * cross @ cross


def _nod(degrees: float) -> Array:
    """Rotation about x."""
    return _rotation(np.array([np.radians(degrees), 0.0, 0.0]))


def estimate_normals(points: Array) -> Array:
    """Normals of a surface given by points around the origin.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Any unit.

    Returns
    -------
    ndarray, shape (n, 3)
        Unit vectors, pointing away from the origin, across the nine points nearest to each.
    """
    # principal axes of each patch: the direction of least spread is its normal
    _, near = cKDTree(points).query(points, 9)
    patches = points[near] - points[near].mean(axis=1, keepdims=True)
    across = np.linalg.svd(patches)[2][:, 2]
    return across * np.sign(np.einsum("ij,ij->i", across, points))[:, None]
