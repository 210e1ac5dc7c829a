"""Exercises of lesson 04: the balloon's height, its pressure, its curve."""

from __future__ import annotations

from functools import cache

import numpy as np

from ...curves import cubic, spiral
from ...stages.deformable_model import inflate
from .task import Answer, Exercise, small_head

_PX = 0.45  # mm: 512 pixels over a head
_ROUNDED = "The number was rounded, or cut by `//`: return it whole."


def _pressures():
    return [(0.062, 21), (0.062, 40), (0.0213, 31)]


@cache
def _gaps():
    """Closed-form gaps of the phantom: (length in px of 0.45 mm, theta0, theta1)."""
    found = []
    for plane in (12, 16, 20):
        gap = max((t.outer for t in small_head().slice_truth(plane) if t.outer), key=lambda g: g.chord)
        found.append((gap.chord * small_head().affine[1, 1] / _PX, *np.radians(gap.angles)))
    return tuple(found)


def _tangents():
    """Each gap with both tangents turned one way, as noise does: the start curve is poor, k is right all the same.

    The last has few snaxels, where an end slope per n instead of per n - 1 can be seen.
    """
    turned = zip(_gaps(), np.radians([4.0, 8.0, -8.0]), (21, 21, 9), strict=True)
    return [(length, theta0 + turn, theta1 + turn, n) for (length, theta0, theta1), turn, n in turned]


def _px_off(curve, wanted):
    """Largest distance in px between two curves of n snaxels each, snaxel by snaxel."""
    nodes = np.asarray(curve, float)
    if nodes.shape != wanted.shape:
        return float("inf")
    return float(np.linalg.norm(nodes - wanted, axis=1).max())


def _tangent_pressure(length, theta0, theta1, n):
    return length * (np.tan(theta0) - np.tan(theta1)) / (n - 1) ** 2


def _relaxed(length, theta0, theta1, n, k, steps=None):
    """The balloon at rest under k; its end slopes are per one of `steps`, N if not given."""
    slopes = np.array([[length, length * np.tan(t)] for t in (theta0, theta1)]) / (steps or n - 1)
    return _inflated(length, theta0, theta1, n, k, *slopes.ravel())


@cache
def _inflated(length, theta0, theta1, n, k, *slopes):
    """The balloon at rest; known mistakes ask for the same ones again and again."""
    return inflate(cubic(length, theta0, theta1, n), np.reshape(slopes, (2, 2)), pressure=k).curve


def _at_rest(length, theta0, theta1, n, steps=None):
    return _relaxed(length, theta0, theta1, n, _tangent_pressure(length, theta0, theta1, n), steps)


def _with_slopes(length, theta0, theta1, n, slopes):
    """The balloon at rest under the right k with other end slopes."""
    k = _tangent_pressure(length, theta0, theta1, n)
    return _inflated(length, theta0, theta1, n, k, *np.ravel(slopes))


def _mirrored(length, theta0, theta1, n):
    return _relaxed(length, -theta0, -theta1, n, -_tangent_pressure(length, theta0, theta1, n))


