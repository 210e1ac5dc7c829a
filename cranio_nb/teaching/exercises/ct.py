"""Exercises of lessons 00 to 02: the scan, its geometry, its bone."""

from __future__ import annotations

from functools import partial

import numpy as np
from scipy import ndimage

from .task import Exercise, different_pixels, largest_difference, small_head


def _patches():
    head = small_head()
    return [(head.implant, (3.0, 1.75, 1.75)), (head.implant[:22], (3.0, 1.75, 1.5)), (head.implant, (1.0, 0.5, 0.8))]


def _pairs():
    patch = small_head().implant
    return [(patch, np.roll(patch, 1, 2)), (patch, patch), (patch, patch & (np.arange(44) < 20)[:, None, None])]


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


def _largest(mask):
    labels, _ = ndimage.label(mask)
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    return labels == sizes.argmax()


def _largest_over_corners(mask):
    labels, _ = ndimage.label(mask, np.ones((3, 3, 3)))
    return labels == np.bincount(labels.ravel())[1:].argmax() + 1


def _largest_shifted(mask):
    labels, _ = ndimage.label(mask)
    return labels == np.bincount(labels.ravel())[1:].argmax()


def _largest_of_slices(mask):
    return np.array([_largest(plane) for plane in mask])


def _largest_of_slices_with_bone(mask):
    return _largest_of_slices(mask) & mask


def _parts():
    bone = small_head().bone
    couch = bone.copy()
    couch[2:12, 120:123, 20:40] = True
    early = bone.copy()
    early[0:1, 1:5, 1:5] = True
    blocks = np.zeros((6, 20, 20), bool)
    blocks[1:5, 2:8, 2:8] = blocks[1:5, 8:12, 8:12] = True  # they share an edge only
    blocks[5, 15:18, 15:18] = True  # alone in its slice
    return [(couch,), (early,), (blocks,)]


def _bool_pixels(answer, right):
    """Number of pixels in which two masks differ; what is not bool is no mask."""
    return different_pixels(answer, right) if np.asarray(answer).dtype == bool else np.inf


_FOUR = (np.s_[0], np.s_[-1], np.s_[:, 0], np.s_[:, -1])  # first, last row; first, last column
_SOME = ((0, 1), (2, 3), (0, 2), (1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2))  # borders that students look at


def _holes(mask, max_pixels, *, borders=(0, 1, 2, 3), structure=None, shift=0):
    """Parts of the background of at most max_pixels that touch none of the borders; `shift` mixes up their sizes."""
    labels, n = ndimage.label(~mask, structure)
    sizes = np.bincount(labels.ravel(), minlength=n + 1)
    small = np.roll(sizes, -shift) <= max_pixels
    for border in borders:
        small[labels[_FOUR[border]]] = False
    small[0] = False
    return small[labels]


def _fill_small(mask, max_pixels, **how):
    return mask | _holes(mask, max_pixels, **how)


def _rings():
    row, col = np.indices((80, 80)) - 40
    ring = (np.hypot(row, col) < 30) & (np.hypot(row, col) > 22)
    spotted, corners, pockets = ring.copy(), ring.copy(), ring.copy()
    spotted[14, 38:42] = spotted[40, 64:67] = False
    corners[12:16, 38:43] = False  # 20 pixels
    corners[34:40, 64:66] = corners[40:46, 66:68] = False  # 12 each, and they share a corner only
    pockets[14, 38:42] = False
    for border in (np.s_[:4, 37:43], np.s_[-4:, 37:43], np.s_[37:43, :4], np.s_[37:43, -4:]):
        pockets[border] = True
    for border in (np.s_[:2, 39:41], np.s_[-2:, 39:41], np.s_[39:41, :2], np.s_[39:41, -2:]):
        pockets[border] = False
    return [(spotted, 8), (corners, 20), (pockets, 20)]


_CUBES = "The three spacings are not equal: use each of them once."
_BORDERS = "What touches any of the four borders is outside: first and last row, first and last column."

