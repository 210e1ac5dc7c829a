"""What rays from inside the cranial cavity meet: a bone mask and a point in the cavity come in -> `Walls` go out.

Frame: world mm of the mask given.

Behind the vault lies nothing but scalp; behind the base in front lie sinuses, orbits, nose and jaws. The bone met well
behind the first wall, summed over all rays as vectors, points to the face.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..volume import Volume

Array = NDArray[np.float64]

_RAYS = 3000  # over the whole sphere: 3.7 degrees apart
_LENGTHS = np.arange(10.0, 165.0, 1.0)  # mm along a ray
_WALL_MM, _REACH_MM = 12.0, 80.0  # bone so far behind the first wall is deep bone
_MOST_MM = 15.0  # of deep bone that count on one ray


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
