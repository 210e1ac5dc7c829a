"""How far a head nods: what rays from the cavity meet and the midline come in -> the head's axes go out.

Frame: that of the rays. Angles in the midline, from the face towards the brow.

- *Nod.* Three angles, each with its mean over adult skulls: of the face, of the upper edge of the deep bone (the roofs
  of the orbits), and of the long axis of the cavity. Their median is taken, and how far they lie apart says how sure
  it is.
- *Front.* Of the two ways to turn from the face to the top, the one on which the cavity reaches far: the frontal pole
  is further from the widest place of the cavity than the occiput.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .cavity_walls import Walls

Array = NDArray[np.float64]

_FACE_DEG, _EDGE_DEG, _LONG_DEG = 26.0, 64.0, 95.0  # of the three, from straight down to the front, adult skulls
_BROW_WEIGHTS = (0.12, 0.67, -0.87, 3.24)  # Fisher's discriminant of front and rear on 48 heads; the least sum was 6


def find_nod(walls: Walls, normal: Array) -> tuple[Array, float, float]:
    """How far a head nods in its midline: the axes of the head.

    Parameters
    ----------
    walls : Walls
        What rays from a point on the midline, inside the cavity, meet.
    normal : ndarray, shape (3,)
        Of the midline; unit vector, to either side.

    Returns
    -------
    axes : ndarray, shape (3, 3)
        Rows: the head's left, back and up, orthonormal, in the frame of the walls.
    spread : float
        How far the three estimates lie apart, degrees (median distance from their median).
    brow : float
        How clearly front and rear differ, 0 or more; 4 and more is sure.
    """
    face = walls.face - (walls.face @ normal) * normal
    face = face / np.linalg.norm(face)
    ahead = np.cross(normal, face)  # in the midline, at right angles to the face: towards the brow or the neck
    brow = _brow_side(walls, normal, face, ahead)
    ahead = ahead if brow > 0 else -ahead
    # each estimate less its mean over adult skulls; the long axis has no ends, so the half turn nearest to the others
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
