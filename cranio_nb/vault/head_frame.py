"""How a head lies in its scan, read off the bone alone: top, face side and midline, whatever the header says.

Frame: mm along the grid's own left, back and up (`orientation.head_axes`); the result in the world (LPS).

Rays run from the middle of the cranial cavity in all directions.

- *Face.* Behind the vault lies nothing but scalp; behind the base in front lie sinuses, orbits, nose and jaws. The
  bone met well behind the first wall, summed over all rays as vectors, points to the face.
- *Midline.* The plane through that direction in which the head is most nearly its own mirror image.
- *Nod.* Three angles in that plane, each with its mean over adult skulls: of the face, of the upper edge of the deep
  bone (the roofs of the orbits), and of the long axis of the cavity. Their median is taken, and how far they lie apart
  says how sure it is.
- *Front.* Of the two ways to turn from the face to the top, the one on which the cavity reaches far: the frontal pole
  is further from the widest place of the cavity than the occiput.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, optimize

from ..errors import InputRefused
from ..volume import Volume
from .cavity import cavity_ball, coarse_bone
from .orientation import head_axes

Array = NDArray[np.float64]

_STRAIGHT_DEG = 35.0  # of rotation that the symmetry plane and the mean head are found in spite of
SURE = 0.5
"""Least confidence at which the axes are used."""

_RAYS = 3000  # over the whole sphere: 3.7 degrees apart
_LENGTHS = np.arange(10.0, 165.0, 1.0)  # mm along a ray
_WALL_MM, _REACH_MM = 12.0, 80.0  # bone so far behind the first wall is deep bone
_MOST_MM = 15.0  # of deep bone that count on one ray
_FACE_MM = 0.1  # mean deep bone, as a vector, below which no face is in sight
_FACE_DEG, _EDGE_DEG, _LONG_DEG = 26.0, 64.0, 95.0  # of the three, from straight down to the front, adult skulls
_BROW_WEIGHTS = (0.12, 0.67, -0.87, 3.24)  # Fisher's discriminant of front and rear on 48 heads; the least sum was 6
_BROW_SURE = 4.0  # of the same sum
_HEAD_MM, _FARTHEST_MM, _POINTS = 105.0, 12.0, 1500  # about the centre; distance that counts at most; compared
_ASYMMETRY_MM = 1.5  # mean misfit up to which a midline is a midline
_END = np.cos(np.radians(30.0))  # rays so near to straight up or down
_FORAMEN = 0.05  # share of them that leave through the foramen magnum
_NO_FACE = "No face is in sight; the scan's own axes are used."
_TURNED_OVER = "No face is in sight; the end called base is closed and the end called top is open, as a base is."
_AGREE = "Face, midline and cavity agree on how the head lies."
_DISAGREE = "A face is in sight, but the signs of how the head lies disagree."
_SPREAD_DEG = 12.0  # median distance of the three from their median at which they count half


@dataclass(frozen=True, eq=False)
class HeadFrame:
    """How a head lies.

    Parameters
    ----------
    centre : ndarray, shape (3,)
        In the middle of the cavity, on the midline; world mm.
    axes, grid_axes : ndarray, shape (3, 3)
        Rows: the head's left, back and up; orthonormal, world. By the bone, and by the scan.
    confidence : float
        0 to 1: how far the axes can be trusted. 0 where no face is in sight; the axes are then those of the grid.
    asymmetry : float
        Mean distance in mm of the mirrored bone from the bone.
    spread : float
        How far the three estimates of the nod lie apart, degrees (median distance from their median).
    reason : str
        One sentence: what the frame rests on.
    """

    centre: Array
    axes: Array
    grid_axes: Array
    confidence: float
    asymmetry: float
    spread: float
    reason: str

    @property
    def trusted_axes(self) -> Array:
        """The head's axes by the bone where it shows them, else by the scan.

        Returns
        -------
        ndarray, shape (3, 3)
        """
        return self.axes if self.confidence >= SURE else self.grid_axes

    @property
    def tilt_deg(self) -> float:
        """Angle between the head's top and that of the scan.

        Returns
        -------
        float
            Degrees.
        """
        return float(np.degrees(np.arccos(np.clip(self.axes[2] @ self.grid_axes[2], -1, 1))))


@dataclass(frozen=True, eq=False)
class Walls:
    """What rays from inside the cavity meet.

    Parameters
    ----------
    directions : ndarray, shape (n, 3)
        Unit vectors.
    first, last : ndarray, shape (n,)
        Where bone begins and where it ends for good, mm; nan where there is none.
    deep : ndarray, shape (n,)
        Bone met more than 12 mm behind where it begins, mm, at most 15.
    """

    directions: Array
    first: Array
    last: Array
    deep: Array

    @property
    def face(self) -> Array:
        """Mean of the directions, weighted with deep bone, shape (3,), mm."""
        return np.asarray((self.directions * self.deep[:, None]).mean(axis=0))


def find_head_frame(bone: Volume) -> HeadFrame:
    """Find how a head lies.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull, without couch and holder; the head may lie in any way.

    Returns
    -------
    HeadFrame

    Raises
    ------
    InputRefused
        ``NoVault`` when the bone encloses no cranial cavity.

    Notes
    -----
    Mean angles and spreads were measured on 30 adult skulls, laid on each other by their endocranium: the nod's
    standard deviation is 5 degrees.
    """
    grid_axes = head_axes(bone)
    local = _on_own_axes(bone, grid_axes)
    coarse = coarse_bone(local)
    centre, _ = cavity_ball(coarse)
    walls = measure_walls(local, centre)
    if np.linalg.norm(walls.face) < _FACE_MM:
        return _without_face(walls, bone.to_world(local.to_voxel(centre)), grid_axes)
    normal, shift, asymmetry = _midline(coarse, centre, walls.face)
    centre = centre + shift * normal
    axes, spread, brow = _nod(measure_walls(local, centre), normal)
    agreement = [1.5 - spread / _SPREAD_DEG, 2 - asymmetry / _ASYMMETRY_MM, brow / _BROW_SURE]
    confidence = float(np.clip(agreement, 0, 1).min())
    reason = _AGREE if confidence >= SURE else _DISAGREE
    return HeadFrame(
        bone.to_world(local.to_voxel(centre)), axes @ grid_axes, grid_axes, confidence, asymmetry, spread, reason
    )


def _without_face(walls: Walls, centre: Array, grid_axes: Array) -> HeadFrame:
    """The scan's own axes, turned over where bone closes the end called base and not the one called top."""
    open_ends = [np.isnan(walls.first)[side * walls.directions[:, 2] > _END].mean() for side in (1, -1)]
    if open_ends[1] > 0 or open_ends[0] < _FORAMEN:
        return HeadFrame(centre, grid_axes, grid_axes, 0.0, np.nan, np.nan, _NO_FACE)
    turned = grid_axes * np.array([[1.0], [-1.0], [-1.0]])
    return HeadFrame(centre, turned, grid_axes, SURE, np.nan, np.nan, _TURNED_OVER)


