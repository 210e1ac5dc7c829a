"""Two polylines of a plane -> the places where they cross."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def crossings(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Where two polylines cross.

    Parameters
    ----------
    a, b : ndarray, shape (n, 2), (m, 2)
        Points of each, in one unit.

    Returns
    -------
    ndarray, shape (k, 2)
        In the order met along `a`; lines that only run beside each other have none. The time grows with n m.

    Examples
    --------
    >>> crossings(np.array([[0.0, 0.0], [2.0, 2.0]]), np.array([[0.0, 2.0], [2.0, 0.0]])).tolist()
    [[1.0, 1.0]]
    """
    if len(a) < 2 or len(b) < 2:
        return np.empty((0, 2))
    # two pieces cross where the ends of each lie on both sides of the other; a point on a line counts to its left
    of_b, of_a = _side(a, b), _side(b, a).T
    i, j = np.nonzero(
        ((of_b[:, 1:] >= 0) != (of_b[:, :-1] >= 0)) & ((of_a[1:] >= 0) != (of_a[:-1] >= 0)),
    )
    # along the piece of `a`: its ends' shares of their distances from the line of `b`
    share = (of_a[i, j] / (of_a[i, j] - of_a[i + 1, j]))[:, None]
    return a[i] + share * (a[i + 1] - a[i])


def _side(a: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """On which side of each piece of `a` points lie: positive to the left, shape (n - 1, m)."""
    step, away = np.diff(a, axis=0)[:, None], points[None] - a[:-1, None]
    return step[..., 0] * away[..., 1] - step[..., 1] * away[..., 0]
