"""A rational sheet -> its basis functions, its derivatives, and its Jacobian by control points and weights.

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

from .sheet import BY_U, BY_UU, BY_V, BY_VU, BY_VV, VALUE, Sheet, scale_rows, tensor

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
    found: dict[Pair, sparse.csr_array] = {}
    below = {d: part @ weights.ravel() for d, part in products.items()}
    for d, total in products.items():
        # B = Q W by the product rule, solved for the highest derivative of Q
        for (i, j), times in _SHARES[d].items():
            if (i, j) != VALUE:
                total = total - scale_rows(found[d[0] - i, d[1] - j], times * below[i, j])
        found[d] = scale_rows(sparse.csr_array(total), 1 / below[VALUE])
    return found


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


def jacobians(
    sheet: Sheet, basis: Mapping[Pair, sparse.csr_array], *, free_weights: bool
) -> dict[Pair, sparse.csr_array]:
    """J, the surface by its coordinates q, and its derivatives along v and u.

    The coordinates q are all x of the control points, all y, all z, then all weights if those are free.

    Parameters
    ----------
    sheet : Sheet
    basis : dict
        From `rational_basis` with the sheet's weights.
    free_weights : bool
        Whether the weights are coordinates too.

    Returns
    -------
    dict
        The kinds of `basis` -> sparse array, shape (3 k, q): rows of x, y, z one below the other.
    """
    weights, points = sheet.weights.ravel(), sheet.control.reshape(-1, 3)
    shape = {d: part @ (points * weights[:, None]) for d, part in basis.items()}
    found = {}
    for d, part in basis.items():
        # by the control points: the same for x, y and z
        by_point = sparse.block_diag([scale_columns(part, weights)] * 3, format="csr")
        if free_weights:
            by_weight = sparse.vstack([_by_weight(basis, shape, points, d, axis) for axis in range(3)])
            by_point = sparse.hstack([by_point, by_weight], format="csr")
        found[d] = sparse.csr_array(by_point)
    return found


def _by_weight(
    basis: Mapping[Pair, sparse.csr_array], shape: Mapping[Pair, NDArray], points: NDArray, d: Pair, axis: int
) -> sparse.csr_array:
    """A derivative of ds/dw_i = (p_i - s) Q_i along one axis, by the product rule, shape (k, n m)."""
    total = scale_columns(basis[d], points[:, axis])
    for (i, j), times in _SHARES[d].items():
        total = total - scale_rows(basis[d[0] - i, d[1] - j], times * shape[i, j][:, axis])
    return sparse.csr_array(total)


def scale_columns(matrix: sparse.csr_array, by: NDArray) -> sparse.csr_array:
    """A matrix times a diagonal one, without the cost of a product of sparse matrices.

    Parameters
    ----------
    matrix : sparse array, shape (n, m)
    by : ndarray, shape (m,)

    Returns
    -------
    sparse array, shape (n, m)

    Examples
    --------
    >>> scale_columns(sparse.csr_array([[1.0, 2.0], [0.0, 3.0]]), np.array([10.0, 100.0])).toarray().tolist()
    [[10.0, 200.0], [0.0, 300.0]]
    """
    return sparse.csr_array((matrix.data * by[matrix.indices], matrix.indices, matrix.indptr), matrix.shape)
