"""A prosthesis and the bone around it -> how well its rim meets the bone.

Frame: meshes in world mm, the bone a `Volume`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree

from ..errors import InputRefused
from ..grid import box_around, true_indices
from ..mesh import Mesh
from ..volume import Volume

_NEIGHBOURS = 8  # surface voxels, among which the nearest box is looked for
_NEAR_MM = 8.0  # within which they usually lie, so that the rest of the mask need not be searched


@dataclass(frozen=True)
class GapStats:
    """Distance from the rim of a prosthesis to the bone around it, mm; weighted by the area of the faces."""

    mean: float
    p95: float
    max: float


def rim_gap(rim: Mesh, bone: Volume) -> GapStats:
    """How well a rim meets the bone.

    Parameters
    ----------
    rim : Mesh
        The rim faces of a prosthesis, world mm.
    bone : Volume
        Bool mask (P, R, C) of the skull with the hole.

    Returns
    -------
    GapStats
        Distance from each face's centre to the nearest bone voxel's box, 0 where they touch, weighted by face area.

    Raises
    ------
    InputRefused
        If the rim has no faces (EmptyMesh) or the skull no bone (NoBone).
    """
    if not len(rim.faces):
        raise InputRefused("EmptyMesh", "The prosthesis has no rim; a gap needs one.")
    # a percentile weighted by area: sorted gaps against the running share of the rim
    gap = distance_to_voxels(rim.centres, bone)
    order = np.argsort(gap)
    share = np.cumsum(rim.areas[order]) / rim.areas.sum()
    p95 = gap[order][min(int(np.searchsorted(share, 0.95)), len(gap) - 1)]
    return GapStats(float(np.average(gap, weights=rim.areas)), float(p95), float(gap.max()))


def distance_to_voxels(points: NDArray[np.float64], mask: Volume) -> NDArray[np.float64]:
    """Distance from points to the boxes of a mask's voxels.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
        World mm.
    mask : Volume
        Bool.

    Returns
    -------
    ndarray, shape (N,)
        mm; 0 inside a true voxel. The nearest box is looked for among the eight surface voxels whose centres are
        nearest.

    Raises
    ------
    InputRefused
        ``NoBone`` when the mask is empty.

    Examples
    --------
    >>> mask = Volume(np.ones((1, 1, 1), bool), np.eye(4))
    >>> distance_to_voxels(np.array([[0.2, 0.0, 0.0], [3.0, 0.0, 0.0]]), mask)
    array([0. , 2.5])
    """
    if not mask.voxels.any():
        raise InputRefused("NoBone", "The bone mask is empty; a gap needs bone.")
    # the boxes of the nearest surface voxels reach half a voxel to each side
    at = mask.to_voxel(points)
    step = at[:, None] - _nearest_surface(points, at, mask)
    outside = step - np.clip(step, -0.5, 0.5)
    gap = np.linalg.norm(outside @ mask.edges, axis=2).min(axis=1)
    gap[mask.at_index(at, outside=False)] = 0
    return gap


def _nearest_surface(points: NDArray[np.float64], at: NDArray[np.float64], mask: Volume) -> NDArray[np.intp]:
    """Voxels of the mask's surface nearest to points, shape (N, 8, 3), or fewer where it has fewer; `at` in voxels."""
    # a box that reaches a little further than that: its cut faces look like surface, but lie beyond
    reach = _NEAR_MM * np.linalg.norm(mask.steps(np.eye(3)), axis=0)
    whole = (slice(None),) * 3
    for box in (box_around(at, mask.shape, np.ceil(reach).astype(int) + 1), whole):
        part = mask.voxels[box]
        surface = true_indices(part & ~ndimage.binary_erosion(part)) + [side.start or 0 for side in box]
        count = min(_NEIGHBOURS, len(surface))
        if not count:
            continue
        distance, near = cKDTree(mask.to_world(surface)).query(points, k=np.arange(1, 1 + count))
        if count == _NEIGHBOURS and distance.max() <= _NEAR_MM:
            break
    return surface[near]
