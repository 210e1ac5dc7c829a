"""The drawn rays: those through a conical hole leave, the others end where the ball begins and ends."""

import numpy as np
import pytest
from hollow_ball import CENTRE, HALF_DEG, INNER, OUTER, STEP, ball

from cranio_nb.teaching.diagrams import ray_fan
from cranio_nb.teaching.diagrams.rays import cut_axes, ray_radii

TOWARDS = np.array([0.9, 0.2, 0.3])


@pytest.fixture(scope="module")
def holed():
    return ball(TOWARDS)


def test_the_cut_runs_through_the_eye_and_the_hole(holed):
    right_up = cut_axes(holed[1])
    assert right_up @ right_up.T == pytest.approx(np.eye(2))
    assert np.linalg.norm(right_up @ holed[1].direction) == pytest.approx(1.0)
    assert right_up[0, 0] > 0.5 and right_up[1, 1] < -0.5  # the patient's left to the right, the face up


def test_rays_leave_through_the_hole_and_only_there(holed):
    turns = np.radians(np.arange(0.0, 360.0, 2.0))
    directions = np.column_stack([np.cos(turns), np.sin(turns)]) @ cut_axes(holed[1])
    outer, inner = ray_radii(*holed, directions)
    off = np.degrees(np.arccos(directions @ TOWARDS / np.linalg.norm(TOWARDS)))
    assert np.isnan(outer[off < HALF_DEG - 2]).all() and np.isfinite(outer[off > HALF_DEG + 2]).all()
    whole = off > HALF_DEG + 2
    assert np.abs(outer[whole] - OUTER).max() < STEP and np.abs(inner[whole] - INNER).max() < STEP
    assert np.linalg.norm(holed[1].head_centre - CENTRE) == 0


def test_the_line_counts_the_rays(holed):
    leave = int(ray_fan(*holed).line.split(": ")[1].split()[0])
    assert leave == pytest.approx(2 * HALF_DEG / 4.0, abs=1)