EXERCISES: dict[str, Exercise] = {
    "4.1": Exercise(
        cases=_pressures,
        right=lambda k, n: k * (n - 1) ** 2 / 8,
        answer=Answer("one number", unit="px", tolerance=1e-6),
        mistakes=(
            (lambda k, n: k * n**2 / 8, "N counts the steps between snaxels: N = n - 1."),
            (lambda k, n: k * (n - 1) ** 2 / 2, "Four times too high: where along the curve does the apex lie?"),
            (lambda k, n: k * (n - 1) ** 2, "Too high: the parabola has a factor of its own, and its apex a place."),
            (lambda k, n: -k * (n - 1) ** 2 / 8, "With k > 0 outward the apex lies outside: it is positive."),
            (lambda k, n: k * (n + 1) ** 2 / 8, "N counts the steps between snaxels: N = n - 1."),
            (lambda k, n: k * (n - 1) / 8, "N is squared: twice as many steps, four times the height."),
            (lambda k, n: k * n / 8, "N is squared, and counts the steps: N = n - 1."),
            (lambda k, n: k * n * (n - 1) / 8, "N counts the steps between snaxels: N = n - 1, both times."),
            (lambda k, n: k * (n - 1) * (n - 2) / 8, "The parabola is i (N - i): at its middle both are N / 2."),
            (lambda k, n: (n - 1) ** 2 / 8, "The pressure is missing: twice the wind, twice the height."),
            (lambda k, n: k * (n - 1) ** 2 / 8 * _PX, "This is in mm of the paper's pixel: px are wanted."),
            (lambda k, n: k * (n - 2) ** 2 / 8, "N counts the steps between snaxels: N = n - 1."),
            (lambda k, n: k * (n / 2) * (n / 2 - 1) / 2, "N counts the steps between snaxels: N = n - 1."),
            (lambda k, n: k * (n - 1) // 2 * (n - (n - 1) // 2) / 2, "The parabola is i (N - i), with N = n - 1."),
            (lambda k, n: k * ((n - 1) // 2) * (n - (n - 1) // 2) / 2, "The parabola is i (N - i), with N = n - 1."),
            *((lambda k, n, d=d: round(k * (n - 1) ** 2 / 8, d), _ROUNDED) for d in range(4)),
            (
                lambda k, n: k * (n - 1) ** 2 / 8 - k * (n - 1) / np.sqrt(5),
                "Here the clamps are in it: the apex away from the ends is asked for, that of the parabola.",
            ),
        ),
        hints=("At rest c'' = -k, with the end heights 0.", "c(i) = k i (N - i) / 2.", "Put i = N / 2, and N = n - 1."),
        praise="the apex does not know the width of the gap.",
    ),
    "4.2": Exercise(
        cases=_tangents,
        right=_tangent_pressure,
        answer=Answer("one number", unit="px per index squared", tolerance=1e-6),
        mistakes=(
            (
                lambda L, a, b, n: L * (np.tan(a) + np.tan(b)) / (n - 1) ** 2,
                "tan theta1 is negative: adding it takes away what it should give.",
            ),
            *(
                (
                    lambda L, a, b, n, turn=turn: L * (np.tan(turn(a)) - np.tan(turn(b))) / (n - 1) ** 2,
                    "The angles are in radians already, and np.tan takes them so.",
                )
                for turn in (np.radians, np.degrees)
            ),
            (
                lambda L, a, b, n: (np.tan(a) - np.tan(b)) / (n - 1) ** 2,
                "The length is missing: a wide gap needs a larger k.",
            ),
            (
                lambda L, a, b, n: -_tangent_pressure(L, a, b, n),
                "The sign is turned: from one end to the other the slope falls, and k is positive.",
            ),
            (lambda L, a, b, n: L * (a - b) / (n - 1) ** 2, "These are angles; the slope is the tangent of an angle."),
            (
                lambda L, a, b, n: L * (a + np.pi - b) / (n - 1) ** 2,
                "These are angles above the chord; the slope is the tangent of an angle, and not quite the same.",
            ),
            (
                lambda L, a, b, n: L * (np.tan(a) - np.tan(b)) / (n - 1),
                "N is squared: once for the steps that share the change, once for the length of a step.",
            ),
            (lambda L, a, b, n: (np.tan(a) - np.tan(b)) / (n - 1), "The length of a step is missing: L / N px."),
            (
                lambda L, a, b, n: L * np.tan(a) / (n - 1) ** 2,
                "Only the first end is used: the slope falls from tan theta0 to tan theta1.",
            ),
            (
                lambda L, a, b, n: 2 * L * np.tan(a) / (n - 1) ** 2,
                "The first end is taken for both: the gap need not be symmetric.",
            ),
            (lambda L, a, b, n: L * (np.sin(a) - np.sin(b)) / (n - 1) ** 2, "A slope is a tangent, not a sine."),
            (
                lambda L, a, b, n: L**2 * (np.tan(a) - np.tan(b)) / (n - 1) ** 2,
                "The length comes in once: a slope has no unit, a step has L / N px.",
            ),
            (
                lambda L, a, b, n: L * np.tan(a - b) / (n - 1) ** 2,
                "The difference of the two slopes is wanted, not the slope of the difference.",
            ),
            (lambda L, a, b, n: L * (np.tan(a) - np.tan(b)) / n, "N is squared, and counts the steps: N = n - 1."),
            *(
                (
                    lambda L, a, b, n, at=at: L * (np.tan(a) - np.tan(b)) / (n + at) ** 2,
                    "N counts the steps between snaxels: N = n - 1.",
                )
                for at in (0, 1, -2)
            ),
            (lambda L, a, b, n: L * (np.sin(a) + np.sin(b)) / (n - 1) ** 2, "A slope is a tangent, not a sine."),
            (lambda L, a, b, n: L * (np.cos(a) - np.cos(b)) / (n - 1) ** 2, "A slope is a tangent, not a cosine."),
            (
                lambda L, a, b, n: L * abs(np.tan(a) + np.tan(b)) / (n - 1) ** 2,
                "tan theta1 is negative: adding it takes away what it should give.",
            ),
            *(
                (
                    lambda L, a, b, n, sign=sign: sign * L * (a - b) / (n - 1),
                    "These are angles, and the slope is the tangent of an angle; and N is squared.",
                )
                for sign in (1, -1)
            ),
            (
                lambda L, a, b, n: 2 * L * np.tan((a + np.pi - b) / 2) / (n - 1) ** 2,
                "The mean of the slopes is wanted, not the slope of the mean angle.",
            ),
            (
                lambda L, a, b, n: -2 * L * np.tan(b) / (n - 1) ** 2,
                "The second end is taken for both: the gap need not be symmetric.",
            ),
            (
                lambda L, a, b, n: (n - 1) ** 2 / (L * (np.tan(a) - np.tan(b))),
                "Upside down: this is 1 / k.",
            ),
            (
                lambda L, a, b, n: (np.tan(a) - np.tan(b)) * (n - 1) ** 2 / L,
                "Upside down: times the length of a step, L / N, and divided by N.",
            ),
            (
                lambda L, a, b, n: L / (n - 1) ** 2 * np.tan(a) - np.tan(b),
                "Products go before differences: put the difference of the slopes in brackets.",
            ),
        ),
        hints=(
            "The slope changes from tan theta0 to tan theta1 over N steps.",
            "One step along is L / N, and c'' = -k per step squared.",
            "So N k is the change of the slope, in px per step: times L / N. Solve for k.",
        ),
        praise="the ends themselves say how hard to blow.",
    ),
    "4.3": Exercise(
        cases=_tangents,
        right=_at_rest,
        answer=Answer(
            "an array (n, 2) of (along, out) from one end of the gap to the other",
            unit="px",
            tolerance=0.07,
            error=_px_off,
            shows=(np.asarray, "px"),
        ),
        mistakes=(
            (
                lambda L, a, b, n: _relaxed(L, a, b, n, 0.062),
                "This is the paper's k: too weak for these gaps. Let the ends choose it.",
            ),
            (
                lambda L, a, b, n: _relaxed(L, a, b, n, -_tangent_pressure(L, a, b, n)),
                "The balloon goes into the head: k must be positive here.",
            ),
            (
                lambda L, a, b, n: _relaxed(L, a, b, n, 2 * L * np.tan(a) / (n - 1) ** 2),
                "In k the first end is taken for both: the gap need not be symmetric.",
            ),
            (_mirrored, "The whole curve lies on the wrong side of the chord."),
            (lambda L, a, b, n: _relaxed(L, a, b, n, 0.0), "Without pressure tension pulls the curve flat."),
            (
                lambda L, a, b, n: np.column_stack([np.linspace(0, L, n), np.zeros(n)]),
                "This is the chord; the skull bulges.",
            ),
            (
                lambda L, a, b, n: cubic(L, a, b, n),
                "This is the start curve, not yet inflated: it keeps all the noise of the tangents.",
            ),
            (
                lambda L, a, b, n: spiral(L, a, b, n)[0],
                "This is the spiral, not a balloon: it keeps the noise of the tangents. Inflate.",
            ),
            (
                lambda L, a, b, n: _relaxed(L, a, b, n, L * (np.tan(a) - np.tan(b)) / n**2),
                "The balloon is too flat: in its k N counts the steps between snaxels, N = n - 1.",
            ),
            (
                lambda L, a, b, n: _at_rest(L, a, b, n, n),
                "The end slopes are too small: n snaxels have n - 1 steps between them.",
            ),
            (
                lambda L, a, b, n: _at_rest(L, a, b, n, 1),
                "The end slopes are for the whole gap; inflate wants them per snaxel: divide by n - 1.",
            ),
            (
                lambda L, a, b, n: _with_slopes(L, a, b, n, [[1, np.tan(a)], [1, np.tan(b)]]),
                "The end slopes are too small: one step along is L / N px, not 1 px.",
            ),
            (
                lambda L, a, b, n: _with_slopes(L, a, b, n, np.array([[1, np.tan(a)], [1, np.tan(b)]]) / (n - 1)),
                "The end slopes are far too small: one step along is L / N px.",
            ),
            (
                lambda L, a, b, n: _with_slopes(L, a, b, n, L * np.array([[1, np.tan(t)] for t in (b, a)]) / (n - 1)),
                "The end slopes are exchanged: theta0 belongs to the first end.",
            ),
            (
                lambda L, a, b, n: _with_slopes(L, a, b, n, L * np.array([[1, np.tan(t)] for t in (a, -b)]) / (n - 1)),
                "The slope at the second end has the wrong sign: theta1 is obtuse, its tangent is negative already.",
            ),
            (
                lambda L, a, b, n: _with_slopes(L, a, b, n, L * np.array([[np.tan(t), 1] for t in (a, b)]) / (n - 1)),
                "Along and out are exchanged in the end slopes: (along, out).",
            ),
            (
                lambda L, a, b, n: _with_slopes(
                    L, a, b, n, L * np.array([[np.cos(t), np.sin(t)] for t in (a, b)]) / (n - 1)
                ),
                "The slopes go with the chord: L / N along and L tan(theta) / N out, not cosine and sine.",
            ),
            *(
                (
                    lambda L, a, b, n, size=size: _with_slopes(
                        L, a, b, n, size(L, n) * np.array([[np.cos(t), np.sin(t)] for t in (a, b)])
                    ),
                    "These are tangents of one length: a slope goes L / N along and L tan(theta) / N out.",
                )
                for size in (lambda L, n: 1.0, lambda L, n: L)
            ),
            *(
                (
                    lambda L, a, b, n, signs=signs: _with_slopes(
                        L, a, b, n, L * np.array([[1, s * np.tan(a)] for s in signs]) / (n - 1)
                    ),
                    "The first end is taken for both: the second slope is tan theta1, negative already.",
                )
                for signs in ((1, -1), (1, 1), (-1, 1))
            ),
            (
                lambda L, a, b, n: _with_slopes(L, a, b, n, L * np.array([[1, -np.tan(t)] for t in (a, b)]) / (n - 1)),
                "The slopes have the wrong sign: out of the head is positive.",
            ),
            *(
                (
                    lambda L, a, b, n, slope=slope: _with_slopes(
                        L, a, b, n, L * np.array([[1, slope(t)] for t in (a, b)]) / (n - 1)
                    ),
                    "The slope out is the tangent of the angle: L tan(theta) / N.",
                )
                for slope in (np.sin, float)
            ),
            (
                lambda L, a, b, n: _relaxed(L, a, b, n, L * (np.tan(a) - np.tan(b)) / (n - 2) ** 2),
                "Blown too hard: tangent_pressure wants n, the number of snaxels, and takes n - 1 itself.",
            ),
            (
                lambda L, a, b, n: _with_slopes(L, a, b, n, 2 * [[L * np.tan(t) / (n - 1) for t in (a, b)]]),
                "Each slope has two parts, along and out: the end slopes are an array (2, 2).",
            ),
            (lambda L, a, b, n: _at_rest(L, a, b, n)[:, ::-1], "Along and out are exchanged: columns (along, out)."),
            (lambda L, a, b, n: _at_rest(L, a, b, n)[:, 1], "These are the heights alone: return (along, out)."),
            *(
                (
                    lambda L, a, b, n, stop=stop: (
                        inflate(
                            cubic(L, a, b, n),
                            L * np.array([[1, np.tan(t)] for t in (a, b)]) / (n - 1),
                            pressure=_tangent_pressure(L, a, b, n),
                            **stop,
                        ).curve
                    ),
                    "Not yet at rest: leave max_iter and tol as they are.",
                )
                for stop in ({"max_iter": 10}, {"tol": 1.0}, {"tol": 0.1})
            ),
            (lambda L, a, b, n: _at_rest(L, a, b, n + 1), "There is a snaxel too many: n of them have n - 1 steps."),
            (lambda L, a, b, n: _relaxed(L, a, b, n, 2 * _tangent_pressure(L, a, b, n)), "Blown twice too hard."),
        ),
        hints=(
            "Start with cubic(...), as in the lesson.",
            "deformable_model.inflate(start, end_slopes, pressure=k) wants the slopes per snaxel.",
            "deformable_model.tangent_pressure chooses k from the ends; inflate returns more than the curve.",
        ),
        praise="a balloon at rest, though the tangents were noisy and the start curve was poor.",
    ),
}
"""The exercises of lesson 04, by number."""
