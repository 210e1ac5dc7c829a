"""Shares of variance where they are known in closed form."""

import json
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from studies import columns

pytest.importorskip("pyarrow", reason="the extra `study` is not installed")

from cranio_nb.study.sensitivity import effects, interactions, parameters, share, usual_options, within_cases

LEVELS = (0.0, 1.0, 2.0, 3.0)


def grid(function, n_cases=2):
    """Every pair of two options on some cases that differ by 10 each; `function` of both is the measure."""
    places = list(product(range(n_cases), LEVELS, LEVELS))
    return columns(
        len(places),
        case=[f"case{c}" for c, _, _ in places],
        options=[json.dumps({"skip_mm": a, "coupling_mm": b}) for _, a, b in places],
        dice=[10.0 * c + function(a, b) for c, a, b in places],
    )


def shares(rows):
    varied = parameters(rows, usual_options(rows))
    alone = {effect.parameter.name: effect for effect in effects(rows, varied, "dice")}
    (pair,) = interactions(rows, varied, "dice").values()
    return alone["skip_mm"], alone["coupling_mm"], pair


@given(a=st.floats(0.5, 5), b=st.floats(0.5, 5))
def test_of_a_sum_are_the_squares_of_its_slopes(a, b):
    first, second, pair = shares(grid(lambda x, y: a * x + b * y, n_cases=200))
    assert first.share == pytest.approx(a * a / (a * a + b * b), abs=2e-3)
    assert second.share == pytest.approx(b * b / (a * a + b * b), abs=2e-3)
    assert pair == pytest.approx(0.0, abs=2e-3)
    assert first.change == pytest.approx(3 * a) and second.change == pytest.approx(3 * b)


def test_of_a_centred_product_are_all_interaction():
    first, second, pair = shares(grid(lambda x, y: (x - 1.5) * (y - 1.5)))
    assert first.share == second.share == 0.0 and pair == pytest.approx(1.0)


def test_of_what_chance_makes_are_small():
    rng = np.random.default_rng(0)
    found = [share(rng.normal(size=200), rng.integers(0, 5, 200)) for _ in range(200)]
    assert np.mean(found) < 0.012  # 0.02 without the correction: 4 of 199 degrees of freedom


def test_do_not_see_how_cases_differ():
    first, _, _ = shares(grid(lambda x, y: x))
    assert first.share == pytest.approx(1.0)
    np.testing.assert_allclose(np.diff(first.means), 1.0)
    np.testing.assert_allclose(first.sds, 0.0, atol=1e-9)


def test_of_what_does_not_vary_are_unknown():
    assert np.isnan(share(np.ones(4), np.arange(4))) and np.isnan(share(np.full(2, np.nan), np.arange(2)))


def test_cases_are_levelled_by_what_is_known():
    found = within_cases(np.array([1.0, 3.0, np.nan, 5.0]), np.array(["a", "a", "b", "b"], object))
    np.testing.assert_array_equal(found, [-1.0, 1.0, np.nan, 0.0])


class TestParameters:
    def test_are_those_that_differ_with_their_defaults(self):
        rows = columns(3, options=["{}", '{"skip_mm": 3.0}', '{"skip_mm": 0.5}'], threshold_hu=[np.nan] * 3)
        (skip,) = parameters(rows, usual_options(rows))
        assert (
            skip.values == (1.5, 3.0, 0.5) and skip.labels == ("0.5", "1.5", "3") and skip.level.tolist() == [1, 2, 0]
        )

    def test_none_is_a_level_of_its_own(self):
        rows = columns(3, options=["{}", '{"pressure_mm": 0.1}', '{"pressure_mm": 0.0}'])
        (pressure,) = parameters(rows, usual_options(rows))
        assert pressure.labels == ("auto", "0", "0.1") and pressure.level.tolist() == [0, 2, 1]

    def test_many_values_are_put_into_classes_of_the_same_number(self):
        values = np.arange(100) / 10
        rows = columns(100, options=[json.dumps({"skip_mm": v}) for v in values])
        (skip,) = parameters(rows, usual_options(rows))
        assert np.bincount(skip.level).tolist() == [20] * 5

    def test_the_threshold_is_one(self):
        (height,) = parameters(columns(2, threshold_hu=[np.nan, 300.0]), {})
        assert (height.name, height.labels) == ("threshold_hu", ("300", "400"))

    def test_a_method_that_is_not_there_has_no_defaults(self):
        rows = columns(2, contender="gone", method="gone", options=["{}", '{"n": 1}'])
        assert parameters(rows, usual_options(rows))[0].labels == ("auto", "1")
