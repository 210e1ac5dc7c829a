"""Maps of numbers over rays or pixels, nan where nothing is known: what several stages do with them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage


def extended(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """A map with its unknown parts filled from the nearest known place.

    Parameters
    ----------
    values : ndarray, shape (M, N)
        nan where unknown, known somewhere.
    """
    nearest = ndimage.distance_transform_edt(np.isnan(values), return_distances=False, return_indices=True)
    return values[tuple(nearest)]
