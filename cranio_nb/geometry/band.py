"""Symmetric matrices whose entries lie in a band along the diagonal: stored, multiplied and solved within it.

Points of a net that are far apart do not act on each other: counted row by row, all that do are a few rows apart, and
so are their equations. Cholesky's factors of such a matrix stay within its band.

A band is an array, shape (h + 1, n), of the lower half: ``band[i - j, j]`` is the entry of row i and column j, i >= j;
what would lie below the last row is 0.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded
from threadpoolctl import ThreadpoolController

Array = NDArray[np.float64]

_libraries = lru_cache(maxsize=1)(ThreadpoolController)  # looking for them takes longer than to solve


def band_of(matrix: sparse.sparray) -> Array:
    """The band of a sparse symmetric matrix.

    Parameters
    ----------
    matrix : sparse array, shape (n, n)
        Its lower half is read; no entry twice.

    Returns
    -------
    ndarray, shape (h + 1, n)

    Examples
    --------
    >>> band_of(sparse.csr_array([[4.0, 1.0, 0.0], [1.0, 5.0, 2.0], [0.0, 2.0, 6.0]])).tolist()
    [[4.0, 5.0, 6.0], [1.0, 2.0, 0.0]]
    """
    entries = sparse.coo_array(matrix)
    below = entries.row >= entries.col
    row, column = entries.row[below], entries.col[below]
    band = np.zeros((int((row - column).max(initial=0)) + 1, matrix.shape[1]))
    band[row - column, column] = entries.data[below]
    return band


def band_times(band: Array, x: Array) -> Array:
    """A matrix times vectors.

    Parameters
    ----------
    band : ndarray, shape (h + 1, n)
    x : ndarray, shape (n,) or (n, r)

    Returns
    -------
    ndarray, shape (n,) or (n, r)

    Examples
    --------
    >>> band_times(np.array([[4.0, 5.0, 6.0], [1.0, 2.0, 0.0]]), np.array([1.0, 10.0, 100.0])).tolist()
    [14.0, 251.0, 620.0]
    """
    n = band.shape[1]
    lower = sparse.dia_array((band, -np.arange(len(band))), shape=(n, n))
    return lower @ x + lower.T @ x - (band[0] * x.T).T


def band_solver(band: Array) -> Callable[[Array], Array]:
    """Factorise a positive definite matrix once, to solve for any right-hand side.

    Parameters
    ----------
    band : ndarray, shape (h + 1, n)

    Returns
    -------
    callable
        Right-hand sides, shape (n,) or (n, r) -> solutions of the same shape; all nan when the matrix is not positive
        definite, as when springs do not hold a sheet.

    Examples
    --------
    >>> band_solver(np.array([[4.0, 5.0, 6.0], [1.0, 2.0, 0.0]]))(np.array([14.0, 251.0, 620.0])).round(9).tolist()
    [1.0, 10.0, 100.0]
    """
    try:
        with one_thread():
            factor = cholesky_banded(band, lower=True, check_finite=False)
    except LinAlgError:
        return lambda right: np.full_like(right, np.nan)

    def solve(right: Array) -> Array:
        with one_thread():
            return np.asarray(cho_solve_banded((factor, True), right, check_finite=False))

    return solve


@contextmanager
def one_thread() -> Iterator[None]:
    """One thread of BLAS for what is done meanwhile, whatever the rest of the process has.

    In narrow bands and small matrices a second one waits longer than it works: on a busy machine 15 ms become seconds.

    Examples
    --------
    >>> with one_thread():
    ...     product = np.eye(2) @ np.eye(2)
    """
    with _libraries().limit(limits=1, user_api="blas"):
        yield
