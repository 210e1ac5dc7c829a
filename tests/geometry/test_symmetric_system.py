"""Symmetric systems: the known solution comes back, by whichever way it is found."""

import numpy as np
import pytest
from scipy import sparse

from cranio_nb.geometry.symmetric_system import solve


def held_springs(n, apart):
    """Springs between places `apart`, each place held: eigenvalues from 1 to 5."""
    return sparse.diags_array(
        [np.full(n, 3.0), -np.ones(n - apart), -np.ones(n - apart)], offsets=[0, apart, -apart]
    ).tocsc()


@pytest.mark.parametrize("apart", [1, 40, 199, 200, 201, 260])  # narrow and wide bands
def test_the_known_solution_comes_back(apart):
    matrix, wanted = held_springs(300, apart), np.random.default_rng(apart).normal(size=300)
    np.testing.assert_allclose(solve(matrix, matrix @ wanted), wanted, atol=1e-13 * 300)


def test_what_is_symmetric_but_not_positive_is_solved_too():
    matrix, wanted = sparse.csc_array(np.array([[1.0, 2.0], [2.0, 1.0]])), np.array([3.0, -5.0])
    np.testing.assert_allclose(solve(matrix, matrix @ wanted), wanted, rtol=1e-14 * 9)
