"""Exercises of lesson 07: HD95, mirror images."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from .task import Answer, Exercise


def _clouds():
    grid = np.stack(np.meshgrid(np.arange(20.0), np.arange(20.0), [0.0]), axis=-1).reshape(-1, 3)
    bump = grid.copy()
    bump[:, 2] += np.linspace(0.0, 1.6, len(grid))  # so that no two percentiles agree
    bump[::25, 2] += 6.0
    left, right = grid[grid[:, 0] < 12], grid[grid[:, 0] >= 4]
    return [(left, right + np.array([0.0, 0.0, 1.5])), (bump, grid), (grid, left)]


def _ways(a, b, part=0):
    """Distances to the nearest points each way; with `part` 1 the numbers of these points."""
    return cKDTree(b).query(a)[part], cKDTree(a).query(b)[part]


def _both_ways(a, b, part=0):
    return np.concatenate(_ways(a, b, part))


def _percentiles(a, b):
    """One for each way."""
    return [np.percentile(way, 95) for way in _ways(a, b)]


def _planes():
    # not as many points as coordinates, and one normal without a 0
    points = np.array([[50.0, 0.0, 10.0], [-20.0, 33.0, 4.0], [2.0, -70.0, 30.0], [7.0, 11.0, -25.0], [0.0, 3.0, 60.0]])
    lean = np.array([2.0, -1.0, 2.0]) / 3
    return [
        (points, np.array([1.0, 0.0, 0.0]), np.zeros(3)),
        (points, np.array([1.0, 0.0, 0.0]), np.array([2.3, 0.0, 0.0])),
        (points, lean, np.array([2.3, -6.1, 40.0])),
    ]


def _mirrored(points, normal, origin):
    return points - 2 * ((points - origin) @ normal)[:, None] * normal


EXERCISES: dict[str, Exercise] = {
    "7.1": Exercise(
        cases=_clouds,
        right=lambda a, b: np.percentile(_both_ways(a, b), 95),
        answer=Answer("one number", unit="mm", tolerance=1e-6),
        mistakes=(
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
            (
                lambda a, b: min(_percentiles(a, b)),
                "This is the smaller of two percentiles; join the distances, then take one.",
            ),
            (
                lambda a, b: sum(_percentiles(a, b)) / 2,
                "This is the mean of two percentiles (some papers do so); join the distances, then take one.",
            ),
            (lambda a, b: np.median(_both_ways(a, b)), "This is the median; HD95 leaves out only the worst 5 percent."),
            (lambda a, b: np.percentile(_both_ways(a, b), 5), "The worst 5 percent are left out, not the best: 95."),
            (
                lambda a, b: 0.95 * _both_ways(a, b).max(),
                "95 percent of the largest distance; wanted is the distance that 95 percent of the points keep.",
            ),
            (_both_ways, "These are all distances: take their 95th percentile."),
            *(
                (mistake, "query gives distances and numbers of points: [0] are the distances.")
                for mistake in (
                    lambda a, b: np.percentile(cKDTree(b).query(a)[1], 95),
                    lambda a, b: np.percentile(cKDTree(a).query(b)[1], 95),
                    lambda a, b: np.percentile(_both_ways(a, b, 1), 95),
                    lambda a, b: max(np.percentile(way, 95) for way in _ways(a, b, 1)),
                )
            ),
            (
                lambda a, b: np.percentile(np.append(cKDTree(a).query(a)[0], cKDTree(b).query(b)[0]), 95),
                "All distances are 0: each set is asked for its own points; tree and query belong to different sets.",
            ),
            (lambda a, b: np.percentile(_both_ways(a, b) ** 2, 95), "These are squares of distances."),
            (lambda a, b: cKDTree(b).query(a)[0].max(), "This is the largest distance, one way only."),
            (lambda a, b: cKDTree(b).query(a)[0].mean(), "This is the mean distance, one way only."),
            (
                lambda a, b: np.percentile(cKDTree(b).query(a, k=2)[0], 95),
                "k=2 takes the second nearest point too, and this is one way only.",
            ),
        ),
        hints=(
            "spatial.cKDTree(b).query(a)[0] are the distances from a to b.",
            "Take both ways and join them.",
            "np.concatenate joins the two ways; np.percentile counts to 100.",
        ),
        praise="missing parts count as much as extra ones.",
    ),
    "7.2": Exercise(
        cases=_planes,
        right=_mirrored,
        answer=Answer("an array like the points", unit="mm", tolerance=1e-6),
        mistakes=(
            (lambda p, n, o: p - ((p - o) @ n)[:, None] * n, "The points stop on the plane: go twice as far."),
            (
                lambda p, n, o: p - 2 * (p @ n)[:, None] * n,
                "The plane does not pass through 0, 0, 0: measure from the origin given.",
            ),
            (
                lambda p, n, o: p + 2 * ((p - o) @ n)[:, None] * n,
                "The sign is wrong: this goes away from the plane, not through it.",
            ),
            (
                lambda p, n, o: _mirrored(p, n, o) - o,
                "Measured from the origin and left there: take the steps off the points, not off points - origin.",
            ),
            (
                lambda p, n, o: p - 2 * np.abs((p - o) @ n)[:, None] * n,
                "The distance has a sign, which says on which side a point lies: without abs it turns back of itself.",
            ),
            (
                lambda p, n, o: np.flip(p, axis=0),
                "np.flip turns the order of the points round; their places stay what they were.",
            ),
            (
                lambda p, n, o: np.flip(p, axis=1),
                "np.flip swaps x and z; a mirror image keeps the axes and changes what runs along the normal.",
            ),
            (lambda p, n, o: np.flip(p), "np.flip turns arrays round, it knows of no plane: measure from it."),
            (lambda p, n, o: p * [-1, 1, 1], "This mirrors at x = 0; the head stands aside and leans."),
            (lambda p, n, o: 2 * o - p, "This is a point reflection: only the part along the normal may change sign."),
            (
                lambda p, n, o: p - (p @ n)[:, None] * n,
                "The points stop on a plane through 0, 0, 0: go twice as far, and measure from the origin given.",
            ),
            (lambda p, n, o: p - 2 * n, "All points are moved by the same step: each goes twice its own distance."),
            *(
                (mistake, "The distance is a dot product, (points - origin) @ normal; this multiplies axis by axis.")
                for mistake in (lambda p, n, o: p - 2 * (p - o) * n, lambda p, n, o: p - 2 * (p - o) * n * n)
            ),
            (
                lambda p, n, o: o - 2 * ((p - o) @ n)[:, None] * n,
                "The steps are taken off the origin; take them off the points.",
            ),
            (lambda p, n, o: -2 * ((p - o) @ n)[:, None] * n, "These are the steps alone; add them to the points."),
            (
                lambda p, n, o: (p - o) @ n,
                "These are the distances from the plane; go back twice as far along the normal.",
            ),
            (lambda p, n, o: p - 2 * ((p + o) @ n)[:, None] * n, "Measure from the origin: points - origin."),
            (
                lambda p, n, o: p * (1 - 2 * n),
                "This turns single axes round; a leaning plane mixes them: measure along the normal.",
            ),
            (lambda p, n, o: -p, "This is a point reflection: only the part along the normal may change sign."),
            *(
                (way, "The origin is added, but was not taken off: measure from it, (points - origin) @ normal.")
                for way in (
                    lambda p, n, o: _mirrored(p, n, o) + o,
                    lambda p, n, o: p - 2 * (p @ n)[:, None] * n + o,
                )
            ),
            (
                lambda p, n, o: 2 * (o + ((p - o) @ n)[:, None] * n) - p,
                "This is a half turn about the normal: turn the part along the normal round, and keep the rest.",
            ),
            (
                lambda p, n, o: p - 2 * (((p - o) @ n)[:, None] * n) * [1, 1, 0],
                "The third coordinate is left out: the normal leans in all three.",
            ),
            (
                lambda p, n, o: p - 2 * np.linalg.norm(p - o, axis=1)[:, None] * n,
                "This is the distance from the origin given; from the plane it is (points - origin) @ normal.",
            ),
        ),
        hints=(
            "How far is a point from the plane? (points - origin) @ normal.",
            "Go back twice that far along the normal.",
            "One distance for each point: distance[:, None] makes them a column that can be multiplied by the normal.",
        ),
        praise="the sound side has crossed the plane.",
    ),
}
"""The exercises of lesson 07, by number."""
