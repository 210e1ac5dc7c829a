"""Exercises of lessons 03 and 04: boundary, tangents, balloon. Lengths of the balloon's cases are px of 0.45 mm."""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy import ndimage

from ...curves import cubic, spiral
from ...stages.deformable_model import inflate
from .task import Exercise, degrees_apart, different_pixels, largest_difference, small_head

_PX = 0.45  # mm: the paper's pixel


def _bones():
    bone = small_head().bone
    touching = np.zeros((12, 12), bool)
    touching[3:9, :] = touching[:9, 3:9] = True  # left and right: a mask that is rolled meets itself; and the top
    return [(bone[19],), (bone[12],), (touching,)]


def _inner_edge(bone):
    return bone & ~ndimage.binary_erosion(bone)


def _rolled_edge(bone):
    sides = [np.roll(bone, step, axis) for axis in (0, 1) for step in (1, -1)]
    return bone & ~np.logical_and.reduce(sides)


def _clouds():
    t = np.linspace(-10.0, 10.0, 41)
    wave = 0.3 * np.cos(9 * t)
    wave[[0, -1]] += [2.0, -2.0]  # the line from the first point to the last is not the nearest to all
    clouds = []
    for angle in (0.0, 90.0, 145.0):
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        clouds.append((np.column_stack([c * t - s * wave, s * t + c * wave]) + np.array([60.0, 80.0]),))
    return clouds


def _line(points):
    return np.linalg.svd(points - points.mean(axis=0))[2][0]


def _by_slope(points):
    slope = np.polyfit(points[:, 0], points[:, 1], 1)[0]
    return np.array([1.0, slope])


def _by_slope_of_rows(points):
    slope = np.polyfit(points[:, 1], points[:, 0], 1)[0]
    return np.array([slope, 1.0])


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


def _mm_off(curve, wanted):
    """Largest distance in mm between two curves of n snaxels each, snaxel by snaxel."""
    nodes = np.asarray(curve, float)
    if nodes.shape != wanted.shape:
        return float("inf")
    return _PX * float(np.linalg.norm(nodes - wanted, axis=1).max())


def _tangent_pressure(length, theta0, theta1, n):
    return length * (np.tan(theta0) - np.tan(theta1)) / (n - 1) ** 2


def _relaxed(length, theta0, theta1, n, k, steps=None):
    """The balloon at rest under k; its end slopes are per one of `steps`, N if not given."""
    slopes = np.array([[length, length * np.tan(t)] for t in (theta0, theta1)]) / (steps or n - 1)
    return inflate(cubic(length, theta0, theta1, n), slopes, pressure=k).curve


def _at_rest(length, theta0, theta1, n, steps=None):
    return _relaxed(length, theta0, theta1, n, _tangent_pressure(length, theta0, theta1, n), steps)


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
            (_rolled_edge, "np.roll brings in the opposite border: what lies outside the image is not bone."),
            (
                lambda b: b & ~ndimage.binary_erosion(b, np.ones((3, 3))),
                "Use the cross of 4 neighbours; the square takes corners twice.",
            ),
        ),
        (
            "Which pixels does an erosion take away?",
            "ndimage.binary_erosion(bone) is the inside.",
            "Keep the bone that is not in its inside: `&` and `~`.",
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
            (_by_slope, "A slope of col over row fails for points along a row: no such line stands upright."),
            (
                _by_slope_of_rows,
                "A slope of row over col fails for points along a column: no such line stands upright.",
            ),
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
            (
                lambda p: p[-1] - p[0],
                "From the first point to the last: the noise of these two turns the line. Fit all points.",
            ),
        ),
        (
            "Centre the points first.",
            "The SVD gives the direction of largest spread.",
            "np.linalg.svd gives three arrays; the rows of the third are directions, the one of largest spread first.",
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
            (lambda k, n: k * (n - 1) ** 2 / 2, "Four times too high: where along the curve does the apex lie?"),
            (lambda k, n: k * (n - 1) ** 2, "Too high: the parabola has a factor of its own, and its apex a place."),
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
            (
                lambda L, a, b, n: -_tangent_pressure(L, a, b, n),
                "The sign is turned: from one end to the other the slope falls, and k is positive.",
            ),
            (lambda L, a, b, n: L * (a - b) / (n - 1) ** 2, "These are angles; the slope is the tangent of an angle."),
            (
                lambda L, a, b, n: L * (a + np.pi - b) / (n - 1) ** 2,
                "These are angles above the chord; the slope is the tangent of an angle, and not quite the same.",
            ),
        ),
        (
            "The slope changes from tan theta0 to tan theta1 over N steps.",
            "One step along is L / N, and c'' = -k per step squared.",
            "So N k is the change of the slope, in px per step: times L / N. Solve for k.",
        ),
        "the ends themselves say how hard to blow.",
    ),
    "4.3": Exercise(
        _tangents,
        _at_rest,
        _mm_off,
        "mm",
        0.1,
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
        ),
        (
            "Start with cubic(...), as in the lesson.",
            "inflate(start, end_slopes, pressure=k) wants the slopes per snaxel.",
            "k = tangent_pressure(length, theta0, theta1, n)",
        ),
        "a balloon at rest, though the tangents were noisy and the start curve was poor.",
    ),
}
"""Lessons 03 and 04."""
