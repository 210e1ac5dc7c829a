"""Where a head stands: a bone mask comes in -> the affine frame that lays it on the mean head goes out.

Frames: head (x, y, z), the mean head's own: x to the left, y to the back, z up, its plane of symmetry at x = 0, in mm
of the mean head; world mm (LPS).

Skulls can be compared ray by ray only where the same ray meets the same anatomy. A skull is laid on the mean head by
its endocranium, whose fossae and ridges fix the tilt that the smooth vault leaves open, and by the outside of its
vault. The fit is robust and has no landmarks, so a hole only takes points away. Iterated closest points with the
point-to-plane residual (Chen and Medioni 1992): first a similarity, then an affine map. Nothing knows left from
right: the mean head is symmetric, and the mirror image of a skull stands in the mirror image of its frame.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, cKDTree

from ..vault.orientation import head_axes, head_centre
from ..volume import Volume

Array = NDArray[np.float64]

_ENDOCRANIUM, _VAULT = 125.0, 95.0  # degrees from the vertex down to which the inside and the outside are seen
_NEAR, _FAR, _SAMPLE = 20.0, 135.0, 0.75  # mm along a ray, and between samples
_TILTS = (-20.0, 0.0, 20.0)  # degrees of nodding from which the fit starts
_APART = 15.0  # mm beyond which two points are not the same anatomy
_MIRROR = np.array([-1.0, 1.0, 1.0])


@dataclass(frozen=True, eq=False)
class HeadFrame:
    """An affine map from the mean head to a skull: world = origin + matrix @ head.

    Parameters
    ----------
    matrix : ndarray, shape (3, 3)
    origin : ndarray, shape (3,)
        World mm of the head frame's origin, inside the cranial cavity.
    misfit : float
        70 % of the skull's points lie closer to the mean head than this, mm.
    """

    matrix: Array
    origin: Array
    misfit: float = 0.0

    def stretch(self, directions: Array) -> Array:
        """World mm for each mm of the head frame along directions (..., 3), shape (...)."""
        return np.linalg.norm(directions @ self.matrix.T, axis=-1)

    def to_world(self, points: Array) -> Array:
        """World mm of points (..., 3) of the head frame."""
        return self.origin + points @ self.matrix.T


@dataclass(frozen=True, eq=False)
class Cloud:
    """Points of a skull.

    Parameters
    ----------
    inside, outside : ndarray, shape (n, 3)
        Of the endocranium and of the outer vault; mm along `axes` from `eye`, or of the head frame.
    eye : ndarray, shape (3,)
        World mm.
    axes : ndarray, shape (3, 3)
        Columns: unit vectors of the grid's left, back and up, world.
    """

    inside: Array
    outside: Array
    eye: Array
    axes: Array

    def posed(self, matrix: Array, shift: Array) -> Cloud:
        """The points p as matrix @ p + shift."""
        return Cloud(self.inside @ matrix.T + shift, self.outside @ matrix.T + shift, self.eye, self.axes)


def sphere(halvings: int) -> Array:
    """Unit vectors spread evenly over all directions, symmetric about x = 0: a halved icosahedron, shape (n, 3)."""
    golden = (1 + np.sqrt(5)) / 2
    corners = np.array([(0, a, b * golden) for a in (-1, 1) for b in (-1, 1)])
    points = np.concatenate([np.roll(corners, k, axis=1) for k in range(3)])
    for _ in range(halvings):
        points /= np.linalg.norm(points, axis=1)[:, None]
        faces = np.sort(ConvexHull(points).simplices, axis=1)
        edges = np.unique(np.concatenate([faces[:, [0, 1]], faces[:, [0, 2]], faces[:, [1, 2]]]), axis=0)
        points = np.concatenate([points, points[edges].mean(axis=1)])
    points /= np.linalg.norm(points, axis=1)[:, None]
    return points[np.lexsort(np.round(points, 9).T)]


def twins(directions: Array) -> NDArray[np.intp]:
    """Index of each direction's mirror image among the directions, shape (n,)."""
    return cKDTree(directions).query(directions * _MIRROR)[1]


