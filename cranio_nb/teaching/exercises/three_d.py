"""Exercises of lesson 09: differences as a matrix, a smoothing spline across a gap, a rational curve."""

from __future__ import annotations

import numpy as np

from .task import Answer, Exercise, largest_difference


def _sizes():
    return [(6, 2), (9, 3), (5, 1)]


def _differences(n, order):
    return np.diff(np.eye(n), order, axis=0)


def _up_to_sign(answer, right):
    """Largest difference of two matrices; the energy is the same if all signs are turned."""
    return min(largest_difference(answer, right), largest_difference(-np.asarray(answer, float), right))


def _gaps():
    x = np.linspace(-1, 1, 41)
    known = np.abs(x) > 0.35
    bumpy = 70 - 9 * x**2 + 0.4 * np.sin(25 * x)
    shifted = np.abs(x - 0.2) > 0.5
    return [
        (np.where(known, 70 - 9 * x**2, 0.0), known, 3, 0.1),
        (np.where(known, bumpy, 0.0), known, 2, 50.0),
        (np.where(shifted, bumpy, -1000.0), shifted, 3, 2000.0),
    ]


def _bridge(f, known, order, strength, *, held=True, pulled=True):
    d = np.diff(np.eye(len(f)), order, axis=0)
    left = np.diag(known.astype(float)) if held else np.eye(len(f))
    return np.linalg.solve(left + strength * d.T @ d, np.where(known, f, 0.0) if pulled else f)


def _straight(f, known, order, strength):
    at = np.arange(len(f))
    return np.where(known, f, np.interp(at, at[known], f[known]))


def _arcs():
    corner = np.array([[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    t = np.linspace(0, 1, 11)
    return [
        (corner, np.array([1.0, np.sqrt(0.5), 1.0]), t),
        (75 * corner, np.array([1.0, 2.0, 1.0]), t),
        (np.array([[0.0, 0.0], [30.0, 50.0], [80.0, 10.0]]), np.array([1.0, 0.3, 2.0]), t[1:-1]),
    ]


def _bernstein(t, middle=2):
    return np.column_stack([(1 - t) ** 2, middle * t * (1 - t), t**2])


def _rational(points, weights, t, *, middle=2):
    shares = _bernstein(t, middle) * weights
    return shares @ points / shares.sum(axis=1, keepdims=True)


EXERCISES: dict[str, Exercise] = {
    "9.1": Exercise(
        cases=_sizes,
        right=_differences,
        answer=Answer("a matrix of n - order rows and n columns", unit="", tolerance=1e-9, error=_up_to_sign),
        mistakes=(
            (
                lambda n, order: np.diff(np.eye(n), order),
                "Rows and columns are exchanged: np.diff works along the last axis unless told axis=0.",
            ),
            (
                lambda n, order: np.diff(np.eye(n), axis=0) ** order,
                "Powers of the entries: a difference of order 2 is the difference of differences, 1, -2, 1.",
            ),
            (lambda n, order: np.diff(np.eye(n), axis=0), "This is the first difference, whatever the order."),
            (
                lambda n, order: np.diff(np.eye(n), order - 1, axis=0),
                "One order too low: of order 1 are the differences of neighbours themselves.",
            ),
            (
                lambda n, order: np.diff(np.eye(n), 2, axis=0),
                "This is the second difference, whatever the order.",
            ),
        ),
        hints=(
            "Row i of the matrix says which values the i-th difference is made of.",
            "What does np.diff make of the identity matrix?",
            "np.diff(np.eye(n), order, axis=0)",
        ),
        praise="constants vanish under order 1, straight lines under 2, parabolas under 3.",
    ),
    "9.2": Exercise(
        cases=_gaps,
        right=_bridge,
        answer=Answer("one value for every value of f", unit="mm", tolerance=1e-4),
        mistakes=(
            (
                lambda f, known, order, strength: _bridge(f, known, order, strength, held=False, pulled=False),
                "What stands in the gap is held to as if it were bone: W is 0 there.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, order, strength, pulled=False),
                "What stands in the gap still pulls: the right-hand side is W f, not f.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, order, strength, held=False),
                "The gap is held to 0: W has no ones there, on the left-hand side neither.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, order, 1.0),
                "The strength is not used: the energy is strength * |D g|^2.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, 2, strength),
                "Always the second order: D has the order that is asked for.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, order, strength**2),
                "The strength is already a factor of the energy: do not square it.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, order, strength ** (2 * order)),
                "The strength is already the whole factor of the energy: do not raise it to 2 order.",
            ),
            (_straight, "A straight bridge: it leaves the rim with a kink and smooths nothing."),
        ),
        hints=(
            "Set the derivative of sum w (g - f)^2 + strength |D g|^2 to zero: a linear system for g.",
            "W = np.diag(known.astype(float)); the system is (W + strength * D.T @ D) g = W f.",
            "np.linalg.solve(W + strength * D.T @ D, W @ f)",
        ),
        praise="bone is smoothed and continued by one and the same solve.",
    ),
    "9.3": Exercise(
        cases=_arcs,
        right=_rational,
        answer=Answer("a point (x, y) for every t", unit="mm", tolerance=1e-6),
        mistakes=(
            (
                lambda points, weights, t: _bernstein(t) @ points,
                "The weights are not used: this is a parabola, not a circle.",
            ),
            (
                lambda points, weights, t: (_bernstein(t) * weights) @ points,
                "Divide by the sum of w_i B_i(t), or the curve is pulled towards 0, 0.",
            ),
            (
                lambda points, weights, t: (_bernstein(t) * weights) @ points / weights.sum(),
                "The divisor changes along the curve: it is the sum of w_i B_i(t), not of the weights alone.",
            ),
            (
                lambda points, weights, t: _bernstein(t) @ points / (_bernstein(t) @ weights)[:, None],
                "The weights belong above the line too: sum w_i B_i p_i over sum w_i B_i.",
            ),
            (
                lambda points, weights, t: _rational(points, weights, t, middle=1),
                "The middle function is 2 t (1 - t): the three add up to 1.",
            ),
        ),
        hints=(
            "A rational point is a weighted mean of the control points.",
            "B = (1 - t)^2, 2 t (1 - t), t^2; numerator sum w_i B_i p_i, denominator sum w_i B_i.",
            "share = B * weights; share @ points / share.sum(axis=1, keepdims=True)",
        ),
        praise="with 1, 1 / sqrt 2, 1 every point lies on the circle, which no polynomial can do.",
    ),
}
"""The exercises of lesson 09, by number."""