def _on_own_axes(bone: Volume, grid_axes: Array) -> Volume:
    """The same voxels with their axes along the coordinates and at the origin, whatever the header turns and shifts."""
    affine = np.pad(np.round(grid_axes @ bone.edges.T, 9), (0, 1))
    affine[3, 3] = 1.0
    return Volume(bone.voxels, affine)


def even_directions(n: int) -> Array:
    """Directions spread evenly over the sphere, along a spiral.

    Parameters
    ----------
    n : int

    Returns
    -------
    ndarray, shape (n, 3)
        Unit vectors.

    Examples
    --------
    >>> np.abs(even_directions(100).mean(axis=0)).max() < 0.01
    np.True_
    """
    i = np.arange(n) + 0.5
    z, turn = 1 - 2 * i / n, np.pi * (1 + np.sqrt(5)) * i
    across = np.sqrt(1 - z**2)
    return np.stack([across * np.cos(turn), across * np.sin(turn), z], axis=1)


def measure_walls(bone: Volume, centre: Array) -> Walls:
    """Follow rays in all directions from inside the cavity.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    centre : ndarray, shape (3,)
        World mm.

    Returns
    -------
    Walls
    """
    directions = even_directions(_RAYS)
    hit = bone.at_index(bone.to_voxel(centre) + _LENGTHS[:, None, None] * bone.steps(directions), outside=False)
    met = hit.any(axis=0)
    first = np.where(met, _LENGTHS[hit.argmax(axis=0)], np.nan)
    last = np.where(met, _LENGTHS[len(hit) - 1 - hit[::-1].argmax(axis=0)], np.nan)
    behind = _LENGTHS[:, None] - first
    deep = (hit & (behind > _WALL_MM) & (behind < _REACH_MM)).sum(axis=0) * (_LENGTHS[1] - _LENGTHS[0])
    return Walls(directions, first, last, np.minimum(deep, _MOST_MM))


