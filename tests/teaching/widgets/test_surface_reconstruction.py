"""The panel of the surface: vertices stay within their voxel."""

import numpy as np

from cranio_nb.stages.surface_reconstruction import extract_surface, measure_deviation
from cranio_nb.teaching import widgets


def test_unsmoothed_vertices_have_not_moved_and_smoothed_stay_in_their_voxel(static, design):
    panel = widgets.surface(design.patch)
    assert "0.00 mm on average, 0.00 mm at most" in panel.set(steps=0).view.line
    most = float(panel.set(steps=30).view.line.split(" mm at most")[0].split()[-1])
    assert 0 < most <= np.linalg.norm(design.patch.spacing) / 2 + 0.005


def test_the_panel_shows_the_surface_that_the_stage_makes(static, design):
    """It runs the relaxation once for all numbers of steps, the stage once for each."""
    panel, raw = widgets.surface(design.patch), extract_surface(design.patch, smooth=False)
    for n in (1, 7, 48):
        moved = measure_deviation(raw, extract_surface(design.patch, n_steps=n))
        line = panel.set(steps=n).view.line
        assert f"vertices moved {moved.mean_mm:.2f} mm on average, {moved.max_mm:.2f} mm at most" in line