def see(bone: Volume) -> Cloud:
    """Points of a skull as seen from inside it.

    Parameters
    ----------
    bone : Volume
        Bool mask.

    Raises
    ------
    InputRefused
        ``NoVault`` when the mask holds no skull vault.
    """
    eye, axes, directions = head_centre(bone), head_axes(bone).T, sphere(4)
    first, last = outline(bone, HeadFrame(axes, eye), directions)
    inside, outside = (directions * radius[:, None] for radius in (first, last))
    return Cloud(inside[np.isfinite(first)], outside[np.isfinite(last)], eye, axes)


def coverage(bone: Volume) -> float:
    """Share of the vault's rays that meet bone, 0 to 1: next to 1 for an intact skull of a whole head."""
    directions = sphere(4)
    on_vault = directions[:, 2] > np.cos(np.radians(_VAULT))
    return len(see(bone).outside) / int(np.count_nonzero(on_vault))


def outline(bone: Volume, frame: HeadFrame, directions: Array) -> tuple[Array, Array]:
    """First and last bone along rays of the head frame, shape (n,) each, mm of that frame; nan for none.

    The first is looked for down to the skull base, the last on the vault only.
    """
    stretch = frame.stretch(directions)
    lengths = np.arange(_NEAR, _FAR, _SAMPLE)
    steps = bone.steps(directions @ frame.matrix.T / stretch[:, None])
    hit = bone.at_index(bone.to_voxel(frame.origin) + steps[:, None, :] * lengths[:, None], outside=False)
    first, last = lengths[hit.argmax(axis=1)], lengths[len(lengths) - 1 - hit[:, ::-1].argmax(axis=1)]
    polar = np.degrees(np.arccos(np.clip(directions[:, 2], -1, 1)))
    met = hit.any(axis=1)
    return (
        np.where(met & (polar < _ENDOCRANIUM), first / stretch, np.nan),
        np.where(met & (polar < _VAULT), last / stretch, np.nan),
    )


def mean_head(outlines: NDArray[np.float64], directions: Array) -> Cloud:
    """The mean head of outlines and of their mirror images, as points of the head frame.

    Parameters
    ----------
    outlines : ndarray, shape (n, 2, m)
        `outline` of each skull in its own frame along m symmetric directions; rays that fewer than half meet are left.
    directions : ndarray, shape (m, 3)
    """
    both = np.concatenate([outlines, outlines[:, :, twins(directions)]])
    common = np.isfinite(both).mean(axis=0) > 0.5
    middle = [np.nanmedian(both[:, side, common[side]], axis=0) for side in (0, 1)]
    inside, outside = (directions[common[side]] * middle[side][:, None] for side in (0, 1))
    return Cloud(inside, outside, np.zeros(3), np.eye(3))


def stand(cloud: Cloud, mean: Cloud, *, affine: bool = True) -> HeadFrame:
    """Lay a skull on the mean head.

    Parameters
    ----------
    cloud : Cloud
        The skull, from `see`.
    mean : Cloud
        The mean head.
    affine : bool
        Whether to end with an affine map rather than a similarity.
    """
    goal = _Goal.of(mean)
    every_other = Cloud(cloud.inside[::2], cloud.outside[::2], cloud.eye, cloud.axes)
    starts = [goal.fit(every_other, _nod(tilt), np.zeros(3), 8, affine=False) for tilt in _TILTS]
    matrix, shift, misfit = min(starts, key=lambda found: found[2])
    matrix, shift, misfit = goal.fit(cloud, matrix, shift, 8, affine=False)
    if affine:
        matrix, shift, misfit = goal.fit(cloud, matrix, shift, 16, affine=True)
    back = cloud.axes @ np.linalg.inv(matrix)
    return HeadFrame(back, cloud.eye - back @ shift, misfit)


