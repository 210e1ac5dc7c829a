"""Exercises of lesson 03: boundary, tangent, arc length."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from scipy import ndimage

from .task import Answer, Exercise, degrees_apart, different_bools, small_head


def _bones():
    closed = small_head().bone[30].copy()  # a closed ring
    closed[2:5, 2:5] = True  # a loose piece, met before the ring
    touching = np.zeros((12, 12), bool)
    touching[3:9, :] = touching[:9, 3:9] = True  # left and right: a mask that is rolled meets itself; and the top
    return [(small_head().bone[19],), (closed,), (touching,)]


def _inner_edge(bone):
    return bone & ~ndimage.binary_erosion(bone)


def _rolled_edge(bone):
    sides = [np.roll(bone, step, axis) for axis in (0, 1) for step in (1, -1)]
    return bone & ~np.logical_and.reduce(sides)


def _without_frame(bone):
    edge = np.zeros_like(bone)
    edge[1:-1, 1:-1] = _inner_edge(bone)[1:-1, 1:-1]
    return edge


def _one_side_open(bone):
    """Bone of which exactly one neighbour is no bone."""
    framed = np.pad(bone, 1)
    beside = sum(np.roll(framed, step, axis)[1:-1, 1:-1].astype(int) for axis, step in _SIDES)
    return bone & (beside == 3)


def _with_neighbours(bone, join, *sides):
    """Bone whose neighbours at some sides, (axis, step), are not all bone, or not any."""
    framed = np.pad(bone, 1)
    return bone & ~join([np.roll(framed, step, axis)[1:-1, 1:-1] for axis, step in sides])


_SIDES = ((0, 1), (0, -1), (1, 1), (1, -1))  # axis, step


def _clouds():
    t = np.linspace(-10.0, 10.0, 41)
    wave = 1.2 * np.cos(9 * t)  # so wide that a fit along one axis leans, even along the better one
    # neither the line from first point to last is the nearest to all, nor one that joins the means of two parts
    wave[[0, -1]] = [2.0, -2.0]
    wave[[10, 12, 13]], wave[[27, 28, 30]] = -2.0, 2.0
    clouds = []
    for angle in (0.0, 90.0, 145.0):
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        clouds.append((np.column_stack([c * t - s * wave, s * t + c * wave]) + np.array([60.0, 80.0]),))
    return clouds


def _parts(points):
    return np.linalg.svd(points - points.mean(axis=0))


def _line(points):
    return _parts(points)[2][0]


def _by_slope(points):
    slope = np.polyfit(points[:, 0], points[:, 1], 1)[0]
    return np.array([1.0, slope])


def _by_slope_of_rows(points):
    slope = np.polyfit(points[:, 1], points[:, 0], 1)[0]
    return np.array([slope, 1.0])


def _by_better_slope(points):
    """The polyfit that leaves less, along its own axis."""
    (slope, _), left, *_ = np.polyfit(points[:, 0], points[:, 1], 1, full=True)
    (other, _), left_other, *_ = np.polyfit(points[:, 1], points[:, 0], 1, full=True)
    return np.array([1.0, slope]) if left[0] < left_other[0] else np.array([other, 1.0])


def _spines():
    angle = np.linspace(0, 1.5 * np.pi, 60)
    arc = 50 * np.column_stack([np.cos(angle), np.sin(angle)])
    # the steps differ, and read otherwise from the other end
    stairs = np.cumsum([[0, 0], [0, 1], [1, 1], [1, 0], [1, 1], [1, 2], [2, 2]], axis=0).astype(float)
    return [(stairs,), (arc,), (arc[::-3] + np.array([9.0, 7.0]),)]


def _arc_length(points):
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])


EXERCISES: dict[str, Exercise] = {
    "3.1": Exercise(
        cases=_bones,
        right=_inner_edge,
        answer=Answer("a bool mask like the one given", unit="pixels", tolerance=0.0, error=different_bools),
        mistakes=(
            (lambda b: ndimage.binary_dilation(b) & ~b, "These pixels lie outside the bone; B is part of the bone."),
            (
                lambda b: ndimage.binary_dilation(b) ^ ndimage.binary_erosion(b),
                "This band is two pixels wide; keep the bone's own.",
            ),
            (
                lambda b: b & ~ndimage.binary_erosion(ndimage.binary_fill_holes(b)),
                "The inner boundary is missing: do not fill the ring, the brain's place is no bone.",
            ),
            (
                lambda b: _inner_edge(ndimage.label(b)[0] == 1),
                "This is the boundary of one piece of bone: take all of them.",
            ),
            (_one_side_open, "One neighbour that is not bone is enough, but two or three may be: at least one."),
            (lambda b: ndimage.binary_erosion(b), "This is the inside; the boundary is what erosion takes away."),
            (
                lambda b: b & ~ndimage.binary_erosion(b, border_value=1),
                "At the edge of the image there is boundary too: erosion there needs border_value=0.",
            ),
            (_rolled_edge, "np.roll brings in the opposite border: what lies outside the image is not bone."),
            (
                lambda b: b & ~ndimage.binary_erosion(b, np.ones((3, 3))),
                "Use the cross of 4 neighbours; the square of 8 also takes pixels that touch by a corner.",
            ),
            (
                lambda b: _with_neighbours(b, np.logical_or.reduce, *_SIDES),
                "These have no neighbour of bone at all: one neighbour that is not bone is enough, join them by `&`.",
            ),
            *(
                (
                    lambda b, sides=sides: _with_neighbours(b, np.logical_and.reduce, *sides),
                    "Neighbours are left out: look at all four, above, below, left and right.",
                )
                for sides in (*combinations(_SIDES, 2), *combinations(_SIDES, 3), *combinations(_SIDES, 1))
            ),
            (
                lambda b: b & ~ndimage.binary_erosion(b, np.ones((3, 3)), border_value=1),
                "Use the cross of 4 neighbours, not the square of 8; and what lies outside the image is no bone.",
            ),
            (
                lambda b: b & ~ndimage.binary_opening(b),
                "Opening erodes and grows again, so hardly a pixel is lost: erode only.",
            ),
            (lambda b: ndimage.binary_closing(b) & ~b, "Closing fills bays, outside the bone: erode it instead."),
            (lambda b: ~ndimage.binary_erosion(b), "All the background is in it: keep what is bone and not inside."),
            (
                lambda b: ndimage.binary_dilation(b) & b,
                "A dilation grows: bone and its dilation is the bone itself. Which pixels does an erosion take away?",
            ),
            (
                lambda b: b & ~ndimage.binary_erosion(b, iterations=2),
                "This band is two pixels wide: one erosion is enough.",
            ),
            (lambda b: np.argwhere(_inner_edge(b)), "These are places; a mask of the image's shape is wanted."),
            (
                _without_frame,
                "The outermost rows and columns are left out: bone there is boundary, outside the image is none.",
            ),
            (
                lambda b: np.diff(b.astype(int), axis=0, prepend=0) != 0,
                "One axis only, and half of the edges outside the bone: look at all four neighbours.",
            ),
            (
                lambda b: np.gradient(b.astype(float))[0] != 0,
                "One axis only, and two pixels wide: look at all four neighbours.",
            ),
        ),
        hints=(
            "Which pixels does an erosion take away?",
            "ndimage.binary_erosion(bone) is the inside.",
            "Keep the bone that is not in its inside: `&` and `~`.",
        ),
        praise="one pixel wide, all of it bone.",
    ),
    "3.2": Exercise(
        cases=_clouds,
        right=_line,
        answer=Answer(
            "one direction: two numbers (row, col)",
            unit="degrees",
            tolerance=0.5,
            error=degrees_apart,
            shows=(lambda d: np.degrees(np.arctan2(d[1], d[0])) % 180, "degrees (0: along a column, 90: along a row)"),
        ),
        mistakes=(
            (_by_slope, "A slope of col over row fails for points along a row: no such line stands upright."),
            (
                _by_slope_of_rows,
                "A slope of row over col fails for points along a column: no such line stands upright.",
            ),
            (
                lambda p: np.linalg.svd(p)[2][0],
                "The points are not centred: this looks from 0, 0 to them. Subtract the mean.",
            ),
            (lambda p: _parts(p)[2][1], "This is the normal, the direction of least spread."),
            (lambda p: _line(p)[::-1], "Row and column are swapped."),
            (
                lambda p: p[1] - p[0],
                "Two pixels are too few: the stairs of the boundary turn the line. Fit all points.",
            ),
            (
                lambda p: p[-1] - p[0],
                "From the first point to the last: the noise of these two turns the line. Fit all points.",
            ),
            *(
                (
                    lambda p, at=at: np.linalg.svd(p - p[at])[2][0],
                    "One point was taken for the centre, and it may be off: subtract the mean of all.",
                )
                for at in (0, -1)
            ),
            *(
                (
                    lambda p, parts=parts: p[-(len(p) // parts) :].mean(axis=0) - p[: len(p) // parts].mean(axis=0),
                    "Two means joined: that rests on where the noise falls in each part. Fit all points at once.",
                )
                for parts in (2, 3, 4)
            ),
            (
                lambda p: p[len(p) // 2 :].mean(axis=0) - p[0],
                "One end is a single point, and it may be off: fit all points at once.",
            ),
            (
                lambda p: np.linalg.svd((p - p.mean(axis=0)) / p.std(axis=0))[2][0],
                "Divided by the spread of rows and of columns the cloud has another shape: subtract the mean only.",
            ),
            (
                _by_better_slope,
                "The better of two np.polyfit measures along one axis all the same, and leans: use the SVD.",
            ),
            (
                lambda p: np.linalg.svd(p - p.mean())[2][0],
                "p.mean() is one number for rows and columns together: the centre is p.mean(axis=0).",
            ),
            (
                lambda p: np.linalg.svd(p - p.mean(axis=1, keepdims=True))[2][0],
                "This centres each point by itself: the centre is the mean of all, axis=0.",
            ),
            (
                lambda p: _parts(p)[2][:, 0],
                "Directions are the rows of the third array, not its columns: [2][0]. (Or one sign is turned.)",
            ),
            (lambda p: abs(_line(p)), "The signs are lost: a line that falls looks like one that rises."),
            (
                lambda p: np.linalg.eig(np.cov(p.T))[1][:, 0],
                "np.linalg.eig does not sort: take the direction of the largest value, or np.linalg.eigh's last.",
            ),
            (lambda p: _parts(p)[0][0], "The first array has a row for each point; directions are rows of the third."),
            (lambda p: _parts(p)[1], "The second array says how far the points spread; the third has the directions."),
            (lambda p: _parts(p)[2], "These are both directions; return the one of largest spread."),
            (
                lambda p: np.ptp(p, axis=0),
                "Height and width of the cloud have no sign, and rest on its outermost points. Fit all points.",
            ),
            (
                lambda p: np.median(np.diff(p, axis=0), axis=0),
                "From point to point the noise is as long as the step. Fit all points at once.",
            ),
            (
                lambda p: p.std(axis=0),
                "The spreads of rows and columns have no sign: a line that falls looks like one that rises.",
            ),
        ),
        hints=(
            "Centre the points first.",
            "The SVD gives the direction of largest spread.",
            "np.linalg.svd gives three arrays; the rows of the third are directions, the one of largest spread first.",
        ),
        praise="a tangent in any direction, upright too.",
    ),
    "3.3": Exercise(
        cases=_spines,
        right=_arc_length,
        answer=Answer("one number for each point, starting with 0", unit="px", tolerance=1e-6),
        mistakes=(
            (lambda p: np.arange(len(p)).astype(float), "This counts points; a diagonal step is 1.41 px long."),
            (
                lambda p: np.linalg.norm(p - p[0], axis=1),
                "This is the straight distance to the first point, not the way along the curve.",
            ),
            (
                lambda p: _arc_length(p[::-1]),
                "You count from the last point: the length is that from the first point on.",
            ),
            (
                lambda p: np.sqrt(np.append(0.0, np.cumsum((np.diff(p, axis=0) ** 2).sum(axis=1)))),
                "This is the root of the sum of all squares: take the root of each step, then add the steps up.",
            ),
            (
                lambda p: np.append(0.0, np.cumsum(np.abs(np.diff(p[:, 0])))),
                "Rows only: a step is the root of the sum of squares over rows and columns.",
            ),
            (
                lambda p: np.append(0.0, np.cumsum(np.linalg.norm(p - p[0], axis=1)[1:])),
                "These are distances from the first point, added up; add up the steps from point to point: np.diff.",
            ),
            (
                lambda p: np.append(0.0, np.cumsum(np.trunc(np.linalg.norm(np.diff(p, axis=0), axis=1)))),
                "The lengths were cut to whole numbers: was the array made of integers?",
            ),
            (lambda p: np.linalg.norm(p, axis=1), "These are distances from 0, 0; a step is the difference of two."),
            (
                lambda p: _arc_length(np.concatenate([p[:1] - (p[1] - p[0]), p]))[1:],
                "The first point has a length already: its arc length is 0, and no step leads to it.",
            ),
            (lambda p: _arc_length(p)[1:], "The first point is missing: its arc length is 0."),
            (
                lambda p: np.concatenate([[0.0], np.cumsum(np.abs(np.diff(p, axis=0)).sum(axis=1))]),
                "This adds rows and columns; a step is the root of the sum of squares.",
            ),
            (
                lambda p: np.diff(_arc_length(p)),
                "These are the lengths of the steps: add them up, and put a 0 in front.",
            ),
            (
                lambda p: np.append(0.0, np.diff(_arc_length(p))),
                "These are the lengths of the steps, not yet added up: np.cumsum.",
            ),
            (
                lambda p: _arc_length(p)[-1],
                "This is the whole length; wanted is the length up to each point: np.cumsum, not sum.",
            ),
            (
                lambda p: np.append(0.0, np.cumsum((np.diff(p, axis=0) ** 2).sum(axis=1))),
                "The root is missing: a step is the root of the sum of squares.",
            ),
            (
                lambda p: np.append(_arc_length(p)[1:], _arc_length(p)[-1]),
                "The 0 belongs in front, for the first point; the last length is there once.",
            ),
            (lambda p: np.linspace(0, _arc_length(p)[-1], len(p)), "Not all steps are equally long: add up each one."),
            (lambda p: np.append(_arc_length(p)[1:], 0.0), "The 0 stands in front, for the first point."),
            (lambda p: np.append(_arc_length(p)[:-1], 0.0), "The last length is lost: one 0 is wanted, in front."),
            (
                lambda p: np.append(1.0, _arc_length(p)[1:]),
                "The first point lies at length 0: put a 0 in front.",
            ),
            (
                lambda p: np.cumsum(np.linalg.norm(np.diff(p, axis=0, prepend=0.0), axis=1)),
                "prepend=0 counts the way from 0, 0 to the first point as a step: put the 0 before the lengths.",
            ),
            (
                lambda p: np.append(0.0, np.cumsum(np.diff(p, axis=0).sum(axis=1))),
                "This adds rows and columns with their signs; a step is the root of the sum of squares.",
            ),
            (
                lambda p: np.cumsum(np.linalg.norm(np.gradient(p, axis=0), axis=1)),
                "np.gradient takes means of two steps; np.diff gives the steps.",
            ),
            *(
                (
                    lambda p, by=by: np.cumsum(np.linalg.norm(p - np.roll(p, by, axis=0), axis=1)),
                    "np.roll adds the way from the last point back to the first.",
                )
                for by in (1, -1)
            ),
            *(
                (way, "Which axis? Points stand below each other: np.diff along axis=0, the norm along axis=1.")
                for way in (
                    lambda p: np.append(0.0, np.cumsum(np.linalg.norm(np.diff(p), axis=1))),
                    lambda p: np.append(0.0, np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=0))),
                    lambda p: np.append(0.0, np.cumsum(np.linalg.norm(np.diff(p, axis=0)))),
                )
            ),
            (
                lambda p: _arc_length(p) / _arc_length(p)[-1],
                "This is the part of the whole way, 0 to 1; wanted is its length.",
            ),
            (
                lambda p: np.cumsum(np.linalg.norm(p, axis=1)),
                "These are distances from 0, 0; a step is the difference of neighbours: np.diff.",
            ),
            (lambda p: np.linalg.norm(p - p[0]), "One number for all: take the norm along axis=1, and of the steps."),
            (
                lambda p: np.cumsum(np.abs(np.diff(p, axis=0)).max(axis=1)),
                "This takes the longer side of each step, and no 0 in front: a step is the root of the sum of squares.",
            ),
            (
                lambda p: np.append(0.0, np.cumsum(np.abs(np.diff(p, axis=0)).max(axis=1))),
                "This takes the longer side of each step; a step is the root of the sum of squares.",
            ),
            (lambda p: np.arange(len(p)) * np.sqrt(2), "Not every step is a diagonal: take the length of each."),
        ),
        hints=(
            "np.diff gives the steps.",
            "Lengths of the steps, then np.cumsum.",
            "Put a 0 in front: np.concatenate([[0.0], ...])",
        ),
        praise="the way along the bone, not through the air.",
    ),
}
"""The exercises of lesson 03, by number."""
