"""Exercises of lesson 02: the largest part, small holes."""

from __future__ import annotations

from functools import partial

import numpy as np
from scipy import ndimage

from ...stages.segmentation import drop_artefacts
from .task import Answer, Exercise, different_bools, small_head


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


def _largest_but_last(mask):
    labels, n = ndimage.label(mask)
    return labels == np.bincount(labels.ravel())[1:n].argmax() + 1


def _second_largest(mask):
    labels, _ = ndimage.label(mask)
    return labels == np.bincount(labels.ravel())[1:].argsort()[-2] + 1


def _largest_of_all(mask, *, place=-1):
    """The background is counted as well."""
    labels, _ = ndimage.label(mask)
    return labels == np.bincount(labels.ravel()).argsort()[place]


def _largest_times_number(mask):
    labels, _ = ndimage.label(mask)
    sizes = np.bincount(labels.ravel())
    return labels == (sizes * np.arange(len(sizes))).argmax()


def _smallest(mask):
    labels, _ = ndimage.label(mask)
    return labels == np.bincount(labels.ravel())[1:].argmin() + 1


def _widest(mask):
    """The part with the largest box."""
    labels, _ = ndimage.label(mask)
    boxes = [np.prod([side.stop - side.start for side in box]) for box in ndimage.find_objects(labels)]
    return labels == np.argmax(boxes) + 1


def _parts():
    bone = small_head().bone[8:24]  # enough to see which part is large
    couch = bone.copy()
    couch[0, 116, 0] = True  # a speck, met after the bone and before the couch
    couch[:, 120:124, 8:120] = True  # more than a third of the bone
    early = bone.copy()
    early[0:1, 1:5, 1:5] = True
    blocks = np.zeros((9, 20, 18), bool)
    blocks[2:8, :, :14] = True  # more than the background
    blocks[4:6, 4:6, 4:6] = False  # a cavity in the largest: it stays empty
    blocks[0, 0, :] = blocks[0, :, 17] = blocks[:7, 19, 17] = True  # thin, in a larger box; alone in its slice
    blocks[8, 5:10, 14:16] = True  # shares an edge only with the largest; alone in its slice
    return [(couch,), (early,), (blocks,)]


_FOUR = (np.s_[0], np.s_[-1], np.s_[:, 0], np.s_[:, -1])  # first, last row; first, last column
_SOME = ((0, 1), (2, 3), (0, 2), (1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2))  # borders that students look at


def _holes(mask, max_pixels, *, borders=(0, 1, 2, 3), structure=None, shift=0, small=np.less_equal, lost=()):
    """Parts of the background of at most max_pixels that touch none of the borders.

    `shift` mixes up their sizes, `small` compares these, `lost` are numbers of parts that are passed over.
    """
    labels, n = ndimage.label(~mask, structure)
    sizes = np.bincount(labels.ravel(), minlength=n + 1)
    taken = small(np.roll(sizes, -shift), max_pixels)
    for border in borders:
        taken[labels[_FOUR[border]]] = False
    taken[[0, *lost]] = False
    return taken[labels]


def _fill_small(mask, max_pixels, **how):
    return mask | _holes(mask, max_pixels, **how)


def _border_or_small(mask, max_pixels, *, way):
    """Holes taken by their size and whether they touch a border, put together the wrong way."""
    labels, n = ndimage.label(~mask)
    small = np.bincount(labels.ravel(), minlength=n + 1) <= max_pixels
    at_border = np.isin(np.arange(n + 1), np.concatenate([labels[border] for border in _FOUR]))
    taken = way(small, at_border)
    taken[0] = False
    return mask | taken[labels]


def _small_of_filled(mask, max_pixels):
    """The holes that a filling finds, counted with all that is no hole."""
    labels, _ = ndimage.label(ndimage.binary_fill_holes(mask) & ~mask)
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    return mask | (sizes <= max_pixels)[labels]


def _large_holes(mask, max_pixels):
    labels, _ = ndimage.label(~mask)
    large = np.bincount(labels.ravel()) > max_pixels
    large[0] = False
    return mask | large[labels]


