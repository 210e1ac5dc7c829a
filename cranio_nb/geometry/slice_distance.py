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
    bound = int(np.ceil(bound_px))
    far = (bound + 1) ** 2  # no farther is looked
    # planes wholly of one kind have no edge: the bound holds there
    for k in np.flatnonzero(mask.any(axis=(1, 2)) & ~mask.all(axis=(1, 2))):
        for kind in (True, False):
            # squared distances to the other kind along the rows' axis, and those added to it along the columns'
            squares = np.where(mask[k] == kind, far, 0).astype(np.int32 if bound > 100 else np.int16)
            for lines in (np.asarray, np.transpose):
                known = lines(squares.copy())
                near = lines(squares)
                for step in range(1, min(bound, len(known) - 1) + 1):
                    np.minimum(near[step:], known[:-step] + step**2, out=near[step:])
                    np.minimum(near[:-step], known[step:] + step**2, out=near[:-step])
            told = np.minimum(np.sqrt(squares, dtype=np.float64), bound_px)
            np.copyto(out[k], told if kind else -told, where=mask[k] == kind)
    return out
