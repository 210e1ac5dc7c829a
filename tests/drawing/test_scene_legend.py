"""What stands above a live scene tells each colour and a length that fits."""

import re

import numpy as np
import pytest
from shapes import cube

from cranio_nb.drawing.scene_legend import bar_length, bounds, legend
from cranio_nb.drawing.scene_picture import Part
from cranio_nb.mesh import Mesh


@pytest.mark.parametrize(("side", "wanted"), [(40, 10), (90, 20), (190, 50)])
def test_the_bar_is_round_and_at_most_a_third_of_the_scene(side, wanted):
    assert bar_length([cube(side)]) == wanted


def test_vertices_that_no_face_uses_do_not_count():
    mesh = cube(10, (5, 0, 0))
    far = Mesh(np.concatenate([mesh.vertices, [[900.0, 0, 0]]]), mesh.faces)
    assert [place.tolist() for place in bounds([far])] == [[0, -5, -5], [10, 5, 5]]


def test_a_part_with_numbers_has_a_scale_in_place_of_a_colour():
    mesh = cube(40)
    parts = [Part(mesh, "#EDE7D8", "skull", None), Part(mesh, "#0072B2", "distance", np.full(len(mesh.vertices), 3.0))]
    shown = legend(parts, "mm")
    assert "background:#EDE7D8" in shown and "#0072B2" not in shown
    bar = re.search(r"distance: 0 <span [^>]*linear-gradient\(to right,([^)]*)\)[^>]*></span>&ge; 3 mm", shown)
    assert bar[1].startswith("#00224E,") and bar[1].endswith(",#FEE838")
