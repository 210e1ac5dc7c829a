"""Exercises of lesson 09: differences as a matrix, a smoothing spline across a gap, a rational curve."""

from __future__ import annotations

import numpy as np

from .task import Answer, Exercise, largest_difference


def _sizes():
    return [(6, 2), (9, 4), (5, 1)]


def _differences(n, order):
    return np.diff(np.eye(n), order, axis=0)


def _up_to_sign(answer, right):
    """Largest difference of two matrices; the energy is the same if all signs are turned."""
    return min(largest_difference(answer, right), largest_difference(-np.asarray(answer, float), right))


def _gaps():
    x = np.linspace(-1, 1, 41)
    known = np.abs(x) > 0.35
    bumpy = 70 - 9 * x**2 + 0.4 * np.sin(25 * x)
    shifted = (np.abs(x - 0.2) > 0.5) & (np.abs(x + 0.6) > 0.08)  # two gaps, with bone between them
    return [
        (np.where(known, 70 - 9 * x**2, 0.0), known, 3, 0.1),
        (np.where(known, bumpy, 0.0), known, 2, 50.0),
        (np.where(shifted, bumpy, -1000.0), shifted, 3, 2000.0),
    ]


def _bridge(f, known, order, strength, *, held=True, pulled=True):
    d = np.diff(np.eye(len(f)), order, axis=0)
    left = np.diag(known.astype(float)) if held else np.eye(len(f))
    return np.linalg.solve(left + strength * d.T @ d, np.where(known, f, 0.0) if pulled else f)


def _weighted(f, known, order, strength):
    d = np.diff(np.eye(len(f)), order, axis=0)
    return np.linalg.solve(strength * np.diag(known.astype(float)) + d.T @ d, np.where(known, f, 0.0))


def _with_d_alone(f, known, order, strength):
    d = np.zeros((len(f), len(f)))
    d[: len(f) - order] = _differences(len(f), order)
    return np.linalg.solve(np.diag(known.astype(float)) + strength * d, np.where(known, f, 0.0))


def _polynomial(f, known, order, strength):
    at = np.arange(len(f))
    return np.polyval(np.polyfit(at[known], f[known], order), at)


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


def _linear_ends(points, weights, t):
    shares = np.column_stack([1 - t, 2 * t * (1 - t), t]) * weights
    return shares @ points / shares.sum(axis=1, keepdims=True)