@dataclass(frozen=True, eq=False)
class _Mirror:
    """Points of a head about its centre (n, 3), and how far each place is from bone."""

    points: Array
    start: Array
    field: Volume

    @classmethod
    def of(cls, coarse: Volume, centre: Array) -> _Mirror:
        points = coarse.to_world(np.argwhere(coarse.voxels)) - centre
        points = points[np.linalg.norm(points, axis=1) < _HEAD_MM]
        apart = ndimage.distance_transform_edt(~coarse.voxels, sampling=coarse.spacing)
        field = coarse.with_voxels(np.minimum(apart, _FARTHEST_MM))
        return cls(points[:: max(1, len(points) // _POINTS)], coarse.to_voxel(centre), field)

    def misfit(self, normal: Array, shift: float) -> float:
        """Mean distance in mm of the mirrored points from bone."""
        mirrored = self.points - 2 * (self.points @ normal - shift)[:, None] * normal
        away = self.field.at_index(self.start + self.field.steps(mirrored), outside=np.nan)
        seen = np.isfinite(away)
        return float(away[seen].mean()) if seen.mean() > 0.5 else _FARTHEST_MM


def _midline(coarse: Volume, centre: Array, face: Array) -> tuple[Array, float, float]:
    """Normal of the plane of symmetry, its signed distance from the centre and the mean misfit, mm."""
    mirror = _Mirror.of(coarse, centre)
    _, normal, shift = min(
        ((mirror.misfit(n, s), n, s) for n in _normals_beside(face) for s in (-8.0, 0.0, 8.0)),
        key=lambda plane: plane[0],
    )
    sides = np.linalg.svd(normal[None])[2][1:]

    def moved(x: Array) -> Array:
        turned = normal + x[0] / 50 * sides[0] + x[1] / 50 * sides[1]  # mm at 50 mm
        return np.asarray(turned / np.linalg.norm(turned))

    simplex = np.array([[0, 0, shift], [4, 0, shift], [0, 4, shift], [0, 0, shift + 3]], float)
    found = optimize.minimize(
        lambda x: mirror.misfit(moved(x), x[2]),
        simplex[0],
        method="Nelder-Mead",
        options={"initial_simplex": simplex, "xatol": 0.2, "fatol": 0.005, "maxiter": 80},
    )
    return moved(found.x), float(found.x[2]), float(found.fun)


def _normals_beside(face: Array) -> list[Array]:
    """Unit vectors within 20 degrees of right angles to the face, 6 to 10 degrees apart."""
    forward = face / np.linalg.norm(face)
    across = np.linalg.svd(forward[None])[2][1:]
    turns, leans = np.radians(np.arange(0, 180, 6)), np.radians([-20, -10, 0, 10, 20])
    return [
        np.cos(lean) * (np.cos(turn) * across[0] + np.sin(turn) * across[1]) + np.sin(lean) * forward
        for turn in turns
        for lean in leans
    ]


def _nod(walls: Walls, normal: Array) -> tuple[Array, float, float]:
    """The head's left, back and up, and how far the estimates lie apart in degrees."""
    face = walls.face - (walls.face @ normal) * normal
    face = face / np.linalg.norm(face)
    ahead = np.cross(normal, face)  # in the midline, at right angles to the face: towards the brow or the neck
    brow = _brow_side(walls, normal, face, ahead)
    ahead = ahead if brow > 0 else -ahead
    angles = np.array([-_FACE_DEG, _edge(walls, normal, face, ahead) - _EDGE_DEG, 0.0])
    long_axis = _long_axis(walls, normal, face, ahead) - _LONG_DEG
    angles[2] = (long_axis - angles[:2].mean() + 90) % 180 - 90 + angles[:2].mean()
    down = np.radians(float(np.median(angles)))  # from the face, towards the brow, to straight down
    up = -(np.cos(down) * face + np.sin(down) * ahead)
    front = -np.sin(down) * face + np.cos(down) * ahead
    spread = float(np.median(np.abs(angles - np.median(angles))))
    return np.stack([np.cross(-front, up), -front, up]), spread, abs(brow)


def _brow_side(walls: Walls, normal: Array, face: Array, ahead: Array) -> float:
    """How much more the side of `ahead` is like the brow than the other is: positive when it is the front.

    Next to the face in front lie deep bone and then the frontal pole, the place of the cavity furthest from its
    widest part; behind lie the foramen and the occiput.
    """
    x, y, z = (walls.directions @ np.stack([normal, ahead, face]).T).T
    angle = np.degrees(np.arctan2(y, z))
    near = np.abs(x) < 0.5

    def contrast(values: Array, low: float, high: float) -> float:
        sides = [near & (low < side * angle) & (side * angle < high) & np.isfinite(values) for side in (1, -1)]
        front, rear = (
            float(np.median(values[s]) if values is walls.first else values[s].mean()) if s.any() else np.nan
            for s in sides
        )
        return float(np.nan_to_num(front - rear))

    reach = [contrast(walls.first, low, low + 30) for low in (30.0, 60.0, 90.0)]
    return float(np.dot(_BROW_WEIGHTS, [*reach, contrast(walls.deep, 30.0, 50.0)]))


def _edge(walls: Walls, normal: Array, face: Array, ahead: Array) -> float:
    """Angle in degrees from the face towards the brow within which 95 % of the deep bone lies."""
    x, y, z = walls.directions @ normal, walls.directions @ ahead, walls.directions @ face
    angle = np.degrees(np.arctan2(y, z))
    used = (np.abs(x) < 0.6) & (np.abs(angle) < 100) & (walls.deep > 0)
    order = np.argsort(angle[used])
    share = np.cumsum(walls.deep[used][order])
    return float(angle[used][order][np.searchsorted(share, 0.95 * share[-1])])


def _long_axis(walls: Walls, normal: Array, face: Array, ahead: Array) -> float:
    """Angle in degrees from the face towards the brow of the long axis of an ellipsoid through the vault's inside."""
    single = np.isfinite(walls.first) & (walls.last - walls.first < 15.0)
    points = walls.directions[single] * walls.first[single][:, None] / 80.0
    x, y, z = (points @ np.stack([normal, ahead, face]).T).T
    terms = np.stack([x * x, y * y, z * z, y * z, y, z], axis=1)
    kept = np.ones(len(terms), bool)
    for _ in range(4):
        c = np.linalg.lstsq(terms[kept], np.ones(kept.sum()), rcond=None)[0]
        off = np.abs(terms @ c - 1)
        kept = off < np.quantile(off, 0.8)
    across = np.linalg.eigh(np.array([[c[1], c[3] / 2], [c[3] / 2, c[2]]]))[1][:, 0]
    return float(np.degrees(np.arctan2(across[0], across[1])) % 180)


def head_or_grid_axes(bone: Volume) -> Array:
    """The axes of the grid where the head lies straight enough on it, else its own, where the bone shows them.

    What is measured along rays about the vertex bears a turned head, but moves a little with the axes it is measured
    in, and those of the grid do not change when a hole is cut.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.

    Returns
    -------
    ndarray, shape (3, 3)
        Rows: left, back and up, orthonormal, world.
    """
    grid_axes = head_axes(bone)
    try:
        axes = find_head_frame(bone).trusted_axes
    except InputRefused:
        return grid_axes
    # the angle of the rotation from one to the other follows from its trace
    turn_deg = np.degrees(np.arccos(np.clip((np.trace(axes @ grid_axes.T) - 1) / 2, -1, 1)))
    return axes if turn_deg > _STRAIGHT_DEG else grid_axes
