"""The panel of the surface: vertices stay within their voxel."""

import numpy as np

from cranio_nb.teaching import widgets


def test_unsmoothed_vertices_have_not_moved_and_smoothed_stay_in_their_voxel(static, design):
    panel = widgets.surface(design.patch)
    assert "0.00 mm on average, 0.00 mm at most" in panel.set(steps=0).view.line
    most = float(panel.set(steps=30).view.line.split(" mm at most")[0].split()[-1])
    assert 0 < most <= np.linalg.norm(design.patch.spacing) / 2 + 0.005
