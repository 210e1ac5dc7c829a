"""A patch and the bone around it -> the patch with a gap to the bone, so that it can be fitted.

Frame: masks as `Volume`s on one grid.
"""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from ..errors import InputRefused
from ..volume import Volume, check_same_grid


def with_clearance(patch: Volume, bone: Volume, *, gap_mm: float) -> Volume:
    """The patch without what lies nearer to bone than a gap.

    Parameters
    ----------
    patch, bone : Volume
        Bool masks (P, R, C) on one grid, with axes at right angles.
    gap_mm : float
        Wanted between the faces of the voxels, > 0: 0.25 to 0.4 suits common printers.

    Returns
    -------
    Volume
        Bool mask (P, R, C). The gap is never smaller than `gap_mm`; it comes in whole voxels, so thick slices lose a
        whole slice where bone lies above or below.

    Raises
    ------
    InputRefused
        If the grids differ (GridMismatch) or the gap is not positive (BadClearance).
    """
    check_same_grid(patch, bone, "patch and bone")
    if not gap_mm > 0:
        raise InputRefused("BadClearance", f"A clearance of {gap_mm} mm was asked for; it must be above 0.")
    # all steps to a voxel whose faces lie nearer than the gap
    reach = np.ceil(gap_mm / bone.spacing).astype(int)
    box = patch.box(reach + 1)
    steps = np.stack(np.meshgrid(*[np.arange(-r, r + 1) for r in reach], indexing="ij"), axis=-1)
    gap = np.linalg.norm(np.maximum(np.abs(steps) - 1, 0) * bone.spacing, axis=-1)
    near = ndimage.binary_dilation(bone.voxels[box], structure=gap < gap_mm - 1e-6)
    kept = np.zeros(patch.shape, bool)
    kept[box] = patch.voxels[box] & ~near
    return patch.with_voxels(kept)
