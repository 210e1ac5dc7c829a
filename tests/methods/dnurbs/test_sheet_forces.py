"""What acts on a sheet, against Jacobians written out in full and against the slope of its energy."""

from dataclasses import replace

import numpy as np
import pytest
from sheets import MATERIAL, SHAPE, SPANS, dense, jacobians

from cranio_nb.methods.dnurbs import sheet, sheet_motion
from cranio_nb.methods.dnurbs.sheet import Material, Sheet, Springs
from cranio_nb.methods.dnurbs.sheet_derivatives import rational_basis, spline_products
from cranio_nb.methods.dnurbs.sheet_energy import Dynamics, Setting, potential, quadrature
from cranio_nb.methods.dnurbs.sheet_forces import by_kind, by_point, forces

HOLD = 0.7


def written_out(one, setting, free):
    """Inertia and stiffness by `by_kind` coordinates, each J^T J at each place as it is."""
    (v, by_v), (u, by_u) = (sheet.gauss(n) for n in SPANS)
    products = spline_products(np.repeat(v, len(u)), np.tile(u, len(v)), SPANS)
    inside = jacobians(one, rational_basis(one.weights, products), free_weights=free)
    weight = np.tile(np.outer(by_v, by_u).ravel(), 3)
    squared = {d: (part.T @ (weight[:, None] * part.toarray())) for d, part in inside.items()}
    springs = setting.springs
    products = spline_products(springs.v, springs.u, SPANS, (sheet.VALUE,))
    pulled = jacobians(one, rational_basis(one.weights, products), free_weights=free)[sheet.VALUE].toarray()
    elastic = pulled.T @ (np.tile(springs.strength, 3)[:, None] * pulled)
    elastic += sum(k * squared[d] for k, d in zip(setting.material.stiffness, sheet.STRAINS, strict=True))
    if free:
        elastic += np.diag(np.repeat([0.0, HOLD], [3 * one.weights.size, one.weights.size]))
    return squared[sheet.VALUE], elastic


@pytest.mark.parametrize("stiffness", [MATERIAL.stiffness, (0.0, 0.0, 0.3, 0.4, 0.5), (0.0,) * 5])
@pytest.mark.parametrize("off", [0.0, 80.0])
def test_with_free_weights_they_are_those_of_the_jacobians(wild, setting, stiffness, off):
    """Also far from the origin, as a head's vault is."""
    one = replace(wild, control=wild.control + off)
    setting = replace(setting, material=Material(stiffness))
    found = forces(one, setting, Dynamics(free_weights=True, hold=HOLD), quadrature(setting))
    order = by_point(np.arange(4.0 * one.weights.size), free_weights=True).astype(int)
    for band, wanted in zip((found.matter, found.elastic), written_out(one, setting, True), strict=True):
        np.testing.assert_allclose(dense(band), wanted[np.ix_(order, order)], atol=1e-10 * np.abs(wanted).max())


def test_with_frozen_weights_one_band_serves_x_y_and_z(wild, setting):
    found = forces(wild, setting, Dynamics(), quadrature(setting))
    for band, wanted in zip((found.matter, found.elastic), written_out(wild, setting, False), strict=True):
        np.testing.assert_allclose(np.kron(np.eye(3), dense(band)), wanted, atol=1e-10 * np.abs(wanted).max())


@pytest.mark.parametrize("free", [True, False])
def test_the_force_is_the_slope_of_the_energy(wild, setting, free):
    dynamics, sums = Dynamics(free_weights=free, hold=HOLD), quadrature(setting)
    force = by_kind(forces(wild, setting, dynamics, sums).force, free_weights=free)
    q = sheet_motion._coordinates(wild, free)
    for i in (0, 30, 60, 100, 120, *((170, 195, 220) if free else ())):
        ahead, behind = (
            potential(sheet_motion._with_coordinates(wild, q + step * np.eye(len(q))[i], free), setting, dynamics, sums)
            for step in (1e-5, -1e-5)
        )
        # rounding of the energy by the step, and the step squared
        assert force[i] == pytest.approx((behind - ahead) / 2e-5, abs=1e-8 * potential(wild, setting, dynamics, sums))


def test_the_kronecker_stiffness_is_the_one_of_gauss_points(setting):
    """The fast path and the general one agree on K where weights are 1."""
    loose = Springs(np.zeros((1, 3)), np.ones(1), np.ones(1), np.zeros(1))
    soft = Setting(loose, Sheet(setting.natural.control, np.ones(SHAPE)), MATERIAL)
    elastic = dense(forces(soft.natural, soft, Dynamics(), quadrature(soft)).elastic)
    np.testing.assert_allclose(elastic, sheet.stiffness(SPANS, MATERIAL).toarray(), atol=1e-11)


def test_a_sheet_in_its_natural_shape_with_slack_springs_feels_no_force(rng):
    v, u = rng.uniform(0, SPANS[0], 30), rng.uniform(0, SPANS[1], 30)
    natural = Sheet(rng.normal(size=(*SHAPE, 3)), np.ones(SHAPE))
    setting = Setting(Springs(natural.at(v, u), v, u, np.ones(30)), natural, MATERIAL)
    for free in (True, False):
        found = forces(natural, setting, Dynamics(free_weights=free), quadrature(setting))
        np.testing.assert_allclose(found.force, 0, atol=1e-12)
