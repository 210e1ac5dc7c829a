"""A rational sheet -> its basis functions and its derivatives, along it and by control points and weights.

Frame: as in `sheet`. With the B-splines B_i of all control points and W = sum w B,

    s = sum w_i p_i Q_i,    Q_i = B_i / W,    ds/dp_i = w_i Q_i,    ds/dw_i = (p_i - s) Q_i,

and their derivatives along v and u follow from the product rule, those of Q from B = Q W. The B-splines themselves
depend on places and spans alone (`spline_products`), so that a moving sheet needs them once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from .sheet import BY_U, BY_UU, BY_V, BY_VU, BY_VV, LOCAL, VALUE, Sheet, tensor

Pair = tuple[int, int]

_SHARES: dict[Pair, dict[Pair, int]] = {
    VALUE: {VALUE: 1},
    BY_V: {VALUE: 1, BY_V: 1},
    BY_U: {VALUE: 1, BY_U: 1},
    BY_VV: {VALUE: 1, BY_V: 2, BY_VV: 1},
    BY_VU: {VALUE: 1, BY_V: 1, BY_U: 1, BY_VU: 1},
    BY_UU: {VALUE: 1, BY_U: 2, BY_UU: 1},
}
"""Leibniz: a derivative of a product sums these derivatives of one factor, so often, with the rest of the other."""


def spline_products(
    v: NDArray[np.float64], u: NDArray[np.float64], spans: tuple[int, int], kinds: Sequence[Pair] = tuple(_SHARES)
) -> dict[Pair, sparse.csr_array]:
    """Products of the B-splines along v and u, and derivatives of them.

    Parameters
    ----------
    v, u, spans
        As for `tensor`.
    kinds : sequence of (int, int)
        (times by v, times by u), lower ones first; by default up to the second.

    Returns
    -------
    dict
        Each kind -> sparse array, shape (k, n m).

    Examples
    --------
    >>> found = spline_products(np.array([0.5]), np.array([1.5]), (4, 4))
    >>> list(found), round(float(found[0, 0].sum()), 9)
    ([(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)], 1.0)
    """
    return {d: tensor(v, u, spans, d) for d in kinds}


def rational_basis(
    weights: NDArray[np.float64], products: Mapping[Pair, sparse.csr_array]
) -> dict[Pair, sparse.csr_array]:
    """The basis functions Q of a rational surface, and derivatives of them.

    Parameters
    ----------
    weights : ndarray, shape (n, m)
        Of the control points.
    products : dict
        From `spline_products`.

    Returns
    -------
    dict
        The kinds of `products` -> sparse array, shape (k, n m).

    Examples
    --------
    The weighted sum of the basis functions is 1, whatever the weights:

    >>> weights = np.linspace(1.0, 2.0, 49).reshape(7, 7)
    >>> basis = rational_basis(weights, spline_products(np.array([0.5]), np.array([1.5]), (4, 4)))
    >>> (basis[0, 0] @ weights.ravel()).round(9)
    array([1.])
    """
    # all kinds have their entries in the same columns, so that arrays of entries are enough
    below = {d: part @ weights.ravel() for d, part in products.items()}
    found: dict[Pair, NDArray[np.float64]] = {}
    for d, part in products.items():
        # B = Q W by the product rule, solved for the highest derivative of Q
        rest = sum(found[d[0] - i, d[1] - j] * _column(n * below[i, j]) for (i, j), n in _lower_shares(d))
        found[d] = (local_entries(part) - rest) / _column(below[VALUE])
    return {d: sparse.csr_array((found[d].ravel(), b.indices, b.indptr), b.shape) for d, b in products.items()}


def derivatives(sheet: Sheet, basis: Mapping[Pair, sparse.csr_array]) -> dict[Pair, NDArray[np.float64]]:
    """The surface and its derivatives.

    Parameters
    ----------
    sheet : Sheet
    basis : dict
        From `rational_basis` with the sheet's weights.

    Returns
    -------
    dict
        The kinds of `basis` -> ndarray, shape (k, 3), mm.
    """
    points = sheet.control.reshape(-1, 3) * sheet.weights.reshape(-1, 1)
    return {d: part @ points for d, part in basis.items()}


def shape_products(
    basis: Mapping[Pair, sparse.csr_array],
    shape: Mapping[Pair, NDArray[np.float64]],
    kinds: Sequence[Pair],
    scale: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Derivatives along v and u of s Q_i, by the product rule: what ds/dw_i is off p_i Q_i.

    Parameters
    ----------
    basis, shape : dict
        From `rational_basis` and `derivatives`; s may be taken from another origin at each place.
    kinds : sequence of (int, int)
        Times by v, times by u; those of `basis` or some of them.
    scale : ndarray, shape (k, kinds)
        A factor for each.

    Returns
    -------
    ndarray, shape (k, kinds, 3, 16)
        By the control points that move each place.
    """
    number = {d: n for n, d in enumerate(basis)}
    splines = np.stack([local_entries(part) for part in basis.values()], axis=1)
    factors = np.zeros((*scale.shape, 3, len(basis)))
    for row, d in enumerate(kinds):
        for (i, j), times in _SHARES[d].items():
            factors[:, row, :, number[d[0] - i, d[1] - j]] = times * scale[:, row, None] * shape[i, j]
    # a small matrix times another one for each place
    return (factors.reshape(len(scale), -1, len(basis)) @ splines).reshape(*scale.shape, 3, LOCAL)


def local_entries(matrix: sparse.csr_array) -> NDArray[np.float64]:
    """The entries of a matrix that has one for each control point that moves a place.

    Parameters
    ----------
    matrix : sparse array, shape (k, n m)
        From `tensor`, `spline_products` or `rational_basis`.

    Returns
    -------
    ndarray, shape (k, 16)
    """
    return matrix.data.reshape(-1, LOCAL)


def _lower_shares(d: Pair) -> list[tuple[Pair, int]]:
    """The shares of a derivative without the factor itself."""
    return [(share, times) for share, times in _SHARES[d].items() if share != VALUE]


def _column(x: NDArray) -> NDArray:
    return x[:, None]
