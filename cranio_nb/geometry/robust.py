"""Residuals -> how far they spread and what each still counts; least squares that outliers cannot bend.

Frame: any; residuals and scales share one unit.

A weight w(r) multiplies the square of a residual r. Iterated with the weights of its own residuals, a least-squares fit
minimises the weight's own loss instead of the squares (Holland and Welsch 1977, doi 10.1080/03610927708827533).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TUKEY_CUT = 4.685
"""Standard deviations beyond which `tukey_weights` usually leave a residual out: 95 % efficient on normal noise."""
_LEAST_LEVEL = 1e-8  # of the largest eigenvalue of the normal equations, below which they are badly conditioned


def spread(residuals: Array) -> float:
    """Standard deviation of normal residuals, estimated by their median size.

    Parameters
    ----------
    residuals : ndarray, shape (n,)

    Returns
    -------
    float
        1.4826 times the median of the absolute residuals.

    Examples
    --------
    >>> round(spread(np.array([-1.0, 0.5, 1.0, 2.0, -90.0])), 4)
    1.4826
    """
    return 1.4826 * float(np.median(np.abs(residuals)))


def cauchy_weights(residuals: Array, scale: float | Array, *, times: float | NDArray = 1.0) -> Array:
    """Weights 1 / (1 + (r / scale)^2): an outlier counts little, but never nothing.

    Parameters
    ----------
    residuals : ndarray, shape (...)
    scale : float or ndarray
        Where the weight is a half.
    times : float or ndarray
        Weights that these multiply.

    Returns
    -------
    ndarray, shape (...)
        0 to `times`.
    """
    return times / (1 + (residuals / scale) ** 2)


def geman_mcclure_weights(residuals: Array, scale: float | Array, *, times: float | NDArray = 1.0) -> Array:
    """Weights 1 / (1 + (r / scale)^2)^2: the square of Cauchy's.

    Parameters
    ----------
    residuals, times
        As for `cauchy_weights`.
    scale : float or ndarray
        Where the weight is a quarter.

    Returns
    -------
    ndarray, shape (...)
        0 to `times`.
    """
    return times / (1 + (residuals / scale) ** 2) ** 2


def huber_weights(residuals: Array, scale: float | Array) -> Array:
    """Weights min(1, scale / |r|): an outlier pulls as hard as a residual of one scale.

    Parameters
    ----------
    residuals : ndarray, shape (...)
    scale : float or ndarray
        Up to which a residual counts in full.

    Returns
    -------
    ndarray, shape (...)
        0 to 1.
    """
    return 1 / np.maximum(1, np.abs(residuals) / scale)


def tukey_weights(residuals: Array, cut: float | Array) -> Array:
    """Tukey's biweight (1 - (r / cut)^2)^2, nothing beyond the cut.

    Parameters
    ----------
    residuals : ndarray, shape (...)
    cut : float or ndarray
        From which a residual counts for nothing.

    Returns
    -------
    ndarray, shape (...)
        0 to 1.

    Examples
    --------
    >>> tukey_weights(np.array([0.0, 1.0, 2.0, 9.0]), 2.0)
    array([1.    , 0.5625, 0.    , 0.    ])
    """
    return np.maximum(1 - (residuals / cut) ** 2, 0.0) ** 2


def weighted_fit(basis: Array, values: Array, factors: Array, *, ridge: float = 0.0) -> Array:
    """Least squares with a factor for each equation.

    Parameters
    ----------
    basis : ndarray, shape (n, k)
    values : ndarray, shape (n,)
    factors : ndarray, shape (n,)
        Multiply the residuals themselves: the roots of weights.
    ridge : float
        Adds ridge^2 times the square of each coefficient to the sum.

    Returns
    -------
    ndarray, shape (k,)
        Coefficients c for which the sum of (factors (values - basis c))^2 is least; the shortest where there are many.

    Notes
    -----
    Solved by the normal equations and one step of refinement; badly conditioned systems by singular values.

    Examples
    --------
    >>> line = np.array([[1.0, 0.0], [1.0, 1.0], [1.0, 2.0]])
    >>> weighted_fit(line, np.array([1.0, 3.0, 90.0]), np.array([1.0, 1.0, 0.0])).round(9)
    array([1., 2.])
    """
    system, target = basis * factors[:, None], values * factors
    n = basis.shape[1]
    # normal equations: (A^T A + ridge^2) c = A^T b, by eigenvalues, which tell how well they are conditioned
    levels, axes = np.linalg.eigh(system.T @ system + ridge**2 * np.eye(n))
    if levels[0] > _LEAST_LEVEL * levels[-1]:
        c = axes @ ((axes.T @ (system.T @ target)) / levels)
        # once more for what is left: that gives back the digits that squaring the system took
        left = system.T @ (target - system @ c) - ridge**2 * c
        return np.asarray(c + axes @ ((axes.T @ left) / levels), float)
    # else by singular values, with ridge * coefficient = 0 as further equations
    if ridge:
        system, target = np.concatenate([system, ridge * np.eye(n)]), np.concatenate([target, np.zeros(n)])
    return np.asarray(np.linalg.lstsq(system, target, rcond=None)[0], float)


def reweighted_fit(
    basis: Array, values: Array, factors_of: Callable[[Array], Array], *, start: Array, n_iter: int, ridge: float = 0.0
) -> Array:
    """Least squares, repeated with factors that follow from the residuals.

    Parameters
    ----------
    basis : ndarray, shape (n, k)
    values : ndarray, shape (n,)
    factors_of : callable
        Residuals, shape (n,) -> factors as in `weighted_fit`, shape (n,).
    start : ndarray, shape (n,)
        Factors of the first fit.
    n_iter : int
        Number of fits, at least 1.
    ridge : float
        As in `weighted_fit`.

    Returns
    -------
    ndarray, shape (k,)
        Coefficients.

    Examples
    --------
    >>> values = np.array([1.0, 1.1, 0.9, 1.0, 50.0])
    >>> mean = reweighted_fit(np.ones((5, 1)), values, lambda r: cauchy_weights(r, 0.5), start=np.ones(5), n_iter=20)
    >>> mean.round(2)
    array([1.])
    """
    # fixed-point iteration: fit, residuals, factors
    factors = start
    for _ in range(n_iter):
        coefficients = weighted_fit(basis, values, factors, ridge=ridge)
        factors = factors_of(values - basis @ coefficients)
    return coefficients
