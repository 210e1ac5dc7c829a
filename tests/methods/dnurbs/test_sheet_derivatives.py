"""Derivatives of a rational sheet, along it and by its coordinates, against finite differences."""

import numpy as np
from sheets import SHAPE, SPANS, jacobians

from cranio_nb.methods.dnurbs import sheet, sheet_motion
from cranio_nb.methods.dnurbs.sheet_derivatives import derivatives, rational_basis, spline_products


def test_with_weights_all_alike_the_basis_is_that_of_the_splines(places):
    """Q = B / w where all weights are w: the factor is all that is left of them."""
    products = spline_products(*places, SPANS)
    for d, part in rational_basis(np.full(SHAPE, 4.0), products).items():
        assert abs(4.0 * part - products[d]).max() < 1e-12


def test_derivatives_along_the_sheet_are_those_of_finite_differences(wild, places):
    v, u = (np.clip(x, 0.01, n - 0.01) for x, n in zip(places, SPANS, strict=True))
    shape = derivatives(wild, rational_basis(wild.weights, spline_products(v, u, SPANS)))
    for lower, higher in ((sheet.VALUE, sheet.BY_V), (sheet.BY_V, sheet.BY_VV), (sheet.BY_U, sheet.BY_VU)):
        ahead, behind = (
            derivatives(wild, rational_basis(wild.weights, spline_products(v + step, u, SPANS)))
            for step in (1e-5, -1e-5)
        )
        np.testing.assert_allclose((ahead[lower] - behind[lower]) / 2e-5, shape[higher], rtol=1e-5, atol=1e-5)


def test_frozen_weights_leave_the_jacobian_of_the_control_points(wild, places):
    basis = rational_basis(wild.weights, spline_products(*places, SPANS, (sheet.VALUE,)))
    (all_q,), (points,) = (jacobians(wild, basis, free_weights=free).values() for free in (True, False))
    n = 3 * wild.weights.size
    assert points.shape == (3 * len(places[0]), n) and abs(all_q[:, :n] - points).max() == 0


def test_s_is_j_q_and_j_is_the_derivative_by_q(wild, places):
    products = spline_products(*places, SPANS)
    basis = rational_basis(wild.weights, products)
    q = sheet_motion._coordinates(wild, True)
    shape = derivatives(wild, basis)
    np.testing.assert_allclose(shape[sheet.VALUE], wild.at(*places), atol=1e-13)

    def shape_at(moved):
        other = sheet_motion._with_coordinates(wild, moved, True)
        return derivatives(other, rational_basis(other.weights, products))

    for d, part in jacobians(wild, basis, free_weights=True).items():
        np.testing.assert_allclose(part @ q, shape[d].T.ravel(), atol=1e-11)
        for i in (0, 100, 170, 200):
            ahead, behind = (shape_at(q + step * np.eye(len(q))[i]) for step in (1e-6, -1e-6))
            slope = (ahead[d] - behind[d]).T.ravel() / 2e-6
            np.testing.assert_allclose(part[:, [i]].toarray().ravel(), slope, atol=1e-6)
