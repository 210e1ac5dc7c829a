"""The floor inside the skull: symmetry, thickness where it is known to be thin, agreement of slope and heights."""

import numpy as np
import pytest

from data_synth.face.base_map import CEILING, DEEP, base_map


@pytest.fixture(scope="module", params=range(4))
def floor(request):
    return base_map(np.random.default_rng(request.param))


def test_left_mirrors_right(floor):
    for field in (floor.top, floor.bottom, floor.slope):
        np.testing.assert_allclose(field, field[::-1], atol=1e-9)


def test_heights_keep_within_their_bounds(floor):
    assert floor.top.max() < CEILING
    assert floor.top.min() >= DEEP
    assert (floor.bottom < floor.top).all()


def test_roofs_of_the_orbits_are_thin_and_the_slope_below_the_brain_is_thick(floor):
    def thickness(x, y):
        top, bottom, slope = floor.at(np.array([x]), np.array([y]))
        return float(((top - bottom) / slope)[0])

    roofs = [thickness(x, y) for x in (20.0, 28.0, 34.0) for y in (-65.0, -55.0, -45.0)]
    assert 0.08 < min(roofs) and max(roofs) < 1.4
    assert thickness(0.0, 0.0) > 4.0


def test_heights_are_linear_between_points_of_the_grid(floor):
    x = np.array([10.0, 10.25, 10.5])
    top, bottom, _ = floor.at(x, np.full(3, -60.0))
    assert top[1] == pytest.approx((top[0] + top[2]) / 2)
    assert bottom[1] == pytest.approx((bottom[0] + bottom[2]) / 2)


def test_three_floors_lie_at_three_heights(floor):
    top, _, _ = floor.at(np.array([30.0, 30.0, 30.0]), np.array([-65.0, -15.0, 45.0]))
    assert -12 < top[0] < 8 and -34 < top[1] < -22 and top[2] == DEEP