IMAGE = {
    "0.1": Exercise(
        _patches,
        lambda mask, spacing: mask.sum() * np.prod(spacing) / 1000,
        largest_difference,
        "cm3",
        0.01,
        "one number",
        (
            (lambda m, s: m.sum(), "This counts voxels. Each voxel has a volume: the product of its three spacings."),
            (lambda m, s: m.sum() * np.prod(s), "This is in mm3; 1 cm3 is 1000 mm3."),
            (lambda m, s: m.sum() * s[1] * s[2] / 1000, "This is an area: the distance between slices is left out."),
            (lambda m, s: m.size * np.prod(s) / 1000, "This counts all voxels; mask.sum() counts those that are True."),
            *(
                (lambda m, s, to=to: m.sum() * np.prod(s) / to, "1 cm is 10 mm, so 1 cm3 is 10 x 10 x 10 = 1000 mm3.")
                for to in (10, 100)
            ),
            *(
                (lambda m, s, three=three: m.sum() * np.prod(np.take(s, three)) / 1000, _CUBES)
                for three in ((0, 0, 0), (1, 1, 1), (2, 2, 2), (0, 1, 1), (0, 2, 2), (0, 0, 1))
            ),
        ),
        ("Count the voxels first.", "Multiply by the volume of one voxel.", "mask.sum() * np.prod(spacing) / 1000"),
        "voxels became cubic centimetres.",
    ),
    "0.2": Exercise(
        _pairs,
        lambda a, b: 2 * (a & b).sum() / (a.sum() + b.sum()),
        largest_difference,
        "",
        1e-6,
        "one number from 0 to 1",
        (
            (lambda a, b: (a & b).sum() / (a | b).sum(), "This is Jaccard's index: it divides by the union."),
            (
                lambda a, b: 2 * (a & b).sum() / (a + b).sum(),
                "For bool masks a + b means a | b, so what is shared counts once: use a.sum() + b.sum().",
            ),
            (lambda a, b: (a & b).sum() / (a.sum() + b.sum()), "The factor 2 is missing: two equal masks must give 1."),
            (lambda a, b: (a & b).sum() / b.sum(), "This is the part of b that is found; Dice divides by both sizes."),
            (lambda a, b: (a == b).mean(), "This counts the air as agreement; use only voxels of the masks."),
        ),
        ("What is shared: a & b.", "Divide by the sum of both sizes.", "2 * (a & b).sum() / (a.sum() + b.sum())"),
        "two equal masks give 1, two strangers 0.",
    ),
    "1.1": Exercise(
        _slices,
        _grey,
        largest_difference,
        "grey levels",
        1.0,
        "an array like the slice, 0 to 255",
        (
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
        (
            "Where is 0? At centre - width / 2.",
            "Scale to 0..1 and use np.clip.",
            "np.clip((hu - low) / width, 0, 1) * 255",
        ),
        "the window shows what it should.",
    ),
    "1.2": Exercise(
        _places,
        lambda affine, index: affine[:3, :3] @ index + affine[:3, 3],
        largest_difference,
        "mm",
        1e-6,
        "three numbers x, y, z",
        (
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
        (
            "A point is the origin plus steps.",
            "Columns of affine[:3, :3] are steps.",
            "affine[:3, :3] @ index + affine[:3, 3]",
        ),
        "every voxel knows its place in the patient.",
    ),
    "1.3": Exercise(
        _positions,
        _step,
        largest_difference,
        "mm",
        1e-6,
        "one number",
        (
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
        (
            "The height of a slice is positions @ normal.",
            "Sort, then np.diff.",
            "np.median(np.diff(np.sort(positions @ normal)))",
        ),
        "the distance between slices comes from their places.",
    ),
    "2.1": Exercise(
        _parts,
        _largest,
        _bool_pixels,
        "voxels",
        0.0,
        "a bool mask like the one given",
        (
            (lambda m: ndimage.label(m)[0] == 1, "Label 1 is the part that is met first, not the largest."),
            (
                lambda m: ndimage.label(m)[0] == np.bincount(ndimage.label(m)[0].ravel()).argmax(),
                "The largest label is 0, the background: leave it out of the count.",
            ),
            (_largest_shifted, "bincount(...)[1:] begins with part 1: add 1 to its argmax."),
            *(
                (way, "This takes the largest part of each slice: label the whole mask once.")
                for way in (_largest_of_slices, _largest_of_slices_with_bone)
            ),
            (_largest_over_corners, "Voxels that share only an edge or a corner are not connected here."),
            (lambda m: m, "Nothing was dropped."),
            (lambda m: ndimage.binary_opening(m), "Opening eats thin bone; label the parts and choose one."),
        ),
        (
            "ndimage.label numbers the parts.",
            "np.bincount(labels.ravel()) counts them; 0 is background.",
            "Set sizes[0] = 0, then labels == sizes.argmax()",
        ),
        "the couch is gone, the skull is whole.",
    ),
    "2.2": Exercise(
        _rings,
        _fill_small,
        _bool_pixels,
        "pixels",
        0.0,
        "a bool mask like the one given",
        (
            (lambda m, a: ndimage.binary_fill_holes(m), "This fills the brain's place as well: fill only small holes."),
            (lambda m, a: m, "No hole was filled."),
            (
                partial(_fill_small, borders=()),
                "What touches the border is outside, not a hole, however small it is.",
            ),
            *((partial(_fill_small, borders=some), _BORDERS) for some in _SOME),
            (
                partial(_fill_small, structure=np.ones((3, 3))),
                "Holes that share only a corner are two holes: label the background with 4 neighbours.",
            ),
            (lambda m, a: _fill_small(m, a - 1), "A hole of just max_pixels is filled as well: at most means <=."),
            (
                partial(_fill_small, shift=1),
                "bincount(...)[1:] begins with label 1: each size went to the label before.",
            ),
            (_holes, "These are the holes alone: return the bone with them, mask | holes."),
            (
                lambda m, a: ndimage.binary_closing(m, iterations=3),
                "Closing also fills bays of the outline; label the holes.",
            ),
        ),
        (
            "Holes are parts of ~mask: label them.",
            "A hole has at most max_pixels and does not touch the border.",
            "Switch off the labels found in the first and last row and column.",
        ),
        "the diploe is closed and the brain has room.",
    ),
}
"""Lessons 00 to 02."""
