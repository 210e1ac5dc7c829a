"""The threshold panel says and draws what the stage does."""

import numpy as np
import pytest
from panels import count

from cranio_nb.drawing.palette import GREEN
from cranio_nb.stages import segmentation
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets.parts import left_window
from cranio_nb.volume import Volume


def test_the_threshold_line_counts_the_bone_of_the_slice(static, ct):
    panel = widgets.threshold(ct).set(threshold_hu=700, max_hole_mm2=0, plane=25)
    area = np.count_nonzero(segmentation.apply_threshold(ct.voxels[25], 700)) * np.prod(ct.spacing[1:]) / 100
    assert f"{area:.1f} cm" in panel.view.line


def test_holes_filled_are_drawn_green(static):
    hu = np.full((1, 60, 60), 1000, np.int16)
    hu[0, :8] = hu[0, -8:] = hu[0, :, :8] = hu[0, :, -8:] = hu[0, 28:32, 28:32] = -1000
    ct = Volume(hu, np.diag([1.0, 1, 1, 1])[[2, 1, 0, 3]])
    legend = count(widgets.threshold(ct).set(max_hole_mm2=0).view.rgb, GREEN)
    hole = count(widgets.threshold(ct).set(max_hole_mm2=20).view.rgb, GREEN) - legend
    assert hole == pytest.approx(16 * left_window(ct.voxels > -200).zoom ** 2, rel=0.1)
