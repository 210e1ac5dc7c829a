"""A mask -> in each of its planes the signed distance to the mask's edge.

Frame: voxel (plane, row, col); distances in px of the plane.

Between planes that lie far apart, 0 and 1 blend into stairs; distances blend into a slope (shape-based interpolation,
Raya and Udupa 1990, doi 10.1109/42.52980).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def plane_distances(mask: NDArray[np.bool_], bound_px: float) -> NDArray[np.float64]:
    """Signed distance to the edge of a mask within each plane.

    Parameters
    ----------
    mask : ndarray of bool, shape (P, R, C)
        Goes on beyond the sides of a plane as it is there.
    bound_px : float
        Largest distance told; what it costs grows with it.

    Returns
    -------
    ndarray, shape (P, R, C)
        px between pixel centres: positive to the nearest pixel outside, negative to the nearest inside. A plane of one
        kind has the bound everywhere.

    Examples
    --------
    >>> plane_distances(np.array([[[False, True, True, True, True]]]), bound_px=3.0)
    array([[[-1.,  1.,  2.,  3.,  3.]]])
    """
    out = np.where(mask, bound_px, -bound_px).astype(float)
    # planes wholly of one kind have no edge: the bound holds there
    for k in np.flatnonzero(mask.any(axis=(1, 2)) & ~mask.all(axis=(1, 2))):
        signed = _to_nearest(~mask[k], bound_px) - _to_nearest(mask[k], bound_px)
        out[k] = np.clip(signed, -bound_px, bound_px)
    return out


def _to_nearest(target: NDArray[np.bool_], bound_px: float) -> NDArray[np.float64]:
    """Distance of each pixel to the nearest target, exact up to the bound, px: no farther is looked."""
    bound = int(np.ceil(bound_px))
    squares = np.where(target, 0, (bound + 1) ** 2).astype(np.int32 if bound > 100 else np.int16)
    for axis in (0, 1):  # squared distances along one axis, and those added to it along the other
        near = np.moveaxis(squares.copy(), axis, 0)
        far = np.moveaxis(squares, axis, 0)
        for step in range(1, min(bound, len(far) - 1) + 1):
            np.minimum(near[step:], far[:-step] + step**2, out=near[step:])
            np.minimum(near[:-step], far[step:] + step**2, out=near[:-step])
        squares = np.moveaxis(near, 0, axis)
    return np.sqrt(squares, dtype=np.float64)
