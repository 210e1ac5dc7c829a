"""Exercises of lesson 10: a row of Tables 1 and 2, angles from gaps."""

from __future__ import annotations

import numpy as np

from .task import Answer, Exercise


def _records():
    def entry(plane, status, theta0, n_iter):
        return {"plane": plane, "status": status, "theta0": theta0, "n_iter": n_iter}

    slices = [
        entry(22, "balloon", [14.0, 17.5], [90, 75]),
        entry(20, "hull", [0.0, 0.0], [0, 0]),
        entry(23, "balloon", [21.0, 28.0], [131, 140]),
        entry(21, "balloon", [8.5, 12.0], [44, 61]),
        entry(24, "balloon", [11.0, 20.5], [102, 88]),
    ]
    # an answer that ignores key or side is right once at most
    return [(slices, "theta0", 1), (slices, "n_iter", 1), (slices, "n_iter", 0)]


def _has(entry):
    return entry["status"] == "balloon"


def _values(slices, key, side):
    return [s[key][side] for s in slices if _has(s)]


def _range(slices, key, side):
    return min(_values(slices, key, side)), max(_values(slices, key, side))


def _arcs():
    return [(50.0, 75.0), (20.0, 75.0), (70.0, 80.0)]


EXERCISES: dict[str, Exercise] = {
    "10.1": Exercise(
        cases=_records,
        right=_range,
        answer=Answer("two numbers: smallest and largest", unit="", tolerance=1e-9),
        mistakes=(
            (
                lambda s, k, i: (min(x[k][i] for x in s), max(x[k][i] for x in s)),
                "Slices filled by the hull have no balloon: leave them out.",
            ),
            (lambda s, k, i: _range(s, k, 1 - i), "Outer is side 0, inner is side 1."),
            (lambda s, k, i: _range(s, k, 0), "This is the outer side whatever `side` says: take s[key][side]."),
            (lambda s, k, i: _range(s, k, 1), "This is the inner side whatever `side` says: take s[key][side]."),
            (lambda s, k, i: _range(s, "theta0", i), "This is theta0 whatever `key` says: take s[key][side]."),
            (lambda s, k, i: _range(s, "n_iter", i), "This is n_iter whatever `key` says: take s[key][side]."),
            (
                lambda s, k, i: (np.min([x[k] for x in s if _has(x)]), np.max([x[k] for x in s if _has(x)])),
                "Both sides are thrown together: take s[key][side].",
            ),
            (lambda s, k, i: _range(s, k, i)[::-1], "The smallest comes first."),
            (
                lambda s, k, i: (_values(s, k, i)[0], _values(s, k, i)[-1]),
                "These are the first and the last; slices come in any order, so take min and max.",
            ),
            (
                lambda s, k, i: (np.mean(_values(s, k, i)),) * 2,
                "This is the mean; the paper's tables give smallest and largest.",
            ),
        ),
        hints=(
            "Which slices have a balloon? Look at their status.",
            "Take s[key][side] of those.",
            "min(values), max(values)",
        ),
        praise="a row of Tables 1 and 2.",
    ),
    "10.2": Exercise(
        cases=_arcs,
        right=lambda chord, radius: np.degrees(np.arcsin(chord / 2 / radius)),
        answer=Answer("one number", unit="degrees", tolerance=1e-6),
        mistakes=(
            (lambda c, r: np.arcsin(c / 2 / r), "This is in radians; the paper's tables are in degrees."),
            (
                lambda c, r: np.degrees(np.arcsin(c / r)),
                "Half the chord belongs to the right angle: chord / 2.",
            ),
            (
                lambda c, r: np.degrees(np.arctan(c / 2 / r)),
                "The radius is the long side of the right angle's triangle: a sine, not a tangent.",
            ),
            (
                lambda c, r: np.degrees(2 * np.arcsin(c / 2 / r)),
                "This is the angle at the centre; the tangent leans by half of it.",
            ),
        ),
        hints=(
            "Draw the radius to one end and to the middle of the chord.",
            "sin theta = (chord / 2) / radius.",
            "np.degrees(np.arcsin(chord / 2 / radius))",
        ),
        praise="with the radius, an angle says how wide a gap was.",
    ),
}
"""The exercises of lesson 10, by number."""
