"""Exercises of lesson 01: grey windows, places of voxels, distances between slices."""

from __future__ import annotations

import numpy as np

from .task import Answer, Exercise, small_head


def _grey(hu, centre, width):
    return np.clip((hu - (centre - width / 2)) / width, 0, 1) * 255


def _wrapped(hu, centre, width):
    """Grey levels that were not clipped before they became uint8."""
    return np.trunc((hu - (centre - width / 2)) / width * 255) % 256


def _slices():
    hu = np.asarray(small_head().hu, float)[19]
    return [(hu, 40.0, 80.0), (hu, 300.0, 2000.0), (hu, 600.0, 800.0)]


def _places():
    affine = np.array([[0.0, 0.2, 0.9, -104.0], [0.0, 0.88, -0.2, -141.0], [2.5, 0, 0, -862.0], [0, 0, 0, 1]])
    return [(affine, np.array(i, float)) for i in ([0, 0, 0], [10, 20, 30], [3, 100, 7])]


def _positions():
    tilt = np.radians(15.0)
    normal = np.array([0.0, -np.sin(tilt), np.cos(tilt)])
    upright = np.array([[0.0, 0.0, 2.5 * k] for k in range(6)])
    shuffled = np.array([[-100.0, -140.0, 2.5 * k - 860.0] for k in (5, 0, 6, 1, 4, 2)])  # slice 3 is missing
    leaning = np.array([[0.0, 0.0, 2.5 * k / np.cos(tilt)] for k in range(6)])
    return [(upright, np.array([0.0, 0.0, 1.0])), (shuffled, np.array([0.0, 0.0, 1.0])), (leaning, normal)]


def _step(positions, normal):
    return float(np.median(np.diff(np.sort(positions @ normal))))


EXERCISES: dict[str, Exercise] = {
    "1.1": Exercise(
        cases=_slices,
        right=_grey,
        answer=Answer("an array like the slice, 0 to 255", unit="grey levels", tolerance=1.0),
        mistakes=(
            (lambda h, c, w: (h - (c - w / 2)) / w * 255, "Values outside the window leave 0 to 255: clip them."),
            (lambda h, c, w: np.clip((h - c) / w, 0, 1) * 255, "The window starts at centre - width / 2."),
            (lambda h, c, w: np.clip((h - c + w / 2) / w, 0, 1), "This runs from 0 to 1; grey runs from 0 to 255."),
            (lambda h, c, w: 255 - _grey(h, c, w), "Black and white are swapped: bone should be bright."),
            (_wrapped, "uint8 starts again at 0 after 255: clip first, then change the type."),
            (
                lambda h, c, w: _grey(h, c, 2 * w),
                "This window is twice too wide: it reaches width / 2 to each side of the centre.",
            ),
        ),
        hints=(
            "Where is 0? At centre - width / 2.",
            "Scale to 0..1 and use np.clip.",
            "np.clip((hu - low) / width, 0, 1) * 255",
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
            (
                lambda a, i: (np.linalg.norm(a[:3, :3], axis=0) * i)[::-1] + a[:3, 3],
                "Spacing alone is not enough: these rows and columns are turned, and only the matrix knows.",
            ),
        ),
        hints=(
            "A point is the origin plus steps.",
            "Columns of affine[:3, :3] are steps.",
            "affine[:3, :3] @ index + affine[:3, 3]",
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
        ),
        hints=(
            "The height of a slice is positions @ normal.",
            "Sort, then np.diff.",
            "np.median(np.diff(np.sort(positions @ normal)))",
        ),
        praise="the distance between slices comes from their places.",
    ),
}
"""The exercises of lesson 01, by number."""
