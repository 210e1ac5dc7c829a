"""Matrices in a band do what the same matrices do without."""

import numpy as np
import pytest
from scipy import sparse
from sheets import dense
from threadpoolctl import threadpool_info, threadpool_limits

from cranio_nb.geometry import band as module
from cranio_nb.geometry.band import band_of, band_solver, band_times

N, HEIGHT = 40, 7


@pytest.fixture
def rng():
    return np.random.default_rng(0)


@pytest.fixture
def matrix(rng):
    """Symmetric, of narrow band, and its diagonal outweighs the rest of each row: positive definite."""
    lower = np.tril(np.triu(rng.uniform(-1, 1, (N, N)), -HEIGHT), -1)
    return lower + lower.T + np.diag(np.full(N, 2 * HEIGHT + 1.0))


def test_a_band_holds_the_whole_of_a_symmetric_matrix(matrix):
    band = band_of(sparse.csr_array(matrix))
    assert band.shape == (HEIGHT + 1, N)
    assert (dense(band) == matrix).all()


@pytest.mark.parametrize("shape", [(N,), (N, 3)])
def test_a_band_multiplies_and_solves_as_its_matrix(matrix, rng, shape):
    band, x = band_of(sparse.csr_array(matrix)), rng.normal(size=shape)
    right = matrix @ x
    np.testing.assert_allclose(band_times(band, x), right, atol=1e-12)
    np.testing.assert_allclose(band_solver(band)(right), x, atol=1e-12)


def test_what_is_not_positive_definite_has_no_solution(matrix):
    matrix[20, 20] = -1.0
    assert np.isnan(band_solver(band_of(sparse.csr_array(matrix)))(np.ones((N, 3)))).all()


def threads():
    return [one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"]


def test_blas_has_one_thread_in_a_band_and_as_many_as_before_then(matrix, monkeypatch):
    seen = []
    for name in ("cholesky_banded", "cho_solve_banded"):
        own = getattr(module, name)
        monkeypatch.setattr(module, name, lambda *a, own=own, **k: seen.append(threads()) or own(*a, **k))
    with threadpool_limits(2, "blas"):
        before = threads()
        band_solver(band_of(sparse.csr_array(matrix)))(np.ones(N))
        assert threads() == before
    assert len(seen) == 2 and {n for counts in seen for n in counts} == {1}
