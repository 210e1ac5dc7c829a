"""A small sheet of known shape and material, and what it is measured against, for the tests of D-NURBS."""

from math import comb

import numpy as np
from scipy import sparse

from cranio_nb.methods.dnurbs.sheet import Material, Sheet

SPANS = (5, 4)
SHAPE = (8, 7)
MATERIAL = Material((0.1, 0.2, 0.3, 0.4, 0.5))


def greville(spans):
    """Parameters whose own coefficients make s(x) = x."""
    knots = np.concatenate([np.zeros(3), np.arange(spans + 1.0), np.full(3, spans)])
    return (knots[1:-3] + knots[2:-2] + knots[3:-1]) / 3


def plane():
    v, u = np.meshgrid(*(greville(n) for n in SPANS), indexing="ij")
    return Sheet(np.stack([2 * v, 3 * u, v - u + 1], axis=-1), np.ones(SHAPE))


def jacobians(one, basis, *, free_weights):
    """J and its derivatives along v and u, each a sparse array of 3 k rows: those of x, of y, of z.

    Columns are all x of the control points, all y, all z, then all weights if those are free: ds/dp_i = w_i Q_i and
    ds/dw_i = (p_i - s) Q_i, by the product rule.
    """
    weights, points = one.weights.ravel(), one.control.reshape(-1, 3)
    shape = {d: part @ (points * weights[:, None]) for d, part in basis.items()}
    found = {}
    for d, part in basis.items():
        by_point = sparse.block_diag([part @ sparse.diags_array(weights)] * 3, format="csr")
        rows = []
        for axis in range(3):
            row = part @ sparse.diags_array(points[:, axis])
            for i, j in np.ndindex(d[0] + 1, d[1] + 1):
                share = sparse.diags_array(comb(d[0], i) * comb(d[1], j) * shape[i, j][:, axis])
                row = row - share @ basis[d[0] - i, d[1] - j]
            rows.append(row)
        found[d] = sparse.hstack([by_point, sparse.vstack(rows)], format="csr") if free_weights else by_point
    return found


def dense(band):
    """The symmetric matrix of a lower band."""
    n = band.shape[1]
    lower = sum(np.diag(part[: n - below], -below) for below, part in enumerate(band))
    return lower + np.tril(lower, -1).T
