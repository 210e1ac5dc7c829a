"""Crossings of polylines: known places, and what no choice of frame may change."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from cranio_nb.geometry.crossings import crossings


def test_a_wave_crosses_its_axis_at_its_zeros():
    x = np.linspace(0.5, 9.0, 400)
    found = crossings(np.column_stack([x, np.sin(x)]), np.array([[0.0, 0.0], [10.0, 0.0]]))
    # a chord of 0.02 leaves the sine by less than step^3
    np.testing.assert_allclose(found, [[np.pi, 0], [2 * np.pi, 0]], atol=(8.5 / 399) ** 3)


def test_curves_side_by_side_do_not_cross():
    x = np.linspace(0, 3, 40)
    curve = np.column_stack([x, np.sin(x)])
    assert crossings(curve, curve + np.array([0.0, 0.1])).shape == (0, 2)


def test_a_crossing_in_a_shared_point_counts_once():
    a, b = np.array([[0.0, -1], [0, 0], [0, 1]]), np.array([[-1.0, 0], [0, 0], [1, 0]])
    assert crossings(a, b).tolist() == [[0.0, 0.0]]


@pytest.mark.parametrize("n", [0, 1])
def test_less_than_a_line_crosses_nothing(n):
    assert crossings(np.zeros((n, 2)), np.array([[-1.0, 0], [1, 0]])).shape == (0, 2)


@given(st.integers(0, 10**6))
def test_neither_order_nor_frame_changes_the_places(seed):
    rng = np.random.default_rng(seed)
    a, b = rng.normal(size=(9, 2)), rng.normal(size=(7, 2))
    turn = np.linalg.qr(rng.normal(size=(2, 2)))[0]
    found, shift = crossings(a, b), np.array([5.0, -2.0])
    order = np.lexsort(found.T)
    for other in (crossings(b, a), (crossings(a @ turn + shift, b @ turn + shift) - shift) @ turn.T):
        np.testing.assert_allclose(other[np.lexsort(other.T.round(9))], found[order], atol=1e-9)
    # the places lie on both
    for line in (a, b):
        along = np.diff(line, axis=0)
        t = np.clip(((found[:, None] - line[:-1]) * along).sum(-1) / (along**2).sum(-1), 0, 1)
        away = np.linalg.norm(line[:-1] + t[..., None] * along - found[:, None], axis=-1)
        assert np.all(away.min(axis=1, initial=np.inf) < 1e-9)