def _rings():
    row, col = np.indices((80, 80)) - 40
    ring = (np.hypot(row, col) < 30) & (np.hypot(row, col) > 22)
    spotted, corners, pockets = ring.copy(), ring.copy(), ring.copy()
    spotted[14, 38:42] = spotted[40, 64:67] = spotted[39:42, 14:17] = False  # 4, 3 and 9 pixels
    corners[:4] = True  # bone along a border, with a hole of 4 pixels that is met before all else
    corners[1:3, 5:7] = False
    corners[12:16, 38:43] = corners[36:43, 14:17] = False  # 20 and 21 pixels
    corners[34:40, 64:66] = corners[40:46, 66:68] = False  # 12 each, and they share a corner only
    pockets[14, 38:42] = pockets[36:43, 14:17] = False
    for border in (np.s_[:4, 37:43], np.s_[-4:, 37:43], np.s_[37:43, :4], np.s_[37:43, -4:]):
        pockets[border] = True
    for border in (np.s_[:2, 39:41], np.s_[-2:, 39:41], np.s_[39:41, :2], np.s_[39:41, -2:]):
        pockets[border] = False
    return [(spotted, 8), (corners, 20), (pockets, 20)]  # each with a hole of one pixel more than that


_BORDERS = "What touches any of the four borders is outside: first and last row, first and last column."


