"""Balloons of many slices together: in the order they came, the same as alone."""

import numpy as np
import pytest

from cranio_nb.curves import GapEnds
from cranio_nb.methods.slicewise.inflate import carry, inflate
from cranio_nb.methods.slicewise.slices import Settings, SliceResult

INSIDE = np.array([100.0, 100.0])


def settings(pressure=None):
    return Settings(n_snaxels=41, pressure=pressure, tension=1.0, rigidity=1.0, dt=1.0, tol=1e-3, max_iter=2000)


def circle_slice(plane, radius, half_deg=20.0):
    """A gap in a circle of `radius` about `INSIDE`, its tangents those of the circle; the inner one 6 smaller."""
    angles = np.radians([-half_deg, half_deg])
    ends = []
    for r in (radius, radius - 6):
        points = INSIDE + r * np.column_stack([-np.cos(angles), np.sin(angles)])
        onward = np.column_stack([np.sin(angles), np.cos(angles)]) * np.array([[1.0], [-1.0]])
        ends.append(GapEnds(points, onward))
    return SliceResult(plane, "balloon", ends=tuple(ends))


def test_a_gap_in_a_circle_is_bridged_by_the_circle():
    (made,) = inflate([circle_slice(0, 80.0)], INSIDE, settings())
    for curve, radius in zip(made.curves, (80.0, 74.0), strict=True):
        np.testing.assert_allclose(np.linalg.norm(curve - INSIDE, axis=1), radius, atol=0.05)
    assert made.inflation.theta0_deg == pytest.approx((20.0, 20.0)) and all(made.inflation.converged)
    assert made.inflation.length == pytest.approx((2 * 80 * np.sin(np.radians(20)), 2 * 74 * np.sin(np.radians(20))))
    assert made.record()["theta0"] == pytest.approx([20.0, 20.0])


def test_slices_do_not_disturb_each_other():
    slices = [circle_slice(0, 80.0), SliceResult(1, "hull", "closed ring"), circle_slice(2, 60.0, 30.0)]
    together = inflate(slices, INSIDE, settings(pressure=0.062))
    for one, made in zip(slices, together, strict=True):
        (alone,) = inflate([one], INSIDE, settings(pressure=0.062))
        np.testing.assert_allclose(made.curves, alone.curves, atol=1e-9)
        assert (made.plane, made.status) == (one.plane, one.status)


def test_only_slices_between_bridged_ones_are_carried():
    slices = [SliceResult(i, "skipped", "no bone") for i in range(5)]
    slices[1], slices[3] = inflate([circle_slice(1, 80.0), circle_slice(3, 70.0)], INSIDE, settings())
    done = carry(slices)
    assert [s.status for s in done] == ["skipped", "balloon", "carried", "balloon", "skipped"]
    np.testing.assert_allclose(done[2].curves, (done[1].curves + done[3].curves) / 2)
