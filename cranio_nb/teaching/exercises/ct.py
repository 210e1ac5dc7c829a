"""Exercises of lesson 01: grey windows, places of voxels, distances between slices."""

from __future__ import annotations

from functools import partial

import numpy as np

from .task import Answer, Exercise, small_head


def _grey(hu, centre, width):
    return np.clip((hu - (centre - width / 2)) / width, 0, 1) * 255


def _wrapped(hu, centre, width):
    """Grey levels that were not clipped before they became uint8."""
    return np.trunc((hu - (centre - width / 2)) / width * 255) % 256


def _stretched(hu, centre, width):
    """Clipped to the window, then scaled by the ends of what is there."""
    cut = np.clip(hu, centre - width / 2, centre + width / 2)
    return (cut - cut.min()) / np.ptp(cut) * 255


def _grey_error(answer, right):
    """Largest difference in grey levels; black and white can be met exactly, and count a little more.

    Whole greys may be off by 1, whichever way they were made whole; others by a hundredth, which float32 keeps.
    """
    grey = np.asarray(answer, float)
    if grey.shape != right.shape:
        return float("inf")
    weight = np.where(np.isin(right, (0, 255)), 1.001, 1) * (1 if np.all(grey == np.rint(grey)) else 100)
    return float((np.abs(grey - right) * weight).max())


def _outside(hu, centre, width, *, below, above, ends):
    """The window with other greys outside of it, or at its ends as well."""
    low, high = centre - width / 2, centre + width / 2
    under, over = (hu <= low, hu >= high) if ends else (hu < low, hu > high)
    return np.where(under, below, np.where(over, above, _grey(hu, centre, width)))


def _slices():
    hu = np.asarray(small_head().hu, float)[19]
    return [(hu, 40.0, 80.0), (hu, 300.0, 2000.0), (hu, 610.0, 75.0)]  # the last one odd


def _places():
    affine = np.array([[0.0, 0.2, 0.9, -104.0], [0.0, 0.88, -0.2, -141.0], [2.5, 0, 0, -862.0], [0, 0, 0, 1]])
    return [(affine, np.array(i, float)) for i in ([0, 0, 0], [10, 20, 30], [3, 100, 7])]


def _positions():
    normal = np.array([-0.9, 0.3, -np.sqrt(0.1)])
    couch = np.array([-1.0, 0.5, 0.0])  # all slices at one z; y rises while x falls
    upright = np.array([[0.0, 0.0, 3.0 * k - 7.5] for k in range(6)])  # to both sides of 0
    # slice 3 is missing, and one lies too close to slice 6; the two steps in the middle differ, so the median is theirs
    shuffled = np.array([[-100.0, -140.0, 2.5 * k - 860.0] for k in (5, -0.2, 6, 1, 6.5, 4, 2.1)])
    leaning = np.array([1.25 * k * couch / (couch @ normal) for k in (3, 0, 5, 1, 4, 2)])
    return [(upright, np.array([0.0, 0.0, 1.0])), (shuffled, np.array([0.0, 0.0, 1.0])), (leaning, normal)]


def _by_z(positions):
    return positions[np.argsort(positions[:, 2], kind="stable")]


def _step(positions, normal):
    return float(np.median(np.diff(np.sort(positions @ normal))))


_SPACINGS = "Spacings alone do not say which axis is which, nor how rows and columns are turned: use the matrix."


