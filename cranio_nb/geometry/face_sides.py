"""Faces of a prosthesis -> which side each belongs to: outer, inner, or the rim that lies against bone."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..mesh import INNER, OUTER, RIM, Mesh
from ..volume import Volume

_STEEP = 0.35  # cosine between a face's normal and the way out of the head below which the face is a wall (70 deg)


def label_faces(mesh: Mesh, bone: Volume, head_centre: ArrayLike) -> NDArray[np.uint8]:
    """Label each face of a prosthesis with its side.

    Parameters
    ----------
    mesh : Mesh
        Closed prosthesis, world mm.
    bone : Volume
        Bool mask (P, R, C) of the skull with the hole.
    head_centre : array_like, shape (3,)
        World mm of a point inside the cranial cavity.

    Returns
    -------
    ndarray of uint8, shape (F,)
        `RIM` for faces that lie against bone, or whose normal is more than 70 degrees off the way out of the head;
        else `OUTER` or `INNER`.

    Examples
    --------
    A flat tetrahedron with the head's centre far below it: its base is inner, the three faces above it are outer.

    >>> mesh = Mesh(np.array([[0.0, 0, 0], [10, 0, 0], [0, 10, 0], [3, 3, 1]]),
    ...             np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]))
    >>> bone = Volume(np.zeros((5, 12, 12), bool), np.eye(4)[[2, 1, 0, 3]])
    >>> label_faces(mesh, bone, (3, 3, -100)) == [INNER, OUTER, OUTER, OUTER]
    array([ True,  True,  True,  True])
    """
    # by the angle between a face's normal and the way from the centre to it
    away = mesh.centres - np.asarray(head_centre, float)
    away /= np.linalg.norm(away, axis=1, keepdims=True).clip(1e-12)
    lean = np.einsum("fd,fd->f", mesh.normals, away)
    sides = np.where(lean > 0, OUTER, INNER).astype(np.uint8)

    # walls, and whatever lies against bone, are rim
    sides[(np.abs(lean) < _STEEP) | _touches_bone(mesh, bone)] = RIM
    return sides


def _touches_bone(mesh: Mesh, bone: Volume) -> NDArray[np.bool_]:
    """Whether a bone voxel lies within 1.5 voxels of each face, in the direction of its normal, shape (F,)."""
    # a step of at most a voxel along any axis, so that no voxel is passed over
    start, step = bone.to_voxel(mesh.centres), bone.steps(mesh.normals)
    step /= np.abs(step).max(axis=1, keepdims=True).clip(1e-12)
    places = (start + reach * step for reach in (0.5, 1.0, 1.5))
    return np.logical_or.reduce([bone.at_index(place, outside=False) for place in places]).astype(bool)
