"""The drawn fans: their curves lie on the sphere that was cut, and their planes meet in the head's centre."""

import numpy as np
import pytest
from hollow_ball import CENTRE, HALF_DEG, OUTER, ball

from cranio_nb.curves import Points
from cranio_nb.methods.slicewise.slices import SlicedDesign, SliceResult
from cranio_nb.prosthesis import Prosthesis
from cranio_nb.teaching.diagrams import slice_fans
from cranio_nb.teaching.diagrams.fans import axes_across, in_world

TILTS = np.radians(np.linspace(-20.0, 20.0, 9))


def arc(radius) -> Points:
    """Across the hole in a slice of a fan: rows run towards the head's centre."""
    turn = np.radians(np.linspace(-HALF_DEG, HALF_DEG, 11))
    return radius * np.column_stack([-np.cos(turn), np.sin(turn)])


@pytest.fixture(scope="module")
def made():
    bone, opening = ball(np.array([1.0, 0.0, 0.0]))
    curves = np.stack([arc(OUTER), arc(OUTER - 8)])
    fans = []
    for hinge in (np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])):
        turn = np.cross([1.0, 0.0, 0.0], hinge)
        ups = np.cos(TILTS)[:, None] * [1.0, 0.0, 0.0] + np.sin(TILTS)[:, None] * turn
        frames = np.stack([np.broadcast_to(CENTRE, ups.shape), -ups, np.broadcast_to(hinge, ups.shape)], axis=1)
        slices = tuple(SliceResult(plane, "balloon", curves=curves) for plane in range(len(TILTS)))
        fans.append(SlicedDesign(opening, frames, 1.0, slices))
    return bone, fans


def test_curves_lie_on_the_sphere_and_in_planes_through_its_centre(made):
    for fan in made[1]:
        for one in fan.slices:
            away = in_world(fan, one) - CENTRE
            assert np.linalg.norm(away, axis=1) == pytest.approx(OUTER)
            assert np.linalg.matrix_rank(away, tol=1e-6) == 2


@pytest.mark.parametrize("hinge", np.eye(3))
def test_the_cut_is_at_right_angles_to_the_line(hinge):
    right_up = axes_across(hinge)
    assert right_up @ hinge == pytest.approx([0.0, 0.0]) and right_up @ right_up.T == pytest.approx(np.eye(2))
    assert right_up[0, 0] + right_up[0, 1] > 0.5


def test_the_line_counts_directions_and_slices(made):
    bone, fans = made
    drawn = slice_fans(bone, Prosthesis(None, np.zeros(0, np.uint8), None, "slicewise", working=tuple(fans)))
    assert drawn.line == "2 directions; the first fan has 9 slices, 2 of them drawn"
