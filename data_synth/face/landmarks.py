"""Points and axes of a head in the world: the exact truth of how it lies.

Frame: world mm, DICOM LPS.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..head import _FORAMEN
from . import bones
from .anatomy import Anatomy

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Landmarks:
    """Where a head's parts lie.

    Parameters
    ----------
    up, face, left : ndarray, shape (3,)
        Unit vectors to the head's top, to where it looks, to its left.
    centre : ndarray, shape (3,)
        Centre of the braincase at the height of its floor, mm.
    top, nasion, chin : ndarray, shape (3,)
        Where the axis `up` from the centre leaves the skull; root of the nose; chin, mm.
    foramen_magnum : ndarray, shape (3,)
        Middle of the great opening of the base, mm.
    orbit_left, orbit_right : ndarray, shape (3,)
        Middle of the orbit at its rim, mm.
    ear_left, ear_right : ndarray, shape (3,)
        Outer end of the bony ear canal, mm.
    mastoid_left, mastoid_right : ndarray, shape (3,)
        Tip of the mastoid, mm.
    """

    up: Array
    face: Array
    left: Array
    centre: Array
    top: Array
    nasion: Array
    chin: Array
    foramen_magnum: Array
    orbit_left: Array
    orbit_right: Array
    ear_left: Array
    ear_right: Array
    mastoid_left: Array
    mastoid_right: Array

    def as_dict(self) -> dict[str, list[float]]:
        """Every point and vector as a list.

        Returns
        -------
        dict of list of float
            JSON-able.
        """
        return {name: value.tolist() for name, value in asdict(self).items()}


def landmarks(head: Anatomy) -> Landmarks:
    """Landmarks of a head.

    Parameters
    ----------
    head : Anatomy
        Gives the closed forms, the centre and the rotation.

    Returns
    -------
    Landmarks
    """
    case = head.case
    assert case.rotation is not None
    turn = case.rotation

    def world(point: ArrayLike) -> Array:
        return case.centre + turn @ np.asarray(point, float)

    up = np.array([0.0, 0.0, 1.0])
    tip = (bones.MASTOID.b[0], bones.MASTOID.b[1], bones.MASTOID.b[2] - bones.MASTOID.rb)
    paired = {"orbit": bones.ORBIT.b, "ear": bones.EAR_CANAL.b, "mastoid": tip}
    sides = {"left": np.array([1.0, 1, 1]), "right": np.array([-1.0, 1, 1])}
    return Landmarks(
        up=turn[:, 2].copy(),
        face=-turn[:, 1],
        left=turn[:, 0].copy(),
        centre=case.centre.copy(),
        top=world(up * case.outer_radius(up)),
        nasion=world(np.array([0.0, -92.0, -3.0]) * head.scale),
        chin=world(np.array(bones.CHIN) * head.scale),
        foramen_magnum=world(_FORAMEN * case.outer_radius(_FORAMEN)),
        **{
            f"{name}_{side}": world(point * sign * head.scale)
            for name, point in paired.items()
            for side, sign in sides.items()
        },
    )
