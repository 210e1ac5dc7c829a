"""The drawn forces are those that move the balloon, and each arrow is as long as its force."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cranio_nb.curves import cubic, normals
from cranio_nb.stages.deformable_model import inflate
from cranio_nb.teaching.diagrams import marks, snaxel_forces
from cranio_nb.teaching.diagrams.forces import draw_forces, forces, stacked

LENGTH, THETA, K = 90.0, 0.24, 0.062
SLOPES = LENGTH / 20 * np.array([[1.0, np.tan(THETA)], [1.0, -np.tan(THETA)]])
START = cubic(LENGTH, THETA, np.pi - THETA, 21)
REST = inflate(START, SLOPES, pressure=K, tol=1e-9).curve


@given(st.integers(0, 10**6), st.floats(-0.2, 0.4))
def test_their_sum_is_the_velocity_of_eq_1(seed, k):
    rough = START + np.random.default_rng(seed).normal(0, 0.3, START.shape) * (np.arange(21) % 20 > 0)[:, None]
    dt = 1e-7
    moved = inflate(rough, SLOPES, pressure=k, dt=dt, max_iter=1).curve
    assert forces(rough, SLOPES, k).sum(axis=0) == pytest.approx((moved - rough)[1:-1] / dt, abs=1e-4)


def test_they_cancel_at_rest():
    assert np.abs(forces(REST, SLOPES, K).sum(axis=0)).max() < 1e-6


def test_a_cubic_has_no_rigidity_away_from_its_ends():
    assert np.abs(forces(START, SLOPES, K)[1, 1:-1]).max() < 1e-9


def test_arrows_are_as_long_as_their_forces():
    acting = forces(REST, SLOPES, K)
    ax = marks.plane(marks.sheet(2.5), (0, 0, 1, 1), (-5.0, -15.0), 100.0)
    draw_forces(ax, REST, acting, unit=60.0)
    drawn = np.array([np.subtract(t.xy, t.xyann) for t in ax.texts if t.arrow_patch])
    seen = acting.reshape(-1, 2)[60 * np.hypot(*acting.reshape(-1, 2).T) > 0.1]
    long = drawn[np.hypot(*drawn.T) > 0.1]
    assert long == pytest.approx(60.0 * seen)


def test_at_rest_the_arrows_reach_equally_far_to_both_sides():
    acting = forces(REST, SLOPES, K)
    tips = stacked(REST, acting, 60.0) + 60.0 * acting
    reach = ((tips - REST[1:-1]) * normals(REST)[1:-1]).sum(axis=-1)
    assert reach.max(axis=0) == pytest.approx(-reach.min(axis=0), rel=0.02)


@pytest.mark.parametrize(("k", "longer"), [(0.02, "tension"), (0.3, "pressure")])
def test_line_and_description_tell_what_is_seen(k, longer):
    drawn = snaxel_forces(LENGTH, THETA, np.pi - THETA, pressure=k)
    begin = np.linalg.norm(forces(START, SLOPES, k).sum(axis=0), axis=1).max()
    assert f"{begin:.3f} px at the start" in drawn.line and f"At the start {longer}" in drawn.alt