def centred(frames: list[HeadFrame], clouds: list[Cloud]) -> list[HeadFrame]:
    """The frames of all skulls moved together, so that the head frame is that of their mean head."""
    local = [cloud.axes.T @ frame.matrix for frame, cloud in zip(frames, clouds, strict=True)]
    places = [cloud.axes.T @ (frame.origin - cloud.eye) for frame, cloud in zip(frames, clouds, strict=True)]
    mean, place = np.mean(local, axis=0), np.mean(places, axis=0)
    mean = (mean + mean * np.outer(_MIRROR, _MIRROR)) / 2  # keeps the plane of symmetry
    turned, shift = np.linalg.inv(mean), place * [0.0, 1.0, 1.0]
    return [HeadFrame(f.matrix @ turned, f.origin - f.matrix @ turned @ shift, f.misfit) for f in frames]


@dataclass(frozen=True, eq=False)
class _Goal:
    """Two surfaces to lie on: points, their normals and a tree, inside and outside."""

    points: tuple[Array, Array]
    normals: tuple[Array, Array]
    trees: tuple[cKDTree, cKDTree]

    @classmethod
    def of(cls, mean: Cloud) -> _Goal:
        across = (normals(mean.inside), normals(mean.outside))
        return cls((mean.inside, mean.outside), across, (cKDTree(mean.inside), cKDTree(mean.outside)))

    def fit(
        self, cloud: Cloud, matrix: Array, shift: Array, n_iter: int, *, affine: bool
    ) -> tuple[Array, Array, float]:
        """Iterate closest points from matrix, shift; the last value is the misfit in mm."""
        for _ in range(n_iter):
            points, normals, residual, near = self._pairs(cloud.posed(matrix, shift))
            scale = max(1.4826 * float(np.median(np.abs(residual))), 0.7)
            weight = near / (1 + (residual / (2 * scale)) ** 2) ** 2
            turn, move = (_affine_step if affine else _similar_step)(points, normals, residual, weight)
            matrix, shift = turn @ matrix, turn @ shift + move
        return matrix, shift, float(np.quantile(np.abs(residual), 0.7))

    def _pairs(self, posed: Cloud) -> tuple[Array, Array, Array, NDArray[np.bool_]]:
        """Points, normals and distances along them to the closest points, and whether those are near."""
        found = []
        for points, goal, normals, tree in zip(
            (posed.inside, posed.outside), self.points, self.normals, self.trees, strict=True
        ):
            apart, at = tree.query(points)
            along = np.einsum("ij,ij->i", points - goal[at], normals[at])
            found.append((points, normals[at], along, apart < _APART))
        points, normals, residual, near = (np.concatenate(part) for part in zip(*found, strict=True))
        return points, normals, residual, near


def _affine_step(points: Array, normals: Array, residual: Array, weight: Array) -> tuple[Array, Array]:
    """The small affine map that best takes points (n, 3) along normals to their planes."""
    slopes = np.concatenate([(normals[:, :, None] * points[:, None, :]).reshape(-1, 9), normals], axis=1)
    ridge = weight.sum() * np.repeat([1e-3, 1e-6], [9, 3])  # mm2: a thousandth of what a point weighs
    step = _solve(slopes, residual, weight, ridge)
    return np.eye(3) + step[:9].reshape(3, 3), step[9:]


def _similar_step(points: Array, normals: Array, residual: Array, weight: Array) -> tuple[Array, Array]:
    """The same with a rotation, a scale and a shift."""
    along = np.einsum("ij,ij->i", points, normals)[:, None]
    slopes = np.concatenate([np.cross(points, normals), along, normals], axis=1)
    step = _solve(slopes, residual, weight, np.full(7, 1e-9 * weight.sum()))
    return (1 + step[3]) * _rotation(step[:3]), step[4:]


def _solve(slopes: Array, residual: Array, weight: Array, ridge: Array) -> Array:
    """Weighted least squares, damped."""
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


def normals(points: Array) -> Array:
    """Unit normals of a surface given by points (n, 3) around the origin, pointing away from it."""
    _, near = cKDTree(points).query(points, 9)
    patches = points[near] - points[near].mean(axis=1, keepdims=True)
    across = np.linalg.svd(patches)[2][:, 2]
    return across * np.sign(np.einsum("ij,ij->i", across, points))[:, None]