EXERCISES: dict[str, Exercise] = {
    "2.1": Exercise(
        cases=_parts,
        right=_largest,
        answer=Answer("a bool mask like the one given", unit="voxels", tolerance=0.0, error=different_bools),
        mistakes=(
            (lambda m: ndimage.label(m)[0] == 1, "Label 1 is the part that is met first, not the largest."),
            *(
                (way, "This is the background, label 0: leave it out of the count.")
                for way in (np.logical_not, _largest_of_all)
            ),
            (_largest_but_last, "The last part was not counted: the numbers of the parts run to n, range(1, n + 1)."),
            (
                lambda m: ndimage.binary_fill_holes(_largest(m)),
                "The largest part, and its cavities with it: filling was not asked for.",
            ),
            (drop_artefacts, "This also keeps other parts, by their size and place: keep the largest alone."),
            (ndimage.binary_fill_holes, "This fills cavities and drops nothing: label the parts and choose one."),
            (lambda m: _largest(~m), "You labelled ~mask, the background: label the mask itself."),
            (lambda m: m & ~_largest(m), "This drops the largest part and keeps the rest."),
            (_largest_shifted, "bincount(...)[1:] begins with part 1: add 1 to its argmax."),
            *(
                (way, "This takes the largest part of each slice: label the whole mask once.")
                for way in (_largest_of_slices, _largest_of_slices_with_bone)
            ),
            (_largest_over_corners, "Voxels that share only an edge or a corner are not connected here."),
            (lambda m: m, "Nothing was dropped."),
            (lambda m: ndimage.binary_opening(m), "Opening eats thin bone; label the parts and choose one."),
            (
                lambda m: ndimage.label(m)[0],
                "These are the numbers of the parts; a mask comes from comparing them: labels == one.",
            ),
            (
                lambda m: ndimage.label(m)[0] == ndimage.label(m)[1],
                "This is the part that is met last, not the largest.",
            ),
            (
                lambda m: ndimage.label(m)[0] == np.bincount(ndimage.label(m)[0].ravel())[1:].max(),
                "max gives the count, argmax the label that has it.",
            ),
            (
                lambda m: np.bincount(ndimage.label(m)[0].ravel())[1:].argmax() + 1,
                "This is the number of the largest part; return the mask of it.",
            ),
            (
                lambda m: np.bincount(ndimage.label(m)[0].ravel())[1:].max(),
                "This is the size of the largest part; return the mask of it.",
            ),
            (
                _largest_times_number,
                "A sum over labels is the size times the number of the part: count with (labels == i).sum().",
            ),
            (_second_largest, "This is the second largest part."),
            (
                partial(_largest_of_all, place=-2),
                "Label 0, the background, need not be the largest count: set its count to 0, then argmax.",
            ),
            (_smallest, "This is the smallest part: argmax of the counts, not argmin."),
            (_widest, "This is the part with the largest box: count its voxels."),
            (
                lambda m: ndimage.binary_opening(m, iterations=2),
                "Opening eats thin bone; label the parts and choose one.",
            ),
            (lambda m: ndimage.binary_erosion(m), "Erosion eats the bone; label the parts and choose one."),
        ),
        hints=(
            "ndimage.label numbers the parts.",
            "np.bincount(labels.ravel()) counts them; 0 is background.",
            "Set the count of label 0 to 0; argmax then names the part, and `==` makes the mask.",
        ),
        praise="the couch is gone, the skull is whole.",
    ),
    "2.2": Exercise(
        cases=_rings,
        right=_fill_small,
        answer=Answer("a bool mask like the one given", unit="pixels", tolerance=0.0, error=different_bools),
        mistakes=(
            (lambda m, a: ndimage.binary_fill_holes(m), "This fills the brain's place as well: fill only small holes."),
            (
                lambda m, a: m,
                "No hole was filled: holes are parts of ~mask. Was the bone labelled, or all holes counted as one?",
            ),
            *(
                (
                    partial(_fill_small, lost=(-1,), small=small),
                    "The last hole is missing: the numbers of the parts run to n, range(1, n + 1).",
                )
                for small in (np.less_equal, np.less)
            ),
            (
                partial(_fill_small, lost=(1,)),
                "Part 1 is passed over: only 0 is no part, and part 1 need not be what lies outside.",
            ),
            *(
                (
                    partial(_fill_small, small=small),
                    "Turned round: this fills the large holes. At most max_pixels means <= max_pixels.",
                )
                for small in (np.greater_equal, np.greater)
            ),
            (
                partial(_border_or_small, way=lambda small, at_border: small | ~at_border),
                "A hole is small *and* away from the border: join both by `and`, not by `or`.",
            ),
            (
                partial(_border_or_small, way=lambda small, at_border: small & at_border),
                "Turned round: this fills what touches the border, and leaves the holes.",
            ),
            (
                _small_of_filled,
                "Label 0, all that is no hole, was made small by s[0] = 0: leave it out of what is filled.",
            ),
            (
                partial(_fill_small, borders=()),
                "What touches the border is outside, not a hole, however small it is.",
            ),
            *((partial(_fill_small, borders=some), _BORDERS) for some in _SOME),
            (
                partial(_fill_small, structure=np.ones((3, 3))),
                "Holes that share only a corner are two holes: label the background with 4 neighbours.",
            ),
            (
                lambda m, a: _fill_small(m, a + 1),
                "Holes a little larger than max_pixels are filled too: it counts pixels, so no + 1, no factor, no mm2.",
            ),
            (
                lambda m, a: _fill_small(m, a - 1),
                "A hole of just max_pixels is filled as well: at most means <=, and pixels are counted, not mm2.",
            ),
            (
                partial(_fill_small, shift=1),
                "bincount(...)[1:] begins with label 1: each size went to the label before.",
            ),
            (_holes, "These are the holes alone: return the bone with them, mask | holes."),
            (
                lambda m, a: ndimage.binary_closing(m, iterations=3),
                "Closing also fills bays of the outline; label the holes.",
            ),
            (
                partial(_holes, borders=()),
                "These are the small parts of the background alone: return the bone with them, and none at the border.",
            ),
            (
                lambda m, a: ndimage.binary_fill_holes(m) & ~m,
                "These are all holes, alone, the brain's place among them: add the small ones to the bone.",
            ),
            (_large_holes, "This fills what is larger than max_pixels; fill what is not."),
            (
                lambda m, a: ndimage.binary_closing(m),
                "Closing also fills bays of the outline, and no wide holes; label the holes.",
            ),
            (lambda m, a: ~m, "This is the background; holes are small parts of it."),
        ),
        hints=(
            "Holes are parts of ~mask: label them.",
            "A hole has at most max_pixels and does not touch the border.",
            "Switch off the labels found in the first and last row and column.",
        ),
        praise="the diploe is closed and the brain has room.",
    ),
}
"""The exercises of lesson 02, by number."""
