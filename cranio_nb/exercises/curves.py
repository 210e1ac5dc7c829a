"""Exercises of lessons 03 and 04: boundary, tangents, balloon. Lengths of the balloon's cases are px of 0.45 mm."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy import ndimage

from ..balloon import inflate
from ..curves import cubic
from .task import Exercise, degrees_apart, different_pixels, largest_difference, small_head

_PX = 0.45  # mm: the paper's pixel


def _bones():
    bone = small_head().bone
    touching = np.zeros((12, 12), bool)
    touching[3:9, :7] = True
    return [(bone[19],), (bone[12],), (touching,)]


def _inner_edge(bone):
    return bone & ~ndimage.binary_erosion(bone)


def _clouds():
    t = np.linspace(-10.0, 10.0, 41)
    wave = 0.3 * np.cos(9 * t)
    clouds = []
    for angle in (20.0, 90.0, 145.0):
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        clouds.append((np.column_stack([c * t - s * wave, s * t + c * wave]) + np.array([60.0, 80.0]),))
    return clouds


def _line(points):
    return np.linalg.svd(points - points.mean(axis=0))[2][0]


def _by_slope(points):
    slope = np.polyfit(points[:, 0], points[:, 1], 1)[0]
    return np.array([1.0, slope])


def _spines():
    angle = np.linspace(0, 1.5 * np.pi, 60)
    arc = 50 * np.column_stack([np.cos(angle), np.sin(angle)])
    stairs = np.cumsum([[0, 0], [0, 1], [1, 1], [1, 0], [1, 1], [0, 1]], axis=0).astype(float)
    return [(stairs,), (arc,), (arc[::-3] + np.array([9.0, 7.0]),)]


def _arc_length(points):
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


def _pressures():
    return [(0.062, 21), (0.062, 41), (0.02, 31)]


@cache
def _gaps():
    """Closed-form gaps of the phantom in px of 0.45 mm: (length, theta0, theta1) and the true curve about the chord."""
    found = []
    for plane in (12, 16, 20):
        gap = max((t.outer for t in small_head().slice_truth(plane) if t.outer), key=lambda g: g.chord)
        along = (gap.ends[1] - gap.ends[0]) / gap.chord
        out = np.array([-along[1], along[0]])
        curve = (gap.curve - gap.ends[0]) @ np.array([along, out]).T
        curve[:, 1] *= np.sign(curve[len(curve) // 2, 1])
        scale = small_head().affine[1, 1] / _PX
        found.append((gap.chord * scale, *np.radians(gap.angles), curve * scale))
    return tuple(found)


def _tangents():
    return [(length, theta0, theta1, 21) for length, theta0, theta1, _ in _gaps()]


def _truth(length, theta0, theta1, n):
    return next(curve for known, _, _, curve in _gaps() if abs(known - length) < 1e-9)


def _mm_off(curve, truth):
    """Largest distance in mm from the nodes of a curve to the true one."""
    nodes = np.asarray(curve, float)
    if nodes.ndim != 2 or nodes.shape[1] != 2 or len(nodes) < 5:
        return float("inf")
    if np.ptp(nodes[:, 0]) < 0.9 * np.ptp(truth[:, 0]):
        return float("inf")
    return _PX * float(np.abs(nodes[:, 1] - np.interp(nodes[:, 0], *truth.T)).max())


def _tangent_pressure(length, theta0, theta1, n):
    return length * (np.tan(theta0) - np.tan(theta1)) / (n - 1) ** 2


def _relaxed(length, theta0, theta1, n, k):
    slopes = np.array([[length, length * np.tan(t)] for t in (theta0, theta1)]) / (n - 1)
    return inflate(cubic(length, theta0, theta1, n), slopes, pressure=k).curve


def _mirrored(length, theta0, theta1, n):
    return _relaxed(length, -theta0, -theta1, n, -_tangent_pressure(length, theta0, theta1, n))


CURVES = {
    "3.1": Exercise(
        _bones,
        _inner_edge,
        different_pixels,
        "pixels",
        0.0,
        "a mask like the one given",
        (
            (lambda b: ndimage.binary_dilation(b) & ~b, "These pixels lie outside the bone; B is part of the bone."),
            (
                lambda b: ndimage.binary_dilation(b) ^ ndimage.binary_erosion(b),
                "This band is two pixels wide; keep the bone's own.",
            ),
            (lambda b: ndimage.binary_erosion(b), "This is the inside; the boundary is what erosion takes away."),
            (
                lambda b: b & ~ndimage.binary_erosion(b, border_value=1),
                "At the edge of the image there is boundary too: erosion there needs border_value=0.",
            ),
            (
                lambda b: b & ~ndimage.binary_erosion(b, np.ones((3, 3))),
                "Use the cross of 4 neighbours; the square takes corners twice.",
            ),
        ),
        (
            "Which pixels does an erosion take away?",
            "ndimage.binary_erosion(bone) is the inside.",
            "bone & ~ndimage.binary_erosion(bone)",
        ),
        "one pixel wide, all of it bone.",
    ),
    "3.2": Exercise(
        _clouds,
        _line,
        degrees_apart,
        "degrees",
        0.5,
        "one direction: two numbers (row, col)",
        (
            (_by_slope, "y = a x + b cannot stand upright: with a steep line the fit fails. Use the SVD."),
            (
                lambda p: np.linalg.svd(p)[2][0],
                "The points are not centred: this looks at the origin. Subtract the mean.",
            ),
            (lambda p: np.linalg.svd(p - p.mean(axis=0))[2][1], "This is the normal, the direction of least spread."),
            (lambda p: _line(p)[::-1], "Row and column are swapped."),
            (
                lambda p: p[1] - p[0],
                "Two pixels are too few: the stairs of the boundary turn the line. Fit all points.",
            ),
        ),
        (
            "Centre the points first.",
            "The SVD gives the direction of largest spread.",
            "np.linalg.svd(points - points.mean(axis=0))[2][0]",
        ),
        "a tangent in any direction, upright too.",
    ),
    "3.3": Exercise(
        _spines,
        _arc_length,
        largest_difference,
        "px",
        1e-6,
        "one number for each point, starting with 0",
        (
            (lambda p: np.arange(len(p)).astype(float), "This counts points; a diagonal step is 1.41 px long."),
            (
                lambda p: np.linalg.norm(p - p[0], axis=1),
                "This is the straight distance to the first point, not the way along the curve.",
            ),
            (lambda p: _arc_length(p)[1:], "The first point is missing: its arc length is 0."),
            (
                lambda p: np.concatenate([[0.0], np.cumsum(np.abs(np.diff(p, axis=0)).sum(axis=1))]),
                "This adds rows and columns; a step is the root of the sum of squares.",
            ),
        ),
        (
            "np.diff gives the steps.",
            "Lengths of the steps, then np.cumsum.",
            "Put a 0 in front: np.concatenate([[0.0], ...])",
        ),
        "the way along the bone, not through the air.",
    ),
    "4.1": Exercise(
        _pressures,
        lambda k, n: k * (n - 1) ** 2 / 8,
        largest_difference,
        "px",
        1e-6,
        "one number",
        (
            (lambda k, n: k * n**2 / 8, "N counts the steps between snaxels: N = n - 1."),
            (lambda k, n: k * (n - 1) ** 2 / 2, "The apex lies in the middle, N / 2 steps from each end: k N^2 / 8."),
            (lambda k, n: k * (n - 1) ** 2, "The parabola's factor is missing: k N^2 / 8."),
            (lambda k, n: -k * (n - 1) ** 2 / 8, "With k > 0 outward the apex lies outside: it is positive."),
        ),
        ("At rest c'' = -k, with the end heights 0.", "c(i) = k i (N - i) / 2.", "Put i = N / 2, and N = n - 1."),
        "the apex does not know the width of the gap.",
    ),
    "4.2": Exercise(
        _tangents,
        _tangent_pressure,
        largest_difference,
        "px per index squared",
        1e-6,
        "one number",
        (
            (lambda L, a, b, n: L * (np.tan(a) - np.tan(b)) / n**2, "N counts the steps between snaxels: N = n - 1."),
            (
                lambda L, a, b, n: L * (np.tan(a) + np.tan(b)) / (n - 1) ** 2,
                "tan theta1 is negative: adding it takes away what it should give.",
            ),
            (
                lambda L, a, b, n: L * (np.tan(np.radians(a)) - np.tan(np.radians(b))) / (n - 1) ** 2,
                "The angles are in radians already.",
            ),
            (
                lambda L, a, b, n: (np.tan(a) - np.tan(b)) / (n - 1) ** 2,
                "The length is missing: a wide gap needs a larger k.",
            ),
        ),
        (
            "The slope changes from tan theta0 to tan theta1 over N steps.",
            "One step along is L / N, and c'' = -k per step squared.",
            "length * (np.tan(theta0) - np.tan(theta1)) / (n - 1) ** 2",
        ),
        "the ends themselves say how hard to blow.",
    ),
    "4.3": Exercise(
        _tangents,
        _truth,
        _mm_off,
        "mm",
        0.5,
        "an array (n, 2) of (along, out) from one end of the gap to the other",
        (
            (
                lambda L, a, b, n: _relaxed(L, a, b, n, 0.062),
                "This is the paper's k: too weak for these gaps. Let the ends choose it.",
            ),
            (
                lambda L, a, b, n: _relaxed(L, a, b, n, -_tangent_pressure(L, a, b, n)),
                "The balloon goes into the head: k must be positive here.",
            ),
            (_mirrored, "The whole curve lies on the wrong side of the chord."),
            (lambda L, a, b, n: _relaxed(L, a, b, n, 0.0), "Without pressure tension pulls the curve flat."),
            (
                lambda L, a, b, n: np.column_stack([np.linspace(0, L, n), np.zeros(n)]),
                "This is the chord; the skull bulges.",
            ),
        ),
        (
            "Start with cubic(...), as in the lesson.",
            "inflate(start, end_slopes, pressure=k) wants the slopes per snaxel.",
            "k = tangent_pressure(length, theta0, theta1, n)",
        ),
        "within half a millimetre of the bone that is missing.",
    ),
}
"""Lessons 03 and 04."""
