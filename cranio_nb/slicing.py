"""Along which planes a lesion is cut: a bone mask and a lesion come in -> the bone on a grid of slices goes out.

Frames: voxel (plane, row, col) of the bone's grid -> voxel of the slice grid, whose planes are the slices; both stand
in the same world (mm, LPS).

The paper cuts axially and its lesion is lateral. Near the vertex an axial slice is a cap, not a ring, and meets the
rim at a flat angle. The plane that suits a lesion holds the lesion's mean direction and crosses it the short way.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from .prosthesis import Lesion
from .volume import Volume

_STEP = 0.5  # mm between pixels of an oblique slice
_APART = 1.0  # mm between oblique slices
_BESIDE = 12.0  # mm of slices kept beyond the opening, for worn rims
_MARGIN = 45.0  # mm of bone kept beside the opening, to fit tangents on
_DEPTH = 30.0  # mm kept below and above the sheet


def best_axes(lesion: Lesion) -> NDArray[np.float64]:
    """Axes of the slice grid that suits a lesion.

    Returns
    -------
    ndarray, shape (3, 3)
        Columns are unit vectors (world, LPS) along plane, row and col: rows run against the lesion's direction, and
        the planes follow each other along the lesion's long side, so that every slice crosses the short one.
    """
    out = lesion.direction
    points = lesion.opening.to_world(np.argwhere(lesion.opening.voxels)[::7])
    flat = points - points.mean(axis=0)
    flat = flat - np.outer(flat @ out, out)
    long_side = np.linalg.svd(flat, full_matrices=False)[2][0]
    across = np.cross(-out, long_side)
    return np.stack([long_side, -out, across], axis=1)


def cut(bone: Volume, lesion: Lesion, axes: NDArray[np.float64]) -> Volume:
    """Resample the bone around a lesion along given axes.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    lesion : Lesion
    axes : ndarray, shape (3, 3)
        Columns: unit vectors of plane, row, col.

    Returns
    -------
    Volume
        Bool mask on the slice grid, 0.5 mm pixels, slices 1 mm apart.
    """
    local = lesion.opening.to_world(np.argwhere(lesion.opening.voxels)) @ axes
    margin = np.array([_BESIDE, _DEPTH, _MARGIN])
    low, high = local.min(axis=0) - margin, local.max(axis=0) + margin
    step = np.array([_APART, _STEP, _STEP])
    shape = np.ceil((high - low) / step).astype(int) + 1
    affine = np.eye(4)
    affine[:3, :3] = axes * step
    affine[:3, 3] = axes @ low
    return Volume(resample(bone, affine, tuple(shape)) > 0.5, affine)


def resample(volume: Volume, affine: NDArray[np.float64], shape: tuple[int, ...]) -> NDArray[np.float32]:
    """Linear interpolation of a mask on another grid.

    Parameters
    ----------
    volume : Volume
        Bool mask.
    affine : ndarray, shape (4, 4)
        Of the other grid.
    shape : tuple of int
        Of the other grid.

    Returns
    -------
    ndarray of float32, shape `shape`
        Above 0.5 inside, below outside; 0 where the mask's grid ends.

    Notes
    -----
    Between far-apart planes (more than twice the pixel size) 0 and 1 would blend into stairs. There the signed
    distances of the planes are interpolated instead (shape-based interpolation, Raya and Udupa 1990).
    """
    to_index = np.linalg.inv(volume.affine) @ affine
    corners = np.array(np.meshgrid(*[(0, n - 1) for n in shape])).reshape(3, -1)
    at = to_index[:3, :3] @ corners + to_index[:3, 3:]
    low = np.clip(np.floor(at.min(axis=1)).astype(int) - 1, 0, np.array(volume.shape) - 1)
    high = np.clip(np.ceil(at.max(axis=1)).astype(int) + 2, low + 1, volume.shape)
    part = volume.voxels[tuple(slice(a, b) for a, b in zip(low, high, strict=True))]
    thick = volume.spacing[0] > 2 * volume.spacing[1:].max()
    field = _plane_distances(part) if thick else part.astype(np.float32)
    return ndimage.affine_transform(
        field, to_index[:3, :3], to_index[:3, 3] - low, output_shape=tuple(shape), order=1, output=np.float32
    )


def _plane_distances(mask: NDArray[np.bool_], reach: float = 8.0) -> NDArray[np.float32]:
    """In each plane 0.5 + signed distance to the edge of the mask in px, bounded by `reach`; empty planes 0."""
    field = np.zeros(mask.shape, np.float32)
    for plane in np.flatnonzero(mask.any(axis=(1, 2))):
        inside = ndimage.distance_transform_edt(np.pad(mask[plane], 1))[1:-1, 1:-1]
        outside = ndimage.distance_transform_edt(~mask[plane])
        field[plane] = np.clip(inside - outside, -reach, reach) + np.where(mask[plane], 0.0, 1.0)
    return field
