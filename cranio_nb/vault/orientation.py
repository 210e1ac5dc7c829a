"""Where a head lies in its scan: a bone mask comes in -> a point inside the cavity and the head's own axes go out.

Frame: world (mm, LPS). Both follow the grid of the scan, so that a turned header turns them along with the head.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..errors import InputRefused
from ..volume import Volume

_DEPTH = 85.0  # mm below the vertex: above the skull base, and every ray to the vault is free
_LEAST = 60.0  # mm that a vault spans each way
_THINNED = 2.0  # mm between the voxels that are looked at


def head_centre(bone: Volume, axes: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
    """A point on the head's axis about 85 mm below the vertex.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    axes : ndarray, shape (3, 3), optional
        Rows: the head's left, back and up, orthonormal, world; `head_axes` when not given.

    Returns
    -------
    ndarray, shape (3,)
        World mm.

    Raises
    ------
    InputRefused
        ``NoVault`` when the mask spans less than a vault.
    """
    grid_axes = head_axes(bone)
    turn = np.eye(3) if axes is None else np.round(axes @ grid_axes.T, 12)
    points = _thinned_points(bone, grid_axes) @ turn.T
    no_vault = InputRefused(
        "NoVault", "The bone found does not span a skull vault (60 mm wanted each way).", "Is this a head CT?"
    )
    if not len(points):
        raise no_vault
    # the vertex and the sides of the vault, each without its few outermost voxels
    top = np.quantile(points[:, 2], 0.9995)
    vault = points[points[:, 2] > top - _DEPTH]
    low, high = np.quantile(vault[:, :2], [0.005, 0.995], axis=0)
    if (high - low).min() < _LEAST:
        raise no_vault
    return bone.to_world(np.zeros(3)) + np.array([*(low + high) / 2, top - _DEPTH]) @ turn @ grid_axes


def head_axes(bone: Volume) -> NDArray[np.float64]:
    """Orthonormal axes of the grid; a gantry tilt is taken out of up.

    Parameters
    ----------
    bone : Volume
        Planes rise to the top of the head, rows go to the back, columns to the left.

    Returns
    -------
    ndarray, shape (3, 3)
        Rows: left, back and up, world.
    """
    up, back, left = bone.edges
    left = left / np.linalg.norm(left)
    back = back - (back @ left) * left
    back = back / np.linalg.norm(back)
    normal = np.cross(left, back)
    return np.stack([left, back, normal * np.sign(normal @ up)])


def _thinned_points(bone: Volume, grid_axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Positions of every few bone voxels from the grid's first, along its left, back and up, shape (n, 3), mm."""
    step = np.maximum(1, np.round(_THINNED / bone.spacing)).astype(int)
    coarse = bone.voxels[:: step[0], :: step[1], :: step[2]]
    own = np.round(grid_axes @ bone.edges.T, 9)  # the same whatever the header turns
    return (np.argwhere(coarse) * step) @ own.T
