"""The panels of the rivals: guiding points as the method places them, the plane with the least residual."""

import numpy as np
import pytest

from cranio_nb.evaluation import mesh_distances
from cranio_nb.mesh import OUTER
from cranio_nb.methods.you import method as you
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets.rivals import move_plane
from cranio_nb.vault import radius_measurement, symmetry
from cranio_nb.vault.outer_surface import measure_outer_surface


def test_guiding_points_say_what_the_method_fills(static, skull, openings, true):
    panel = widgets.guiding_points(skull(), openings()[0], true).set(n=8)
    made = you.fill_between(
        skull(), openings()[0], you.find_guides(radius_measurement.measure_around(skull(), openings()[0]), 8)
    )
    off = mesh_distances.surface_distance(made.outer.mesh.vertices, true.surface(OUTER))
    assert panel.view.line.startswith("8 guiding points: ")
    assert f"{off.mean():.2f} mm from the true surface on average, {off.max():.2f} mm at most" in panel.view.line


def test_guiding_points_need_no_truth(static, skull, openings):
    line = widgets.guiding_points(skull(), openings()[0]).view.line
    assert line.startswith("12 guiding points") and "true" not in line


def test_the_found_plane_has_the_least_residual(static, skull, openings):
    found = symmetry.find_symmetry_plane(skull(), openings()[0].head_centre)
    panel = widgets.symmetry_plane(skull(), openings()[0])
    moves = ({}, {"turn_deg": 4.0}, {"turn_deg": 0.0, "lean_deg": -5.0}, {"lean_deg": 0.0, "shift_mm": 3.0})
    lines = [panel.set(**move).view.line for move in moves]
    least, *others = (float(line.split("residual ")[1].split(" mm")[0]) for line in lines)
    assert least == pytest.approx(found.residual_mm, abs=0.01)
    assert all(other > 2 * least for other in others)


def test_a_plane_shifted_by_one_mm_moves_the_image_by_two(skull, openings):
    centre = openings()[0].head_centre
    found, surface = symmetry.find_symmetry_plane(skull(), centre), measure_outer_surface(skull(), centre)
    other = move_plane(found, surface, turn_deg=0.0, lean_deg=0.0, shift_mm=1.0)
    np.testing.assert_allclose(other.mirror(centre) - found.mirror(centre), 2 * found.normal, atol=1e-9)
