"""The cranial cavity of a head that may lie in any way: a bone mask comes in -> a point well inside it goes out.

Frame: the grid's own, mm along (left, back, up) as `orientation.head_axes` has them; nothing depends on the header
but the spacing.

Air and soft tissue around a convex head meet bone along fewer than half of all directions, the inside of the cavity
along nearly all, even with a wide hole. The largest ball among the places that are enclosed this way lies in the
cavity, since sinuses, orbits and mouth are narrower.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..errors import InputRefused
from ..grid import move_affine
from ..volume import Volume

_BLOCK_MM = 4.0  # side of the blocks the head is looked at in: closes sutures and thin bone
_DIRECTIONS = [d for d in itertools.product((-1, 0, 1), repeat=3) if any(d)]  # to the 26 neighbours
_ENCLOSED = 17  # of 26 directions that must meet bone: with a hole of 120 mm and an open base, some 18 do
_LEAST_MM = 25.0  # radius of the smallest ball that is a cranial cavity: that of a newborn holds 40 mm


def coarse_bone(bone: Volume, side_mm: float = _BLOCK_MM) -> Volume:
    """Bone in blocks of nearly equal sides: a block is bone where any of its voxels is.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    side_mm : float
        Side of a block; thicker slices stay as they are.

    Returns
    -------
    Volume
        Bool.

    Examples
    --------
    >>> bone = Volume(np.eye(8, dtype=bool)[None].repeat(8, axis=0), np.eye(4))
    >>> coarse_bone(bone).voxels[0]
    array([[ True, False],
           [False,  True]])
    """
    step = np.maximum(1, np.round(side_mm / bone.spacing)).astype(int)
    voxels = bone.voxels
    for axis, n in enumerate(step):
        layers = np.moveaxis(voxels, axis, 0)
        blocks = layers[::n].copy()
        for i in range(1, n):
            more = layers[i::n]
            blocks[: len(more)] |= more
        voxels = np.moveaxis(blocks, 0, axis)
    return Volume(voxels, move_affine(bone.affine, (step - 1) / 2, step))


def enclosed(bone: NDArray[np.bool_]) -> NDArray[np.int8]:
    """In how many of the 26 directions to the neighbours each voxel has bone, however far.

    Parameters
    ----------
    bone : ndarray of bool, shape (P, R, C)

    Returns
    -------
    ndarray of int8, shape (P, R, C)

    Examples
    --------
    >>> shell = np.ones((5, 5, 5), bool)
    >>> shell[1:4, 1:4, 1:4] = False
    >>> int(enclosed(shell)[2, 2, 2])
    26
    """
    count = np.zeros(bone.shape, np.int8)
    for direction in _DIRECTIONS:
        # the layers across the lines, in the order in which bone is handed on: those the lines come to last go first
        axis = next(i for i, d in enumerate(direction) if d)
        order = slice(None, None, -direction[axis])
        layers = np.moveaxis(bone, axis, 0)[order]
        # a line meets bone where its next voxel is bone or meets it: met[i, j, k] = (met | bone)[i - 1, j + a, k + b]
        (a, b), (rows, cols) = (1 + d for i, d in enumerate(direction) if i != axis), layers.shape[1:]
        met, framed = np.zeros_like(layers), np.zeros((rows + 2, cols + 2), bool)
        for i in range(1, len(layers)):
            np.logical_or(met[i - 1], layers[i - 1], out=framed[1:-1, 1:-1])
            met[i] = framed[a : a + rows, b : b + cols]
        count += np.moveaxis(met[order], 0, axis)
    return count


def cavity_ball(coarse: Volume) -> tuple[NDArray[np.float64], float]:
    """Middle and radius of the largest ball in the cranial cavity.

    Parameters
    ----------
    coarse : Volume
        Bool mask of the skull in blocks, from `coarse_bone`; it may lie in any way.

    Returns
    -------
    centre : ndarray, shape (3,)
        World mm.
    radius : float
        mm, to within a block of 4 mm.

    Raises
    ------
    InputRefused
        ``NoVault`` when no bone encloses a cavity.
    """
    # the radius of the largest ball about each enclosed block is its distance from bone
    from_bone_mm = ndimage.distance_transform_edt(~coarse.voxels, sampling=coarse.spacing)
    radius_mm = np.where(enclosed(coarse.voxels) >= _ENCLOSED, from_bone_mm, 0.0)
    at = np.unravel_index(int(radius_mm.argmax()), radius_mm.shape)
    if radius_mm[at] < _LEAST_MM:
        raise InputRefused("NoVault", "The bone found does not enclose a cranial cavity.", "Is this a head CT?")
    return coarse.to_world(at), float(radius_mm[at])
