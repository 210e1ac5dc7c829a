"""Exercises of lessons 07 and 10: distance from the truth, the paper's tables."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from .task import Exercise, largest_difference


def _clouds():
    grid = np.stack(np.meshgrid(np.arange(20.0), np.arange(20.0), [0.0]), axis=-1).reshape(-1, 3)
    bump = grid.copy()
    bump[::25, 2] += 6.0
    left, right = grid[grid[:, 0] < 12], grid[grid[:, 0] >= 4]
    return [(left, right + np.array([0.0, 0.0, 1.5])), (bump, grid), (grid, left)]


def _both_ways(a, b):
    return np.concatenate([cKDTree(b).query(a)[0], cKDTree(a).query(b)[0]])


def _planes():
    points = np.array([[50.0, 0.0, 10.0], [-20.0, 33.0, 4.0], [2.0, -70.0, 30.0]])
    lean = np.array([0.96, 0.28, 0.0])
    return [
        (points, np.array([1.0, 0.0, 0.0]), np.zeros(3)),
        (points, np.array([1.0, 0.0, 0.0]), np.array([2.3, 0.0, 0.0])),
        (points, lean, np.array([2.3, -6.1, 40.0])),
    ]


def _mirrored(points, normal, origin):
    return points - 2 * ((points - origin) @ normal)[:, None] * normal


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
    return [(slices, "theta0", 0), (slices, "theta0", 1), (slices, "n_iter", 0)]


def _values(slices, key, side):
    return [s[key][side] for s in slices if s["status"] == "balloon"]


def _range(slices, key, side):
    return min(_values(slices, key, side)), max(_values(slices, key, side))


def _arcs():
    return [(50.0, 75.0), (20.0, 75.0), (90.0, 80.0)]


MEASURE = {
    "7.1": Exercise(
        _clouds,
        lambda a, b: np.percentile(_both_ways(a, b), 95),
        largest_difference,
        "mm",
        1e-6,
        "one number",
        (
            (
                lambda a, b: np.percentile(cKDTree(b).query(a)[0], 95),
                "One way only: what is missing in a is not seen. Look from b as well.",
            ),
            (
                lambda a, b: np.percentile(cKDTree(a).query(b)[0], 95),
                "One way only: what a has too much is not seen. Look from a as well.",
            ),
            (
                lambda a, b: max(np.percentile(cKDTree(b).query(a)[0], 95), np.percentile(cKDTree(a).query(b)[0], 95)),
                "This is the larger of two percentiles (some papers do so); join the distances, then take one.",
            ),
            (
                lambda a, b: np.percentile(_both_ways(a, b), 0.95),
                "np.percentile counts to 100: 95, not 0.95.",
            ),
            (lambda a, b: _both_ways(a, b).max(), "This is the largest distance; HD95 leaves the worst 5 percent out."),
            (lambda a, b: _both_ways(a, b).mean(), "This is the mean distance (ASSD), not the 95th percentile."),
            (
                lambda a, b: np.percentile(np.linalg.norm(a[:, None] - b[None], axis=-1), 95),
                "This takes every pair of points; wanted is the distance to the nearest one.",
            ),
        ),
        (
            "cKDTree(b).query(a)[0] are the distances from a to b.",
            "Take both ways and join them.",
            "np.percentile(np.concatenate([...]), 95)",
        ),
        "missing parts count as much as extra ones.",
    ),
    "7.2": Exercise(
        _planes,
        _mirrored,
        largest_difference,
        "mm",
        1e-6,
        "an array like the points",
        (
            (lambda p, n, o: p - ((p - o) @ n)[:, None] * n, "The points stop on the plane: go twice as far."),
            (
                lambda p, n, o: p - 2 * (p @ n)[:, None] * n,
                "The plane does not pass through 0, 0, 0: measure from the origin given.",
            ),
            (
                lambda p, n, o: p - 2 * ((p - o) @ n) * n,
                "Each point needs its own distance: a column, distance[:, None], times the normal.",
            ),
            (
                lambda p, n, o: p + 2 * ((p - o) @ n)[:, None] * n,
                "The sign is wrong: this goes away from the plane, not through it.",
            ),
            (
                lambda p, n, o: _mirrored(p, n, o) - o,
                "Measured from the origin and left there: take the steps off the points, not off points - origin.",
            ),
            (lambda p, n, o: p * [-1, 1, 1], "This mirrors at x = 0; the head stands aside and leans."),
            (lambda p, n, o: 2 * o - p, "This is a point reflection: only the part along the normal may change sign."),
        ),
        (
            "How far is a point from the plane? (points - origin) @ normal.",
            "Go back twice that far along the normal.",
            "points - 2 * distance[:, None] * normal",
        ),
        "the sound side has crossed the plane.",
    ),
    "10.1": Exercise(
        _records,
        _range,
        largest_difference,
        "",
        1e-9,
        "two numbers: smallest and largest",
        (
            (
                lambda s, k, i: (min(x[k][i] for x in s), max(x[k][i] for x in s)),
                "Slices filled by the hull have no balloon: leave them out.",
            ),
            (lambda s, k, i: _range(s, k, 1 - i), "Outer is side 0, inner is side 1."),
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
        (
            "Which slices have a balloon? Look at their status.",
            "Take s[key][side] of those.",
            "min(values), max(values)",
        ),
        "a row of Tables 1 and 2.",
    ),
    "10.2": Exercise(
        _arcs,
        lambda chord, radius: np.degrees(np.arcsin(chord / 2 / radius)),
        largest_difference,
        "degrees",
        1e-6,
        "one number",
        (
            (lambda c, r: np.arcsin(c / 2 / r), "This is in radians; the paper's tables are in degrees."),
            (
                lambda c, r: np.degrees(np.arcsin(min(c / r, 1))),
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
        (
            "Draw the radius to one end and to the middle of the chord.",
            "sin theta = (chord / 2) / radius.",
            "np.degrees(np.arcsin(chord / 2 / radius))",
        ),
        "angles say how wide a gap was.",
    ),
}
"""Lessons 07 and 10."""
