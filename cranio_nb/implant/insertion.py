"""A prosthesis and a way out of the head -> whether it goes in that way, and what must be taken off it first.

Frame: masks as `Volume`s on the bone's grid, meshes in world mm, axes in the world (LPS).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..errors import InputRefused
from ..grid import nearest_values
from ..mesh import Mesh
from ..volume import Volume, check_same_grid


def undercut_share(rim: Mesh, axis: NDArray[np.float64], *, tolerance_deg: float = 5.0) -> float:
    """Share of the rim that holds the implant back when it is moved along an axis.

    Parameters
    ----------
    rim : Mesh
        Rim faces of a prosthesis: those that face bone.
    axis : ndarray, shape (3,)
        The way out, away from the brain; any length.
    tolerance_deg : float
        Angle by which a wall may lean over without being counted.

    Returns
    -------
    float
        Area of the rim faces that look along the axis, over the area of the rim; 0 to 1, and 0 for an empty rim.
        0 means that it can be put in from outside.
    """
    areas = rim.areas
    if not areas.sum():
        return 0.0
    lean = rim.normals @ _unit(axis)
    return float(areas[lean > np.sin(np.deg2rad(tolerance_deg))].sum() / areas.sum())


def find_part_to_trim(patch: Volume, bone: Volume, axis: NDArray[np.float64], *, travel_mm: float = 30.0) -> Volume:
    """The part of a patch that meets bone on its way out along an axis, and must be trimmed to let it in.

    Parameters
    ----------
    patch, bone : Volume
        Bool masks (P, R, C) on one grid.
    axis : ndarray, shape (3,)
        The way out, away from the brain; any length.
    travel_mm : float
        How far the patch is moved.

    Returns
    -------
    Volume
        Bool mask (P, R, C), part of the patch. Bone's own surface layer is not counted, so that a wall along the
        axis does not catch on its stairs: less than a voxel of undercut goes unseen.
    """
    check_same_grid(patch, bone, "patch and bone")
    # the patch is moved by a voxel's width at a time
    stride = bone.spacing.min()
    step = bone.steps(_unit(axis)) * stride
    box = patch.box(np.ceil(np.abs(step) * travel_mm / stride).astype(int) + 2)
    hard = ndimage.binary_erosion(bone.voxels[box])
    here = np.argwhere(patch.voxels[box])
    caught = np.zeros(len(here), bool)
    for n in range(1, int(travel_mm / stride) + 1):
        caught |= nearest_values(hard, here + n * step, outside=False)
    trimmed = np.zeros(patch.shape, bool)
    trimmed[box][tuple(here[caught].T)] = True
    return patch.with_voxels(trimmed)


def _unit(axis: NDArray[np.float64]) -> NDArray[np.float64]:
    axis = np.asarray(axis, float)
    length = np.linalg.norm(axis)
    if axis.shape != (3,) or not np.isfinite(length) or length == 0:
        raise InputRefused("BadAxis", f"The axis has shape {axis.shape} and length {length}; give three numbers.")
    return axis / length
