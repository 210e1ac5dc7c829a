"""How a head lies: three angles -> rotations between the head's own frame and the world.

Frames: head mm (x left, y back, z top, from the head's centre) and world mm, DICOM LPS. In both, angles turn by the
right-hand rule about x, y and z.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Pose:
    """Three turns, made in this order.

    Parameters
    ----------
    nod_deg : float
        About x: positive lowers the chin to the chest. 180 hangs the head upside down, face behind.
    roll_deg : float
        About y: positive leans the top to the left; 90 lays the head on its left side.
    turn_deg : float
        About z: positive turns the face to the left.

    Examples
    --------
    >>> Pose(turn_deg=90).rotation().round() @ [0, -1, 0]  # a face to the front now looks to the left
    array([1., 0., 0.])
    """

    nod_deg: float = 0.0
    roll_deg: float = 0.0
    turn_deg: float = 0.0

    def rotation(self) -> Array:
        """Rotation matrix, Rz(turn) Ry(roll) Rx(nod).

        Returns
        -------
        ndarray, shape (3, 3)
            Takes vectors of the head's frame to the world.
        """
        (cn, cr, ct), (sn, sr, st) = (
            f(np.deg2rad([self.nod_deg, self.roll_deg, self.turn_deg])) for f in (np.cos, np.sin)
        )
        nod = np.array([[1, 0, 0], [0, cn, -sn], [0, sn, cn]])
        roll = np.array([[cr, 0, sr], [0, 1, 0], [-sr, 0, cr]])
        turn = np.array([[ct, -st, 0], [st, ct, 0], [0, 0, 1]])
        return turn @ roll @ nod


def rigid(rotation: ArrayLike, centre: ArrayLike) -> Array:
    """A rotation about a point as one matrix.

    Parameters
    ----------
    rotation : array_like, shape (3, 3)
    centre : array_like, shape (3,)
        Point that stays where it is, mm.

    Returns
    -------
    ndarray, shape (4, 4)
        Homogeneous matrix.

    Examples
    --------
    >>> rigid(Pose(roll_deg=180).rotation(), [1, 0, 0]).round() @ [2, 0, 0, 1]
    array([0., 0., 0., 1.])
    """
    matrix, centre = np.eye(4), np.asarray(centre, float)
    matrix[:3, :3] = rotation
    matrix[:3, 3] = centre - matrix[:3, :3] @ centre
    return matrix
