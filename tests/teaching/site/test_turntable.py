"""A scene seen from all round: one scale, sides where they are, the way the scene is shown first."""

import numpy as np
from panels import count

from cranio_nb.drawing.palette import BLUE
from cranio_nb.drawing.scene3d import show_meshes
from cranio_nb.mesh import Mesh
from cranio_nb.teaching.site.turntable import all_round, turntable


def rod(low, high):
    """A box along z, 8 mm wide, mm."""
    box = np.array([[x, y, z] for x in (-4.0, 4.0) for y in (-4.0, 4.0) for z in (low, high)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return Mesh(box, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]))


def test_the_scene_is_shown_first_as_in_the_lesson():
    panel = turntable(show_meshes(rod(0, 50), alt="A rod.", towards=(1, 0, 0.1)))
    assert panel.values == {"turn": 90, "rise": 0}
    assert "from 90 degrees and 0 degrees above" in panel.view.line


def test_the_scale_is_the_same_from_everywhere():
    panel = turntable(show_meshes(rod(0, 50), alt="A rod.", towards=(0, -1, 0)))
    seen = [panel.picture(turn=turn, rise=0).rgb for turn in (0, 90, -180)]
    assert len({rgb.shape for rgb in seen}) == 1
    # a square rod has the same outline from each of its sides
    outlines = [(rgb[80:420, 240:400] < 250).any(axis=-1) for rgb in seen]
    assert all(np.array_equal(outline, outlines[0]) for outline in outlines) and outlines[0].sum() > 5000


def test_what_lies_to_the_left_of_the_patient_is_seen_from_the_left():
    left, right = rod(0, 50), rod(0, 50)
    left = Mesh(left.vertices + np.array([20, 0, 0]), left.faces)
    right = Mesh(right.vertices - np.array([20, 0, 0]), right.faces)
    panel = turntable(show_meshes(left, right, colours=(BLUE, "#FFFFFF"), alt="Two rods.", towards=(0, -1, 0)))
    near, far = (is_blue(panel.picture(turn=turn, rise=0).rgb).sum() for turn in (90, -90))
    assert near > 500 and far == 0
    columns = np.flatnonzero(is_blue(panel.picture(turn=0, rise=0).rgb).any(axis=0))
    assert columns.min() > 320  # from the front the left side is at the right


def is_blue(rgb):
    """Pixels of a lit blue surface."""
    red, _, blue = np.moveaxis(rgb.astype(int), -1, 0)
    return blue - red > 40


def test_the_turn_has_no_end_and_the_rise_has():
    panel = turntable(show_meshes(rod(0, 50), alt="A rod."))
    turn, rise = all_round(panel)
    assert turn.cyclic and not rise.cyclic
    assert len(turn.stops) == 24 and np.ptp(turn.stops) == 360 - 15
    assert count(panel.view.rgb, "#FFFFFF") > 1000
