"""The panel of the sheet: where it comes to rest, and its steps."""

import numpy as np
import pytest

from cranio_nb.methods.dnurbs import method as dnurbs
from cranio_nb.methods.dnurbs.sheet_energy import Dynamics
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets.three_d.scene import thin_rays
from cranio_nb.teaching.widgets.three_d.sheet import relax_sheet, settle_sheet
from cranio_nb.vault import radius_measurement

SPAN_MM = 25.0


@pytest.fixture(scope="module")
def vault(skull, openings):
    return thin_rays(radius_measurement.measure_around(skull(), openings()[0]), 4)


def setting_of(vault, wavelength_mm):
    return settle_sheet(vault, *dnurbs.hold(vault, vault.outer, SPAN_MM), wavelength_mm)


def test_the_sheet_is_held_as_the_method_holds_it(vault):
    wanted = dnurbs.fit(vault, wavelength_mm=40.0, tension_mm2=0.0, span_mm=SPAN_MM).settings[0]
    found = setting_of(vault, 40.0)
    np.testing.assert_array_equal(found.springs.strength, wanted.springs.strength)
    np.testing.assert_array_equal(found.natural.control, wanted.natural.control)
    assert found.material == wanted.material


def test_mass_and_friction_do_not_move_the_place_of_rest(vault):
    setting = setting_of(vault, 40.0)
    ways = [relax_sheet(setting, Dynamics(mass=mass, damping=damping)) for mass, damping in ((0.0, 1.0), (3.0, 2.0))]
    first, second = (way.motions[-1].sheet.control for way in ways)
    assert all(way.motions[-1].converged for way in ways)
    np.testing.assert_allclose(first, second, atol=0.2)
    for way in ways:
        energy = [motion.energy for motion in way.motions]
        assert (np.diff(energy) <= 1e-9 * energy[0]).all()


def test_the_step_of_a_sheet_is_kept_within_its_way(static, skull, openings, true):
    panel = widgets.elastic_sheet(skull(), openings()[0], true)
    last = panel.view.limits["step"]
    assert panel.view.line.startswith(f"Step {last} of {last}, at rest")
    assert panel.set(step=0).view.line.startswith(f"Step 0 of {last}, not at rest")
