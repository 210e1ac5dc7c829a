"""What both panels share: a radius map of fewer rays, and no need of a truth."""

import numpy as np
from scipy import ndimage

from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets.three_d.scene import thin_rays
from cranio_nb.vault import radius_measurement


def test_the_hole_of_a_coarse_chart_holds_the_hole_and_nothing_far_from_it(skull, openings):
    fine = radius_measurement.measure_around(skull(), openings()[0])
    vault = thin_rays(fine, 3)
    start = (len(fine.hole) // 2) % 3
    assert vault.hole[fine.hole[start::3, start::3]].all()
    grown = ndimage.binary_dilation(fine.hole, np.ones((3, 3)))[start::3, start::3]
    assert not (vault.hole & ~grown).any()


def test_panels_of_plates_need_no_truth(static, skull, openings):
    for panel in (widgets.bent_plate, widgets.elastic_sheet):
        assert "in the hole" not in panel(skull(), openings()[0]).view.line