EXERCISES: dict[str, Exercise] = {
    "1.1": Exercise(
        cases=_slices,
        right=_grey,
        answer=Answer("an array like the slice, 0 to 255", unit="grey levels", tolerance=1.0, error=_grey_error),
        mistakes=(
            (lambda h, c, w: (h - (c - w / 2)) / w * 255, "Values outside the window leave 0 to 255: clip them."),
            (lambda h, c, w: np.clip((h - c) / w, 0, 1) * 255, "The window starts at centre - width / 2."),
            (lambda h, c, w: np.clip((h - c + w / 2) / w, 0, 1), "This runs from 0 to 1; grey runs from 0 to 255."),
            (lambda h, c, w: 255 - _grey(h, c, w), "Black and white are swapped: bone should be bright."),
            *(
                (
                    partial(_outside, below=0, above=0, ends=ends),
                    "Above the window is white, 255, not black. (As uint8 256 becomes 0: multiply by 255.)",
                )
                for ends in (False, True)
            ),
            *(
                (partial(_outside, below=255, above=above, ends=ends), "Below the window is black, 0, not white.")
                for above in (0, 255)
                for ends in (False, True)
            ),
            *(
                (
                    lambda h, c, w, clip=clip: clip((h - c + w / 2) / w * 255),
                    "Only one end is clipped: below the window is 0, and above it 255.",
                )
                for clip in (lambda grey: np.minimum(grey, 255), lambda grey: np.maximum(grey, 0))
            ),
            (
                lambda h, c, w: np.clip((h - c + w / 2) / w, 0, 1) * 256,
                "0 to 255 are 256 greys, but the largest is 255: multiply by 255, not by 256.",
            ),
            (
                lambda h, c, w: np.clip((h - c + w / 2) // w, 0, 1) * 255,
                "`//` cuts to whole numbers, and no grey is left: divide by `/`.",
            ),
            (
                lambda h, c, w: np.clip((h - c + w / 2) / w * 256, 0, 255),
                "Multiply by 255: by 256 white is reached before the high end of the window.",
            ),
            (lambda h, c, w: _grey(h, w, c), "centre and width are exchanged."),
            (
                lambda h, c, w: np.clip((h - (c - w // 2)) / w, 0, 1) * 255,
                "`//` cuts to whole numbers: half of an odd width is no whole one, divide by `/`.",
            ),
            (_wrapped, "uint8 starts again at 0 after 255: clip first, then change the type."),
            (
                lambda h, c, w: _grey(h, c, 2 * w),
                "This window is twice too wide: it reaches width / 2 to each side of the centre.",
            ),
            (
                lambda h, c, w: np.clip((h - c + w) / w, 0, 1) * 255,
                "The window starts at centre - width / 2, not at centre - width.",
            ),
            (
                lambda h, c, w: np.clip((h - c + w / 2) / (w / 2), 0, 1) * 255,
                "The window is width wide, from low to high: divide by width, not by width / 2.",
            ),
            (lambda h, c, w: np.clip(h, c - w / 2, c + w / 2), "These are still HU, clipped; scale them to 0 to 255."),
            (
                lambda h, c, w: np.clip(h - c + w / 2, 0, 255),
                "Divide by width: at the high end the window has come to 255.",
            ),
            (_stretched, "This stretches what the slice holds of the window: take its ends from centre and width."),
            (
                lambda h, c, w: np.clip(h - (c - w / 2) / w, 0, 1) * 255,
                "`/` goes before `-`: put hu - low in brackets.",
            ),
            (
                lambda h, c, w: np.clip((h - (c - w) / 2) / w, 0, 1) * 255,
                "`-` in brackets goes before `/`: the window starts at centre - width / 2, not (centre - width) / 2.",
            ),
            (
                lambda h, c, w: (h - h.min()) / np.ptp(h) * 255,
                "This stretches the whole range of the slice; the window is chosen by centre and width.",
            ),
            (
                lambda h, c, w: (h > c) * 255,
                "This is black and white only: between the ends of the window grey rises evenly.",
            ),
            (
                lambda h, c, w: np.clip((h - c - w / 2) / w, 0, 1) * 255,
                "The window starts at centre - width / 2, not at centre + width / 2.",
            ),
            (
                lambda h, c, w: np.clip((h - c + w / 2) * 255, 0, 255),
                "Divide by width: at the high end the window has come to 255.",
            ),
        ),
        hints=(
            "Where is 0? At centre - width / 2.",
            "Scale to 0..1 and use np.clip.",
            "np.clip(x, 0, 1) cuts off: what must x be at the low end of the window, and what at its high end?",
        ),
        praise="the window shows what it should.",
    ),
    "1.2": Exercise(
        cases=_places,
        right=lambda affine, index: affine[:3, :3] @ index + affine[:3, 3],
        answer=Answer("three numbers x, y, z", unit="mm", tolerance=1e-6),
        mistakes=(
            (lambda a, i: a[:3, :3] @ i, "The origin is missing: voxel (0, 0, 0) does not lie at 0, 0, 0 mm."),
            (
                lambda a, i: a[:3, :3] @ i[::-1] + a[:3, 3],
                "The index goes in as (plane, row, col); do not turn it round.",
            ),
            (lambda a, i: a[:3, :3].T @ i + a[:3, 3], "The matrix is transposed: its columns are the steps in mm."),
            *(
                (lambda a, i, way=way: way(a[:3, :3], i) + a[:3, 3], _SPACINGS)
                for way in (
                    lambda m, i: (np.linalg.norm(m, axis=0) * i)[::-1],
                    lambda m, i: np.linalg.norm(m, axis=0) * i,
                    lambda m, i: np.linalg.norm(m, axis=1) * i[::-1],
                    lambda m, i: np.linalg.norm(m, axis=1) * i,
                    lambda m, i: np.round(np.linalg.norm(m, axis=0), 1) * i,
                    lambda m, i: np.diag(m) * i,
                    lambda m, i: np.abs(m).max(axis=0) * i,
                    lambda m, i: m.sum(axis=0) * i,
                    lambda m, i: np.array([m[0, 2] * i[2], m[1, 1] * i[1], m[2, 0] * i[0]]),
                )
            ),
            *(
                (
                    lambda a, i, way=way: way(a, i),
                    "The inverse leads back, from mm to the index: use the matrix itself.",
                )
                for way in (
                    lambda a, i: np.linalg.inv(a)[:3, :3] @ i + a[:3, 3],
                    lambda a, i: np.linalg.inv(a[:3, :3]) @ (i - a[:3, 3]),
                    lambda a, i: (np.linalg.inv(a) @ np.append(i, 1))[:3],
                )
            ),
            (lambda a, i: (a @ np.append(1, i))[:3], "The 1 stands behind the index, as the origin stands last."),
            *(
                (lambda a, i, way=way: way(a, i), "The matrix is transposed: its columns are the steps in mm.")
                for way in (lambda a, i: (np.append(i, 1) @ a)[:3], lambda a, i: i @ a[:3, :3] + a[3, :3])
            ),
            (lambda a, i: a[:3, :3] @ i * a[:3, 3], "The origin is added to the steps, not multiplied by them."),
            (
                lambda a, i: a @ np.append(i, 1),
                "Four numbers: the last is the 1 that was added to the index; leave it out.",
            ),
            (lambda a, i: a[:3, :3] @ (i + a[:3, 3]), "First the steps, then the origin: it is in mm already."),
            (lambda a, i: a[:3, :3] * i + a[:3, 3], "`*` multiplies number by number; a matrix times a vector is `@`."),
            (lambda a, i: a[:3, :3] @ i - a[:3, 3], "The origin is added, not taken away."),
            (
                lambda a, i: (a[:3, :3] @ i + a[:3, 3]) * (-1, -1, 1),
                "x and y have their signs turned: the matrix gives x to the left and y to the back already.",
            ),
            (lambda a, i: a[:3, 3], "This is the place of voxel (0, 0, 0): add the steps of the index."),
            (lambda a, i: i + a[:3, 3], "These are still voxels, moved: a step has a length and a direction in mm."),
            (lambda a, i: a[:3, :3] @ (i + 0.5) + a[:3, 3], "Half a voxel off: an index is the centre of its voxel."),
            (
                lambda a, i: (a[:3, :3] @ i + a[:3, 3])[::-1],
                "These are z, y, x: the matrix gives x, y, z already, do not turn them round.",
            ),
        ),
        hints=(
            "A point is the origin plus steps.",
            "Columns of affine[:3, :3] are steps.",
            "`@` adds up the steps of an index; the origin is the fourth column.",
        ),
        praise="every voxel knows its place in the patient.",
    ),
    "1.3": Exercise(
        cases=_positions,
        right=_step,
        answer=Answer("one number", unit="mm", tolerance=1e-6),
        mistakes=(
            (
                lambda p, n: p[1, 2] - p[0, 2],
                "Files come in any order: sort the heights first. And a tilted stack leans.",
            ),
            (
                lambda p, n: float(np.median(np.diff(np.sort(p[:, 2])))),
                "z is not the height of a tilted slice: project the positions on the normal.",
            ),
            *(
                (lambda p, n, f=f: np.median(f(np.diff(p @ n))), "Files come in any order: sort the heights first.")
                for f in (np.positive, np.abs)
            ),
            (lambda p, n: np.median(abs(np.diff(p[:, 2]))), "Files come in any order: sort the heights first."),
            (
                lambda p, n: np.mean(np.diff(np.sort(p @ n))),
                "A slice may be missing: its gap pulls the mean up, but not the median.",
            ),
            (
                lambda p, n: np.diff(np.sort(p @ n)).min(),
                "This is the smallest step, and one slice lies too close: take the median.",
            ),
            *(
                (
                    lambda p, n, at=at: np.sort(np.diff(np.sort(p @ n)))[at(len(p) - 1)],
                    "Of an even number of steps the median is the mean of the two in the middle: np.median.",
                )
                for at in (lambda steps: steps // 2, lambda steps: (steps - 1) // 2)
            ),
            (
                lambda p, n: np.median(abs(np.subtract.outer(p @ n, p @ n))[np.triu_indices(len(p), 1)]),
                "These are the ways between all pairs; wanted are those between neighbours: np.diff of sorted heights.",
            ),
            (
                lambda p, n: np.diff(np.sort(p @ n)).max(),
                "This is the largest step, and a slice is missing there: take the median.",
            ),
            (
                lambda p, n: np.diff(np.sort(p @ n))[0],
                "This is the first step only, and one slice may be out of place: take the median of all.",
            ),
            (lambda p, n: np.diff(np.sort(p @ n)), "These are all the steps: one number is wanted, their median."),
            (
                lambda p, n: np.median(p @ n),
                "This is the median height; wanted are the differences between neighbours.",
            ),
            (
                lambda p, n: np.ptp(p @ n) / len(p),
                "n slices have n - 1 steps between them, and a mean pays for each odd one.",
            ),
            (
                lambda p, n: np.median(np.linalg.norm(np.diff(p, axis=0), axis=1)),
                "Files come in any order: sort the heights first.",
            ),
            *(
                (
                    lambda p, n, f=f: np.median(f(np.diff(np.sort(p, axis=0) @ n))),
                    "This sorts x, y and z each by itself, or drops signs of the normal: sort positions @ normal.",
                )
                for f in (np.positive, np.abs)
            ),
            *(
                (
                    lambda p, n, way=way: np.median(way(np.diff(_by_z(p), axis=0), n)),
                    "Slices that stand upright may all have one z: sort the heights, positions @ normal.",
                )
                for way in (np.matmul, lambda d, n: abs(d @ n), lambda d, n: np.linalg.norm(d, axis=1))
            ),
            (
                lambda p, n: np.median(np.diff(np.array(sorted(p.tolist())) @ n)),
                "This sorts by x first, and the height may fall while x rises: sort the heights.",
            ),
            *(
                (
                    lambda p, n, again=again: np.median(np.diff(again(np.sort(p) @ n))),
                    "This sorts x, y and z of a position among themselves: sort the heights, positions @ normal.",
                )
                for again in (np.positive, np.sort)
            ),
            (
                lambda p, n: np.median(np.linalg.norm(np.diff(p[np.argsort(p @ n)], axis=0), axis=1)),
                "This is the way from slice to slice, longer where the stack leans: project it on the normal.",
            ),
            *(
                (
                    lambda p, n, power=power: np.median(np.diff(np.sort(p[:, 2]))) * n[2] ** power,
                    "z is not the height of a tilted slice: project the positions on the normal.",
                )
                for power in (1, -1)
            ),
            (
                lambda p, n: _step(p, n) / n[2],
                "The heights are along the normal already: nothing is to be divided by its z.",
            ),
            (
                lambda p, n: np.median(np.diff(np.sort(abs(p @ n)))),
                "A height has a sign: without it slices above and below 0 fall on each other.",
            ),
            (lambda p, n: np.mean(p @ n), "This is the mean height; wanted are the differences between neighbours."),
            *(
                (
                    lambda p, n, axis=axis: np.median(np.diff(np.sort(p * n, axis=axis))),
                    "`*` multiplies number by number; one height for each slice comes from positions @ normal.",
                )
                for axis in (0, -1)
            ),
        ),
        hints=(
            "The height of a slice is positions @ normal.",
            "Sort, then np.diff.",
            "Sorted heights, their differences, the median of these.",
        ),
        praise="the distance between slices comes from their places.",
    ),
}
"""The exercises of lesson 01, by number."""
