"""The mass of a box."""

import pytest
from measured_shapes import box

from cranio_nb.implant.mass import DENSITIES, weigh_implant


def test_mass_is_volume_times_density():
    data = weigh_implant(box((20, 30, 50), (5, 6, 700)))
    assert data.volume_cm3 == pytest.approx(30)
    assert data.mass_g == pytest.approx({name: 30 * density for name, density in DENSITIES.items()})
