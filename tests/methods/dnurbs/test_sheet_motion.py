"""A sheet in motion: its energy falls, it comes to rest, and rest is where the energy is least."""

from itertools import islice

import numpy as np
import pytest
from sheets import MATERIAL, SHAPE

from cranio_nb.methods.dnurbs import sheet, sheet_motion
from cranio_nb.methods.dnurbs.sheet import Sheet
from cranio_nb.methods.dnurbs.sheet_energy import Dynamics, potential, quadrature
from cranio_nb.methods.dnurbs.sheet_motion import _moving, _moving_frozen


@pytest.mark.parametrize("mass", [0.0, 3.0])
def test_a_frozen_sheet_comes_to_rest_where_one_solve_puts_it(wild, setting, mass):
    dynamics = Dynamics(mass=mass)
    energies = []
    still = sheet_motion.start(Sheet(wild.control, np.ones(SHAPE)), setting, dynamics)
    end = sheet_motion.relax(
        still, setting, dynamics, tol=1e-10, max_iter=2000, iter_callback=lambda m: energies.append(m.energy)
    )
    rest, _ = sheet.settle(setting.springs, setting.natural, MATERIAL)
    assert end.converged and end.n_iter == len(energies)
    np.testing.assert_allclose(end.sheet.control, rest.control, atol=1e-6)
    assert (np.diff([still.energy, *energies]) <= 1e-12 * still.energy).all()
    again = sheet_motion.relax(sheet_motion.start(rest, setting, dynamics), setting, dynamics, tol=1e-9)
    assert again.n_iter == 1 and again.moved < 1e-9  # rest is a fixed point


@pytest.mark.parametrize("weight", [1.0, 2.5])
def test_a_frozen_sheet_moves_as_the_equations_of_motion_say_step_by_step(wild, setting, weight):
    """The swing about the known place of rest, and the steps that ask for the forces at each place."""
    dynamics = Dynamics(mass=3.0, damping=0.5)
    weights = np.linspace(1.0, weight, wild.weights.size).reshape(SHAPE)
    still = sheet_motion.start(Sheet(wild.control, weights), setting, dynamics)
    known, stepped = (motions(still, setting, dynamics, 0.0) for motions in (_moving_frozen, _moving))
    for found, wanted in islice(zip(known, stepped, strict=False), 6):
        np.testing.assert_allclose(found.sheet.control, wanted.sheet.control, atol=1e-8)
        assert (found.energy, found.moved) == pytest.approx((wanted.energy, wanted.moved), rel=1e-9)
        assert found.n_iter == wanted.n_iter


@pytest.mark.parametrize(("mass", "damping"), [(1e6, 1.0), (0.0, 1e6)])
def test_a_sheet_that_is_only_slow_is_not_at_rest(wild, setting, mass, damping):
    dynamics = Dynamics(mass=mass, damping=damping)
    still = sheet_motion.start(Sheet(wild.control, np.ones(SHAPE)), setting, dynamics)
    first = sheet_motion.relax(still, setting, dynamics, tol=1e-2, max_iter=1)
    assert 0 < first.moved < 1e-2 and not first.converged


def test_free_weights_find_a_place_of_less_energy_that_is_a_least_one(setting):
    dynamics = Dynamics(free_weights=True, hold=0.1)
    rest, _ = sheet.settle(setting.springs, setting.natural, MATERIAL)
    energies = []
    end = sheet_motion.relax(
        sheet_motion.start(rest, setting, dynamics),
        setting,
        dynamics,
        tol=1e-8,
        max_iter=500,
        iter_callback=lambda m: energies.append(m.energy),
    )
    assert end.converged and (np.diff(energies) <= 1e-12 * energies[0]).all()
    sums = quadrature(setting)
    least = potential(end.sheet, setting, dynamics, sums)
    assert least < potential(rest, setting, dynamics, sums) - 1e-3
    assert end.sheet.weights.min() > 0 and np.ptp(end.sheet.weights) > 0.1
    q = sheet_motion._coordinates(end.sheet, True)
    for i in (3, 90, 165, 180, 210):
        beside = [
            sheet_motion._with_coordinates(q=q + s * np.eye(len(q))[i], sheet=end.sheet, free_weights=True)
            for s in (0.01, -0.01)
        ]
        assert all(potential(other, setting, dynamics, sums) > least for other in beside)
