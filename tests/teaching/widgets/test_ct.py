"""The CT panel shows a slice in its grey window."""

import numpy as np

from cranio_nb.teaching import widgets
from cranio_nb.volume import Volume


def test_what_lies_outside_the_window_is_black_and_white(static):
    hu = np.full((2, 60, 60), -200, np.int16)
    hu[:, :, 30:] = 900
    panel = widgets.ct_viewer(Volume(hu, np.diag([1.0, 1, 1, 1])[[2, 1, 0, 3]])).set(plane=1, centre=300, width=1000)
    assert panel.view.line == "Slice 1: -200 HU and below is black, 800 HU and above is white."
    slice_shown = panel.view.rgb[150:400, 40:380]
    assert (slice_shown[:, :150] == 0).all() and (slice_shown[:, -150:] == 255).all()
