"""Sparse symmetric systems of equations: by their band where it is narrow, else by sparse factors."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu

from .band import band_of, band_solver

Array = NDArray[np.float64]

_NARROW = 200  # diagonals: of so many at most, LAPACK's dense band is factorised sooner than sparse factors are found


def solve(matrix: sparse.csc_array, right: Array) -> Array:
    """Solve a sparse symmetric positive definite system.

    Parameters
    ----------
    matrix : sparse array, shape (n, n)
    right : ndarray, shape (n,)

    Returns
    -------
    ndarray, shape (n,)

    Raises
    ------
    RuntimeError
        The matrix is exactly singular.

    Examples
    --------
    >>> solve(sparse.csc_array(np.array([[4.0, 2.0], [2.0, 3.0]])), np.array([8.0, 8.0])).round(9).tolist()
    [1.0, 2.0]
    """
    entries = matrix.tocoo()
    if (entries.row - entries.col).max(initial=0) <= _NARROW:
        solution = band_solver(band_of(matrix))(right)
        if np.isfinite(solution).all():  # else so little is held that rounding decides, and there are no roots to take
            return solution
    factors = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return np.asarray(factors.solve(right))
