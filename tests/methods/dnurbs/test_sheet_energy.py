"""The energy of a sheet is that of its stiffness and of the springs."""

import numpy as np
import pytest
from sheets import MATERIAL, SHAPE, SPANS

from cranio_nb.methods.dnurbs import sheet
from cranio_nb.methods.dnurbs.sheet import Sheet
from cranio_nb.methods.dnurbs.sheet_energy import Dynamics, potential, quadrature


def test_the_gauss_points_weigh_as_much_as_the_sheet_is_wide(setting):
    assert quadrature(setting).weight.sum() == pytest.approx(SPANS[0] * SPANS[1])


def test_the_energy_is_that_of_the_stiffness_and_the_springs(wild, setting):
    one = Sheet(wild.control, np.ones(SHAPE))
    off = one.control.reshape(-1, 3) - setting.natural.control.reshape(-1, 3)
    springs = setting.springs
    pulled = springs.strength @ ((springs.points - one.at(springs.v, springs.u)) ** 2).sum(axis=1)
    wanted = (np.sum(off * (sheet.stiffness(SPANS, MATERIAL) @ off)) + pulled) / 2
    found = potential(one, setting, Dynamics(), quadrature(setting))
    assert found == pytest.approx(wanted, rel=1e-12)