def _on_circle(points, weights, t):
    curve = _rational(points, weights, t)
    return curve / np.linalg.norm(curve, axis=1, keepdims=True)


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
            *(
                (mistake, "Powers of the entries: a difference of order 2 is the difference of differences, 1, -2, 1.")
                for mistake in (
                    lambda n, order: np.diff(np.eye(n), axis=0) ** order,
                    lambda n, order: np.diff(np.eye(n), axis=0)[: n - order] ** order,
                )
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
            (
                lambda n, order: np.diff(np.eye(n), order + 1, axis=0),
                "One order too high: of order 1 are the differences of neighbours themselves.",
            ),
            (lambda n, order: np.diff(np.eye(order), n, axis=0), "n and order are exchanged."),
            (
                lambda n, order: _differences(n, order)[:, ::-1],
                "The columns are in turned order: D @ g would read g backwards.",
            ),
            (
                lambda n, order: _differences(n, order) / order,
                "Divided by the order: each difference is one of neighbours, and nothing is divided.",
            ),
            (
                lambda n, order: np.abs(_differences(n, order)),
                "The signs are lost: neighbours are taken away from each other, 1, -2, 1.",
            ),
            (
                lambda n, order: np.eye(n)[order:] - np.eye(n)[:-order],
                "This is the difference of values `order` apart, not the difference of differences.",
            ),
            (
                lambda n, order: np.diff(np.eye(n), axis=0)[: n - order],
                "These are first differences in the right number of rows: take differences of differences.",
            ),
            (
                lambda n, order: np.diff(np.arange(n), order),
                "These are differences of 0, 1, 2, ...; those of the identity matrix make the matrix.",
            ),
            (
                lambda n, order: _differences(n, order).T @ _differences(n, order),
                "This is D^T D, the energy's matrix; D itself is wanted.",
            ),
            (
                lambda n, order: np.gradient(np.eye(n), axis=0),
                "np.gradient takes neighbours on both sides, and keeps n rows; np.diff takes the next one.",
            ),
            (
                lambda n, order: np.eye(n) - np.eye(n, k=1),
                "This has n rows, the last without a neighbour, and is the first difference whatever the order.",
            ),
            (
                lambda n, order: np.linalg.matrix_power(np.diff(np.eye(n), axis=0)[:, :-1], order),
                "A power of a square piece of D: the matrices of the differences get shorter at each order.",
            ),
        ),
        hints=(
            "Row i of the matrix says which values the i-th difference is made of.",
            "What does np.diff make of the identity matrix?",
            "np.diff takes the order as its second argument, and works along the last axis unless told axis=0.",
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
            (
                lambda f, known, order, strength: _bridge(f, known, order, -strength),
                "The sign of the smoothing is turned: both terms of the energy are added, so strength D^T D is too.",
            ),
            (
                lambda f, known, order, strength: -_bridge(f, known, order, -strength),
                "The sign of W is turned: both terms of the energy are added, W + strength D^T D.",
            ),
            (_straight, "A straight bridge: it leaves the rim with a kink and smooths nothing."),
            (
                lambda f, known, order, strength: np.where(known, f, _bridge(f, known, order, strength)),
                "The data are put back unsmoothed: g is near them, not through them.",
            ),
            (
                lambda f, known, order, strength: _weighted(f, known, order, strength),
                "The strength stands at W, and then W f lacks it: it belongs to D^T D.",
            ),
            (
                lambda f, known, order, strength: _bridge(np.where(known, 0.0, f), ~known, order, strength),
                "W has its ones in the gap: it is 1 where values are known.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, 3, strength),
                "Always the third order: D has the order that is asked for.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, order - 1, strength),
                "One order too low: D is the difference of just the order that is asked for.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, order + 1, strength),
                "One order too high: D is the difference of just the order that is asked for.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, order, strength ** (1 / (2 * order))),
                "The strength is already the whole factor of the energy: no root of it.",
            ),
            (
                _with_d_alone,
                "D^T D is wanted, not D: the energy is |D g|^2, and its derivative has D twice.",
            ),
            (
                lambda f, known, order, strength: _bridge(f - f[known].mean(), known, order, strength),
                "The mean was taken off and not put back.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, 1, strength),
                "Always the first order: D has the order that is asked for.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, order, np.sqrt(strength)),
                "The strength is already the whole factor of the energy: no root of it.",
            ),
            (
                lambda f, known, order, strength: _bridge(f, known, order, order * strength),
                "The strength is already the whole factor of the energy: do not multiply it by the order.",
            ),
            (
                lambda f, known, order, strength: np.where(known, f, 0.0),
                "These are the data alone, with 0 in the gap: solve for g.",
            ),
            (
                lambda f, known, order, strength: np.where(known, f, f[known].mean()),
                "A step to the mean: the gap is to be bridged by a smooth curve.",
            ),
            (_polynomial, "One polynomial through everything: a spline bends where the data ask for it."),
            (
                lambda f, known, order, strength: _bridge(f, known, order, strength)[~known],
                "This is the gap alone: return g for all values.",
            ),
        ),
        hints=(
            "Set the derivative of sum w (g - f)^2 + strength |D g|^2 to zero: a linear system for g.",
            "W = np.diag(known.astype(float)); the system is (W + strength * D.T @ D) g = W f.",
            "np.linalg.solve(A, b) gives the g of A g = b; D is that of exercise 9.1.",
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
            (_linear_ends, "The outer functions are squares: (1 - t)^2 and t^2."),
            (
                lambda points, weights, t: _rational(points[::-1], weights[::-1], t),
                "The curve runs backwards: at t = 0 it is at the first point, so (1 - t)^2 belongs to it.",
            ),
            *(
                (lambda points, weights, t, way=way: _rational(points, way(weights), t), sentence)
                for way, sentence in (
                    (np.sqrt, "The weights come in as they are: no root of them."),
                    (lambda w: np.array([1.0, w[1], 1.0]), "The outer weights count too: they need not be 1."),
                    (
                        lambda w: np.array([w[0], np.sqrt(0.5), w[2]]),
                        "1 / sqrt 2 is the middle weight of a quarter of a circle only: take weights[1].",
                    ),
                )
            ),
            (
                lambda points, weights, t: _rational(points, weights, t)[:, ::-1],
                "x and y are exchanged: the columns stand as those of `points`.",
            ),
            (
                lambda points, weights, t: _rational(points, weights, t / 100),
                "t runs from 0 to 1 already: it is no percentage.",
            ),
            (
                lambda points, weights, t: np.column_stack([np.interp(2 * t, range(3), points[:, i]) for i in (0, 1)]),
                "These lie on the straight lines between the points: the curve is their weighted mean.",
            ),
            (lambda points, weights, t: _rational(points, weights**2, t), "The weights come in once, not squared."),
            (
                lambda points, weights, t: _rational(points, 1 / weights, t),
                "Multiply by the weights: a large one pulls the curve to its point.",
            ),
            (
                lambda points, weights, t: points[0] + t[:, None] * (points[2] - points[0]),
                "A straight line from end to end: the middle point is left out.",
            ),
            (
                lambda points, weights, t: (_bernstein(t) * weights) @ points / (_bernstein(t) * weights).sum(),
                "This divides by the sum over all t: each t has its own, sum(axis=1).",
            ),
            (
                lambda points, weights, t: (
                    (_bernstein(t) * weights) @ points / (_bernstein(t) * weights).sum(axis=0)[:2]
                ),
                "Summed the wrong way: each t has its own divisor, sum(axis=1).",
            ),
            (
                _on_circle,
                "Every point is put on a circle of radius 1 by force: leave that to the weighted mean.",
            ),
            (
                lambda points, weights, t: _rational(points, weights, t).T,
                "Rows and columns are exchanged: a row for every t.",
            ),
            (
                lambda points, weights, t: _bernstein(t, 1) @ points,
                "The weights are not used, and the middle function is 2 t (1 - t).",
            ),
        ),
        hints=(
            "A rational point is a weighted mean of the control points.",
            "B = (1 - t)^2, 2 t (1 - t), t^2; numerator sum w_i B_i p_i, denominator sum w_i B_i.",
            "B * weights are shares, a row for each t; divide each row by its sum, which keepdims=True keeps a column.",
        ),
        praise="with 1, 1 / sqrt 2, 1 every point lies on the circle, which no polynomial can do.",
    ),
}
"""The exercises of lesson 09, by number."""
