"""Random places, a random sheet, and springs that pull on one."""

import numpy as np
import pytest
from sheets import MATERIAL, SHAPE, SPANS

from cranio_nb.methods.dnurbs.sheet import Sheet, Springs
from cranio_nb.methods.dnurbs.sheet_energy import Setting


@pytest.fixture
def rng():
    return np.random.default_rng(7)


@pytest.fixture
def places(rng):
    return rng.uniform(0, SPANS[0], 40), rng.uniform(0, SPANS[1], 40)


@pytest.fixture
def wild(rng):
    return Sheet(rng.normal(size=(*SHAPE, 3)), rng.uniform(0.5, 2, SHAPE))


@pytest.fixture
def setting(rng, places):
    springs = Springs(rng.normal(size=(40, 3)), *places, rng.uniform(0.5, 2, 40))
    return Setting(springs, Sheet(rng.normal(size=(*SHAPE, 3)), np.ones(SHAPE)), MATERIAL)
