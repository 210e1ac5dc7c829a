"""Weights by their formulas, and fits that outliers cannot bend."""

import numpy as np
import pytest

from cranio_nb.geometry.robust import (
    cauchy_weights,
    geman_mcclure_weights,
    huber_weights,
    reweighted_fit,
    spread,
    tukey_weights,
    weighted_fit,
)

LINE = np.stack([np.ones(40), np.linspace(-1, 1, 40)], axis=1)


def test_spread_is_the_standard_deviation_of_normal_residuals():
    residuals = 3 * np.random.default_rng(0).standard_normal(200_000)
    assert spread(residuals) == pytest.approx(3, rel=0.01)


def test_weights_at_known_residuals():
    r = np.array([0.0, 2.0, -2.0, 1e9])
    np.testing.assert_allclose(cauchy_weights(r, 2.0), [1, 0.5, 0.5, 0], atol=1e-12)
    np.testing.assert_allclose(geman_mcclure_weights(r, 2.0), [1, 0.25, 0.25, 0], atol=1e-12)
    np.testing.assert_allclose(huber_weights(r, 1.0), [1, 0.5, 0.5, 0], atol=1e-8)
    np.testing.assert_allclose(tukey_weights(r, 4.0), [1, 0.5625, 0.5625, 0])
    np.testing.assert_allclose(cauchy_weights(r[:2], 2.0, times=np.array([3.0, 4.0])), [3, 2])


def test_a_weighted_fit_is_that_of_repeated_equations():
    rng = np.random.default_rng(1)
    values, counts = rng.normal(size=40), rng.integers(1, 4, 40)
    repeated = np.linalg.lstsq(np.repeat(LINE, counts, axis=0), np.repeat(values, counts), rcond=None)[0]
    np.testing.assert_allclose(weighted_fit(LINE, values, np.sqrt(counts)), repeated)


def test_a_ridge_draws_coefficients_to_zero():
    values = LINE @ [2.0, 5.0]
    wanted = np.linalg.solve(LINE.T @ LINE + 9 * np.eye(2), LINE.T @ values)
    np.testing.assert_allclose(weighted_fit(LINE, values, np.ones(40), ridge=3.0), wanted)


@pytest.mark.parametrize("weigh", [cauchy_weights, geman_mcclure_weights, tukey_weights])
def test_a_quarter_of_outliers_does_not_bend_a_line(weigh):
    values = LINE @ [2.0, 5.0]
    values[::4] += 100.0
    found = reweighted_fit(LINE, values, lambda r: weigh(r, 2 * spread(r) + 1e-9), start=np.ones(40), n_iter=40)
    np.testing.assert_allclose(found, [2, 5], atol=1e-3)


@pytest.mark.parametrize("ridge", [0.0, 1e-3])
@pytest.mark.parametrize("alike", [1.0, 1e-3, 1e-6, 0.0])
def test_a_fit_is_that_by_singular_values_however_alike_the_columns_are(alike, ridge):
    rng = np.random.default_rng(2)
    line = np.linspace(-1, 1, 60)
    basis = np.stack([np.ones(60), line, line + alike * line**2], axis=1)
    values, factors = rng.normal(size=60), rng.uniform(0.1, 1, 60)
    system = np.concatenate([basis * factors[:, None], ridge * np.eye(3)])
    wanted = np.linalg.lstsq(system, np.append(values * factors, np.zeros(3)), rcond=None)[0]
    # columns that differ by 1e-6 leave ten digits of sixteen, whatever the way of solving
    np.testing.assert_allclose(weighted_fit(basis, values, factors, ridge=ridge), wanted, rtol=1e-8)
