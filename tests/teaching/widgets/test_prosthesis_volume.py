"""The panel of patches shows the patch of the design, slice by slice."""

import numpy as np
import pytest

from cranio_nb.stages import prosthesis_volume
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets.prosthesis_volume import PRESSURES, fill_slices


@pytest.mark.parametrize("pressure", PRESSURES)
def test_the_patch_of_a_slice_lies_between_its_curves(skull, openings, pressure):
    stack = fill_slices(skull(), openings()[0], pressure)
    bridged = [s for s in stack.slices if s.curves.size]
    filled = np.array([prosthesis_volume.fill_gap(*s.curves, skull().voxels[stack.first + s.plane]) for s in bridged])
    shown = stack.patches[[s.plane for s in bridged]]
    assert len(bridged) >= 3 and not (shown & ~filled).any()
    assert (filled & ~shown).sum() <= 0.02 * filled.sum()  # loose crumbs are no part of a prosthesis


def test_the_line_says_the_area_of_the_patch(static, skull, openings):
    stack = fill_slices(skull(), openings()[0], PRESSURES[1])
    panel = widgets.patch(skull(), openings()[0]).set(pressure=PRESSURES[1])
    at = panel.values["plane"] - stack.first
    area = np.count_nonzero(stack.patches[at]) * np.prod(skull().spacing[1:])
    assert f"patch of {area:.0f} mm" in panel.view.line and area > 0


def test_the_line_of_a_bridged_slice_says_its_outer_angles(static, skull, openings):
    panel = widgets.patch(skull(), openings()[0])
    stack = fill_slices(skull(), openings()[0], PRESSURES[0])
    for result in stack.slices:
        line = panel.set(plane=stack.first + result.plane).view.line
        if result.status != "balloon":
            assert "theta" not in line
            continue
        theta0, theta1 = result.inflation.theta0_deg[0], result.inflation.theta1_deg[0]
        assert f"outer theta0 {theta0:.0f}, theta1 {theta1:.0f} degrees" in line
