"""Exercises of lesson 08: a symmetry plane from pairs, the depth of a flat lid, a lid between two hulls."""

from __future__ import annotations

import numpy as np
from skimage.morphology import convex_hull_image

from .task import Answer, Exercise, different_bools, largest_difference

_UNIT = 1e-5  # by which a length may differ from 1, in single precision too
_LONG = "The normal must have length 1: divide it by its length."


def _pairs():
    a = np.array([[60.0, 10.0, 5.0], [45.0, -50.0, 30.0], [30.0, 40.0, 70.0], [71.0, 2.0, -20.0]])
    found = []
    for normal, point in (
        ([1.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        (np.array([12.0, -4.0, 3.0]) / 13, [2.3, -6.1, 40.0]),  # signs of both kinds
    ):
        n = np.array(normal)
        found.append((a, a - 2 * ((a - point) @ n)[:, None] * n))
    # many pairs with errors of measurement, which add up to nothing: each pair alone is 2 mm off along every axis
    grid = np.stack(np.meshgrid([40.0, 55.0, 70.0], [-60.0, -20.0, 20.0, 60.0], [-20.0, 20.0, 60.0]), axis=-1)
    many, n = grid.reshape(-1, 3), np.array([0.96, 0.28, 0.0])
    errors = 2.0 * (-1.0) ** np.arange(len(many))[:, None]
    return [*found, (many, many - 2 * ((many - point) @ n)[:, None] * n + errors)]


def _plane(a, b):
    across = (a - b).sum(axis=0)
    return across / np.linalg.norm(across), (a + b).mean(axis=0) / 2


def _unit(vector):
    return vector / np.linalg.norm(vector)


def _each_unit(a, b):
    return (a - b) / np.linalg.norm(a - b, axis=1, keepdims=True)


def _first(a, b):
    return (a[0] - b[0]) / np.linalg.norm(a[0] - b[0]), (a[0] + b[0]) / 2


def _with_point(point, sentence):
    """A wrong point, with the normal of all pairs or of the first."""
    return tuple(((lambda a, b, way=way: (way(a, b)[0], point(a, b))), sentence) for way in (_plane, _first))


def _either_way(way, sentence):
    """A wrong answer made of a - b, and the same one made of b - a."""
    return (way, sentence), (lambda a, b: way(b, a), sentence)


def _plane_error(answer, right):
    """How far the mirror images of a few points lie apart, mm."""
    if abs(np.linalg.norm(np.asarray(answer[0], float)) - 1) > _UNIT:
        return float("inf")
    points = np.array([[0.0, 0.0, 0.0], [50.0, 0.0, 0.0], [0.0, 50.0, 0.0], [0.0, 0.0, 50.0]])
    images = [
        points - 2 * ((points - np.asarray(p, float)) @ np.asarray(n, float))[:, None] * np.asarray(n, float)
        for n, p in (answer, right)
    ]
    return largest_difference(*images)


def _normal_and_distance(plane):
    """Four numbers that tell planes apart: the normal, its largest part positive, and how far 0, 0, 0 is."""
    normal, point = (np.asarray(part, float) for part in plane)
    normal = normal * np.sign(normal[np.abs(normal).argmax()])
    return np.append(normal, point @ normal / np.linalg.norm(normal))


def _caps():
    return [(30.0, 6.0), (50.0, 20.0), (20.0, 1.0)]


def _mean_depth(a, h):
    return h / 2 + h**3 / (6 * a**2)


def _open_rings():
    row, col = np.indices((90, 90)) - 45
    radius, cases = np.hypot(row, 1.15 * col), []
    for half, up in ((9, True), (16, True), (14, False)):
        gap = (row < 0 if up else row > 0) & (np.abs(col) < half)
        rim = (radius < 28.5) & (radius > 27.0)
        cases.append(((radius < 36) & (radius > 28) & ~gap, rim & ~gap))
    return cases


def _lid(bone, inner):
    return convex_hull_image(bone) & ~convex_hull_image(inner) & ~bone


EXERCISES: dict[str, Exercise] = {
    "8.1": Exercise(
        cases=_pairs,
        right=_plane,
        answer=Answer(
            "two arrays of 3 numbers: the unit normal and a point",
            unit="mm",
            tolerance=0.2,
            error=_plane_error,
            shows=(_normal_and_distance, "(normal, mm from 0, 0, 0)"),
        ),
        mistakes=(
            (lambda a, b: ((a - b).mean(axis=0), (a + b).mean(axis=0) / 2), _LONG),
            (
                lambda a, b: (abs(_plane(a, b)[0]), _plane(a, b)[1]),
                "The normal has lost its signs: its numbers may be of both.",
            ),
            (lambda a, b: (a[0] - b[0], (a + b).mean(axis=0) / 2), _LONG),
            (lambda a, b: (_each_unit(a, b).mean(axis=0), (a + b).mean(axis=0) / 2), _LONG),
            (lambda a, b: (a[0] - b[0], (a[0] + b[0]) / 2), _LONG),
            *_with_point(
                lambda a, b: a.mean(axis=0),
                "The plane passes through the points themselves: it lies half-way between the two of a pair.",
            ),
            *_with_point(
                lambda a, b: (a + b).mean(axis=0),
                "The point is twice as far out: half-way between the two of a pair is (a + b) / 2.",
            ),
            *_with_point(
                lambda a, b: np.zeros(3),
                "The plane need not pass through 0, 0, 0: a point half-way between a pair lies on it.",
            ),
            (
                lambda a, b: _first(a[::-1], b[::-1]),
                "This rests on the last pair only, and a pair has its error: take all of them together.",
            ),
            (_first, "This rests on the first pair only, and a pair has its error: take all of them together."),
            (
                lambda a, b: (_first(a, b)[0], _plane(a, b)[1]),
                "The normal rests on the first pair only, and a pair has its error: take all of them together.",
            ),
            (
                lambda a, b: (_plane(a, b)[0], _first(a, b)[1]),
                "The point rests on the first pair only, and a pair has its error: take the mean of all.",
            ),
            (
                lambda a, b: (np.array([1.0, 0.0, 0.0]), (a + b).mean(axis=0) / 2),
                "This takes x for the normal; the head leans: the normal runs from one point of a pair to the other.",
            ),
            *_either_way(lambda a, b: _plane(a, b)[::-1], "Turned round: the normal comes first, then the point."),
            (lambda a, b: _plane(a, b)[0], "The point is missing: return the normal and a point."),
            (
                lambda a, b: (_unit((a + b).mean(axis=0)), _plane(a, b)[1]),
                "The normal runs from a point to its partner: the difference of the two, not their sum.",
            ),
            *_either_way(
                lambda a, b: (_plane(a, b)[0], (a - b).mean(axis=0) / 2),
                "The point is half of the way across, not the place half-way: (a + b) / 2.",
            ),
            (
                lambda a, b: (np.linalg.svd(a - b - (a - b).mean(axis=0))[2][0], _plane(a, b)[1]),
                "The mean was taken off the differences, and it is what points across: leave it in.",
            ),
            (
                lambda a, b: (_unit(np.cross(a[0], b[0])), _plane(a, b)[1]),
                "A cross product lies across both; the normal is the difference of partners.",
            ),
            (
                lambda a, b: (np.linalg.svd((a + b) / 2 - _plane(a, b)[1])[2][0], _plane(a, b)[1]),
                "This is the direction in which the middles spread, and that is in the plane.",
            ),
            (
                lambda a, b: (_plane(a, b)[0], (a + b).mean() / 2),
                "The point is one number, the mean of all coordinates: each axis has its own mean, axis=0.",
            ),
            (
                lambda a, b: (_each_unit(a, b), (a + b) / 2),
                "A normal and a point for each pair: one of each is wanted, the mean of all.",
            ),
            (
                lambda a, b: (_plane(a, b)[0], b.mean(axis=0)),
                "The plane passes through the points themselves: it lies half-way between the two of a pair.",
            ),
            (
                lambda a, b: ((a - b).mean(axis=0) / np.linalg.norm(a - b), _plane(a, b)[1]),
                "np.linalg.norm(a - b) is one number for all pairs: divide by the length of the mean.",
            ),
            (
                lambda a, b: ((a - b).mean(axis=0) / (a - b).mean(axis=0).sum(), _plane(a, b)[1]),
                "Divided by the sum of its parts: the length is np.linalg.norm.",
            ),
        ),
        hints=(
            "Which way does one go from a point to its partner?",
            "The normal is the direction of a - b; half-way between a and b lies the plane.",
            "Add up the differences of all pairs, divide by the length of the sum; the point: the mean of the middles.",
        ),
        praise="the pairs' own plane, wherever the head lies.",
    ),
    "8.2": Exercise(
        cases=_caps,
        right=_mean_depth,
        answer=Answer("one number", unit="mm", tolerance=1e-6),
        mistakes=(
            (lambda a, h: h, "This is the depth in the middle, the largest; wanted is the mean."),
            (
                lambda a, h: h / 2,
                "Nearly: h / 2 is the limit for flat caps. Divide the cap's exact volume by the hole's area.",
            ),
            (lambda a, h: 2 * h / 3, "This is the mean of a flat arc in a slice; in space the low rim has more area."),
            (
                lambda a, h: np.pi * h * (3 * a**2 + h**2) / 6,
                "This is the volume of the cap; divide it by the area of the hole.",
            ),
            (lambda a, h: h * (3 * a**2 + h**2) / (6 * a), "The area of the lid grows with a squared."),
            (lambda a, h: h * (3 * a**2 + h**2) / 6, "The area of the lid, pi a^2, is still to be divided by."),
            (lambda a, h: np.pi * h * (3 * a**2 + h**2) / (6 * a**2), "pi is in the area too: it falls out."),
            (
                lambda a, h: h * (3 * a**2 + h**2) / (24 * a**2),
                "a is the radius of the hole, and its area pi a^2, a quarter of this divisor.",
            ),
            *(
                (mistake, "a is the radius already, not the diameter: the area of the hole is pi a^2.")
                for mistake in (
                    lambda a, h: 4 * _mean_depth(a, h),
                    lambda a, h: _mean_depth(a / 2, h),
                    lambda a, h: _mean_depth(a / 2, h) / 4,
                    lambda a, h: _mean_depth(2 * a, h),
                    lambda a, h: 4 * _mean_depth(2 * a, h),
                )
            ),
            (lambda a, h: h * (3 * a**2 + h**2) / (12 * a), "2 pi a is the rim of the lid, not its area."),
            (
                lambda a, h: h * (3 * a**2 + h**2) / (6 * (a**2 + h**2)),
                "This is the area of the cap; the mean is taken over the flat lid.",
            ),
            (lambda a, h: (3 * a**2 + h**2) / (6 * h), "h is the height, not the radius of the lid: divide by pi a^2."),
            (lambda a, h: h / 3, "This is the mean of a cone; the cap's own volume is given."),
            (lambda a, h: h * (3 * a + h**2) / (6 * a**2), "In the volume of the cap a is squared."),
            (lambda a, h: h * (3 * a**2 + h**2) / 6 * a**2, "Brackets: a^2 stands below the line."),
            (
                lambda a, h: np.sqrt(a**2 + h**2),
                "This is the way from the top of the cap to its rim; wanted is volume / area.",
            ),
        ),
        hints=(
            "Mean depth = volume between cap and lid / area of the lid.",
            "The cap's volume is pi h (3 a^2 + h^2) / 6, the lid's area pi a^2.",
            "Divide the one by the other: pi falls out, a^2 stays below.",
        ),
        praise="about half of the height, the price of a flat fill.",
    ),
    "8.3": Exercise(
        cases=_open_rings,
        right=_lid,
        answer=Answer("a bool mask like the ones given", unit="pixels", tolerance=0.0, error=different_bools),
        mistakes=(
            (
                lambda b, i: convex_hull_image(b) & ~b,
                "The brain's place is in it: take the hull of the inner edge away too.",
            ),
            (
                lambda b, i: convex_hull_image(b) & ~convex_hull_image(i),
                "Bone is still in it: a prosthesis cannot be where the bone is.",
            ),
            (
                lambda b, i: convex_hull_image(b) & ~i & ~b,
                "Only the inner edge was taken away; what it encloses is its hull.",
            ),
            (lambda b, i: convex_hull_image(i) & ~b, "This is the inside of the head."),
            (
                lambda b, i: convex_hull_image(b),
                "This is the whole hull of the bone: take the brain's place and the bone away.",
            ),
            (lambda b, i: convex_hull_image(b) & ~i, "Only the inner edge was taken away, and bone is still in it."),
            (
                lambda b, i: ~convex_hull_image(i) & ~b,
                "What lies outside the head is in it: stay within the hull of the bone.",
            ),
            (
                lambda b, i: np.zeros_like(b),
                "The mask is empty: an open ring has no hole to fill, and the hull of the inner edge lies within "
                "that of the bone.",
            ),
            (lambda b, i: convex_hull_image(b) & ~convex_hull_image(i) | b, "The bone is in it: & ~bone, not | bone."),
            (lambda b, i: convex_hull_image(b) & convex_hull_image(i) & ~b, "This is the inside of the head."),
            (lambda b, i: b, "This is the bone that is there already."),
            (
                lambda b, i: convex_hull_image(b) & ~convex_hull_image(b | i) | convex_hull_image(b | i) & ~b,
                "The brain's place is in it: take the hull of the inner edge away too.",
            ),
            (
                lambda b, i: convex_hull_image(b) & ~convex_hull_image(i) & b,
                "This is bone that is there already: & ~bone, not & bone.",
            ),
        ),
        hints=(
            "One hull for the outside, one for the inside.",
            "convex_hull_image(inner) is the inside of the head.",
            "Three masks joined by `&`: which two of them with `~`?",
        ),
        praise="a lid where the paper's rule would give nothing.",
    ),
}
"""The exercises of lesson 08, by number."""
