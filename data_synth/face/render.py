"""A head and a grid -> HU by slices of finite thickness, and the exact masks of bone and missing bone.

Frames: voxel (plane, row, col); world mm, DICOM LPS; head mm. Each slice is the mean of thin layers through its
thickness, as a scanner's is; within a layer a voxel at a surface holds a blend by its depth (partial volume).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from .anatomy import Anatomy, Depths, Plane, depths, parts
from .devices import Device

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

AIR, BRAIN, SOFT, FAT, CORTICAL, DIPLOE, TOOTH, SUTURE = -1000.0, 35.0, 50.0, -90.0, 1250.0, 680.0, 2100.0, 180.0
"""HU of the tissues."""
_TEXTURE = 90.0  # standard deviation of the diploe's HU
_TABLE = 1.5  # mm of compact bone under each surface
_GRAIN = np.random.default_rng(5).standard_normal((64, 64, 64))  # of the diploe, in cells of 0.8 mm
_LAYER = 1.25  # mm: thickest layer


def layers(thickness_mm: float) -> Array:
    """Where a slice is sampled.

    Parameters
    ----------
    thickness_mm : float
        Of the slice.

    Returns
    -------
    ndarray, shape (n,)
        Shares of the thickness from the middle, n odd, so that the middle is among them.

    Examples
    --------
    >>> layers(1.0).tolist(), layers(3.0).round(3).tolist()
    ([0.0], [-0.333, 0.0, 0.333])
    """
    count = 2 * int(np.ceil((thickness_mm / _LAYER - 1) / 2 - 1e-9)) + 1
    return (np.arange(max(count, 1)) - max(count, 1) // 2) / max(count, 1)


def render(
    head: Anatomy,
    affine: Array,
    shape: tuple[int, int, int],
    *,
    devices: Sequence[Device] = (),
    noise: float = 12.0,
    blur_mm: float = 0.0,
    seed: int = 0,
) -> tuple[NDArray[np.int16], Mask, Mask]:
    """Scan a head.

    Parameters
    ----------
    head : Anatomy
    affine : ndarray, shape (4, 4)
        Voxel -> world mm; orthogonal.
    shape : tuple of int
        Planes, rows, columns.
    devices : sequence of Device
        What else is in the picture.
    noise : float
        Standard deviation of the scanner's noise in HU.
    blur_mm : float
        Standard deviation of the scanner's blur within a slice.
    seed : int
        Of the noise.

    Returns
    -------
    hu : ndarray of int16, shape (P, R, C)
    bone, implant : ndarray of bool, shape (P, R, C)
        Bone that is left and bone that is missing, by voxel centres.
    """
    spacing = np.sqrt((affine[:3, :3] ** 2).sum(0))
    shares, rng = layers(float(spacing[0])), np.random.default_rng([seed, 1])
    hu = np.empty(shape, np.int16)
    bone, implant = np.zeros(shape, bool), np.zeros(shape, bool)
    for k in range(shape[0]):
        mean = np.zeros(shape[1:])
        for share in shares:
            plane = plane_at(head, affine, k + share, shape[1:])
            level = depths(head, plane)
            mean += _values(head, plane, level, _width(spacing, len(shares)), devices) / len(shares)
            if share == 0:
                whole = (level.bone > 0) | (level.tooth > 0)
                bone[k], implant[k] = whole & (level.cut <= 0), whole & (level.cut > 0)
        mean = ndimage.gaussian_filter(mean, blur_mm / spacing[1:]) if blur_mm else mean
        mean += noise * rng.standard_normal(shape[1:], dtype=np.float32)
        hu[k] = np.rint(np.clip(mean, -1024, 3071))
    return hu, bone, implant


def plane_at(head: Anatomy, affine: Array, index: float, shape: tuple[int, ...]) -> Plane:
    """One plane of a grid in the head's frame.

    Parameters
    ----------
    head : Anatomy
        Gives centre and rotation.
    affine : ndarray, shape (4, 4)
        Voxel -> world mm.
    index : float
        Plane index.
    shape : tuple of int
        Rows, columns.

    Returns
    -------
    Plane
    """
    turn, rows, cols = head.case.rotation, np.arange(shape[0]), np.arange(shape[1])
    assert turn is not None
    start = turn.T @ (affine[:3, 3] + index * affine[:3, 0] - head.case.centre)
    steps = turn.T @ affine[:3, :3]
    p = np.array([start[i] + steps[i, 1] * rows[:, None] + steps[i, 2] * cols for i in range(3)])
    back = np.linalg.inv(steps)
    to_pixel = np.column_stack([back, -back @ start])
    to_pixel[0] *= np.linalg.norm(steps[:, 0])
    return Plane(p, to_pixel, np.linalg.norm(steps[:, 1:], axis=0))


def _width(spacing: Array, count: int) -> float:
    """How many mm a surface is blended over: a layer's mean step."""
    return float(np.sqrt(((spacing / [count, 1, 1]) ** 2).mean()))


def _share(depth: Array, width: float) -> Array:
    return np.clip(0.5 + depth / width, 0, 1)


def _values(head: Anatomy, plane: Plane, level: Depths, width: float, devices: Sequence[Device]) -> Array:
    """HU of one layer without noise."""
    values = AIR + _share(level.body, width) * (SOFT - AIR)
    fat = np.minimum(np.minimum(level.body - 2.0, 7.0 - level.body), -1.0 - level.outer)
    values += _share(fat, width) * (FAT - SOFT) * (values > AIR)
    values += _share(level.cavity, width) * (BRAIN - values)
    for index, part, depth in parts(head, plane, head.contents):
        if np.isfinite(hu := head.content_hu[index]):
            inside = depth if hu == AIR else np.minimum(depth, level.body[part])
            values[part] += _share(inside, width) * (hu - values[part])
    solid = np.nonzero(level.bone > -width)
    bone = np.minimum(level.bone, -level.cut)[solid]
    mineral = _mineral(plane.p[:, solid[0], solid[1]], level.bone[solid], level.suture[solid], width)
    values[solid] += _share(bone, width) * (mineral - values[solid])
    values += _share(level.tooth, width) * (TOOTH - values)
    for device in devices:
        device.paint(values, plane, level, width)
    return values


def _mineral(p: Array, depth: Array, suture: Array, width: float) -> Array:
    """HU of bone: compact under the surface, spongy and uneven deeper, gristle in the sutures."""
    spongy = DIPLOE + _TEXTURE * _GRAIN[tuple(np.floor(p * 1.25).astype(np.intp) & 63)]
    mineral = CORTICAL + _share(depth - _TABLE, width) * (spongy - CORTICAL)
    return mineral + _share(suture + 0.45, width) * (SUTURE - mineral)
