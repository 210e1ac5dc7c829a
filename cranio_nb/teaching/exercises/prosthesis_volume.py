"""Exercises of lesson 05: the outline of a patch, the patch, partial loss."""

from __future__ import annotations

import numpy as np
from scipy import ndimage
from skimage.morphology import convex_hull_image

from .task import Answer, Exercise, different_bools, small_head

_CORNERS = np.ones((3, 3), bool)  # pixels that touch at a corner belong together
_SIDES = ndimage.generate_binary_structure(2, 1)


def _curves():
    truths = [t for plane in (13, 17, 21) for t in small_head().slice_truth(plane)]
    return [(t.outer.curve, t.inner.curve) for t in truths if t.outer and t.inner]


def _area(outline):
    row, col = outline.T
    return abs(row @ np.roll(col, -1) - col @ np.roll(row, -1)) / 2


def _enclosed_mm2(outline):
    """Area that an outline in px of 1.75 mm encloses."""
    return _area(np.asarray(outline, float)) * 1.75**2


def _outline_error(answer, right):
    """Difference of the enclosed areas, mm2; both of them where one lies beside the other."""
    outline = np.asarray(answer, float)
    if outline.ndim != 2 or outline.shape[1] != 2:
        return float("inf")
    beside = (outline.min(axis=0) > right.max(axis=0)) | (outline.max(axis=0) < right.min(axis=0))
    return abs(_enclosed_mm2(outline) - (-1 if beside.any() else 1) * _enclosed_mm2(right))


def _regions():
    found = [
        (ndimage.binary_dilation(small_head().implant[p], iterations=2), small_head().bone[p]) for p in (13, 17, 21)
    ]
    region, bone = (mask.copy() for mask in found[1])
    # a crumb beside the patch, and a hole in the bone within the region: both stay
    bone[60:67, 60:67] = region[60:67, 60:67] = region[2, 2:5] = True
    bone[63, 63] = False
    return [found[0], (region, bone), found[2]]


def _dented():
    row, col = np.indices((90, 90)) - 45
    ring = (np.hypot(row, col) < 38) & (np.hypot(row, col) > 28)
    dent = ring & ~((row < -31) & (np.abs(col) < 9))
    speck = dent & ~((col < -33) & (np.abs(row) < 7))
    speck[82, 43:47] = False
    pits = (col >= 33) & (col < 35) & (row >= -6) & (row < 0) | (col >= 35) & (col < 37) & (row >= 0) & (row < 6)
    size = np.bincount(ndimage.label(convex_hull_image(dent) & ~dent)[0].ravel())
    # a small ring aside, so that the biggest region is neither in the middle nor as large as in the others
    small = np.zeros((90, 90), bool)
    small[:45, 45:] = speck[::2, ::2]
    # one dent of two, just enough; both, and no island; a region that holds together at a corner only
    return [(speck, int(np.sort(size[1:])[-2])), (small, 6), (dent & ~pits, 20)]


def _lost(bone, min_pixels, touching=_CORNERS, whole=convex_hull_image):
    labels, n = ndimage.label(whole(bone) & ~bone, touching)
    sizes = np.bincount(labels.ravel(), minlength=n + 1)
    sizes[0] = 0
    keep = sizes >= min_pixels
    keep[sizes.argmax()] = False
    return keep[labels]


def _regions_of(bone):
    """Labels of the regions between hull and bone, and their sizes, 0 for the rest."""
    labels, _ = ndimage.label(convex_hull_image(bone) & ~bone, _CORNERS)
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    return labels, sizes


def _only(bone, place):
    labels, sizes = _regions_of(bone)
    return labels == np.argsort(sizes)[place]


def _shifted(bone, min_pixels):
    """The sizes without label 0, and the labels not moved with them."""
    labels, sizes = _regions_of(bone)
    keep = sizes[1:] >= min_pixels
    keep[sizes[1:].argmax()] = False
    return np.isin(labels, np.flatnonzero(keep))


def _all_but_large(bone, min_pixels):
    """What is no large region: the small ones, and with label 0 all the rest of the picture."""
    labels, sizes = _regions_of(bone)
    return (sizes < min_pixels)[labels]


def _small_regions(bone, min_pixels):
    labels, sizes = _regions_of(bone)
    return (sizes < min_pixels)[labels] & (labels > 0)


def _with_cavity(bone, min_pixels, touching=_CORNERS):
    labels, n = ndimage.label(convex_hull_image(bone) & ~bone, touching)
    keep = np.bincount(labels.ravel(), minlength=n + 1) >= min_pixels
    keep[0] = False
    return keep[labels]


EXERCISES: dict[str, Exercise] = {
    "5.1": Exercise(
        cases=_curves,
        right=lambda outer, inner: np.concatenate([outer, inner[::-1]]),
        answer=Answer(
            "an array (n, 2) of (row, col)",
            unit="mm2",
            tolerance=0.01,
            error=_outline_error,
            shows=(_enclosed_mm2, "mm2 enclosed"),
        ),
        mistakes=(
            (
                lambda o, i: np.concatenate([o, i]),
                "The outline crosses itself like a bow tie: walk back along the inner curve.",
            ),
            (lambda o, i: o, "This closes the outer curve by its chord; the inner curve is missing."),
            (lambda o, i: i, "This closes the inner curve by its chord; the outer curve is missing."),
            (lambda o, i: (o + i) / 2, "This is the middle between the curves; the outline walks along both."),
            (lambda o, i: np.concatenate([o, i], axis=1), "Joined side by side, (n, 4): join them end to end, axis=0."),
            (
                lambda o, i: np.concatenate([o, i[::-1]], axis=1),
                "Joined side by side, (n, 4): join them end to end, axis=0.",
            ),
            (
                lambda o, i: np.concatenate([o, i[:, ::-1]]),
                "This swaps row and col of the inner curve; its order is to be turned: [::-1].",
            ),
            *(
                (
                    way,
                    "np.flip without axis turns both axes, and exchanges row and col: turn the order only, [::-1].",
                )
                for way in (
                    lambda o, i: np.concatenate([o, np.flip(i)]),
                    lambda o, i: np.concatenate([np.flip(o), i]),
                )
            ),
            (
                lambda o, i: np.concatenate([o, i[::-1]])[:, ::-1],
                "These points are (col, row), not (row, col); np.flip without axis does that too.",
            ),
            *(
                (
                    lambda o, i, turn=turn: np.append(o, i[::turn]),
                    "np.append makes one row of all numbers, unless it is told axis=0.",
                )
                for turn in (1, -1)
            ),
            *(
                (
                    lambda o, i, turn=turn: np.stack([o, i[::turn]]),
                    "These are two curves in one array, (2, n, 2): np.concatenate joins them end to end.",
                )
                for turn in (1, -1)
            ),
            (
                lambda o, i: np.concatenate([o, np.sort(i, axis=0)[::-1]]),
                "np.sort orders rows and columns each by itself: turn the curve as it is, [::-1].",
            ),
            *(
                (way, "A point at an end is lost: the outline goes through both ends of both curves.")
                for way in (
                    lambda o, i: np.concatenate([o, i[1:-1][::-1]]),
                    lambda o, i: np.concatenate([o[:-1], i[::-1][:-1]]),
                    lambda o, i: np.concatenate([o, i[::-1][1:]]),
                    lambda o, i: np.concatenate([o[:-1], i[::-1]]),
                    lambda o, i: np.concatenate([o, i[:0:-1]]),
                )
            ),
            (
                lambda o, i: np.concatenate([o, i[::-1], o]),
                "The outer curve is walked twice: at most its first point is repeated.",
            ),
            (
                lambda o, i: np.concatenate([o, -i]),
                "A minus mirrors the curve at 0, 0; [::-1] turns its order round.",
            ),
            (lambda o, i: o + i[::-1], "This adds the coordinates; np.concatenate joins the points."),
            (lambda o, i: o - i, "This is the step from curve to curve; np.concatenate joins the points."),
        ),
        hints=(
            "Walk along the outer curve, then back along the inner one.",
            "inner[::-1] is the inner curve from its end.",
            "np.concatenate joins arrays that stand in one list.",
        ),
        praise="an outline that goes round once.",
    ),
    "5.2": Exercise(
        cases=_regions,
        right=lambda region, bone: region & ~bone,
        answer=Answer("a bool mask like the ones given", unit="pixels", tolerance=0.0, error=different_bools),
        mistakes=(
            (lambda r, b: r, "Bone is still in it: a prosthesis cannot be where the bone is."),
            (
                lambda r, b: r ^ b,
                "This also holds the whole rest of the skull: it is either, not the one without the other.",
            ),
            (lambda r, b: r & b, "This is just the part that must go."),
            *(
                (way, "Nothing is dropped here: bone alone is taken away, and crumbs stay.")
                for way in (
                    lambda r, b: (
                        ndimage.label(r & ~b)[0] == np.bincount(ndimage.label(r & ~b)[0].ravel())[1:].argmax() + 1
                    ),
                    lambda r, b: ndimage.binary_opening(r & ~b),
                )
            ),
            (
                lambda r, b: r & ~ndimage.binary_fill_holes(b),
                "The holes of the bone were filled first, and what lies in them is not bone.",
            ),
            (lambda r, b: r | b, "This is the repaired slice; the patch is what is new in it."),
            (lambda r, b: b & ~r, "Turned round: this is bone outside the region."),
            (
                lambda r, b: ~(r & b),
                "This is nearly the whole picture: the region must be in it, and only the bone not.",
            ),
            (
                lambda r, b: ~b,
                "This is everything that is not bone: only what lies in the region belongs to the patch.",
            ),
            (lambda r, b: ~r, "This is everything outside the region."),
            (lambda r, b: b, "This is the bone that is there already."),
            *(
                (way, "This holds what is outside the region as well: both must hold, so join by `&`.")
                for way in (lambda r, b: r | ~b, lambda r, b: r >= b, lambda r, b: r & b | ~b)
            ),
            (lambda r, b: ~(r | b), "This is what is neither in the region nor bone."),
            (
                lambda r, b: ndimage.binary_erosion(r) & ~b,
                "The edge of the region is lost: no erosion is needed.",
            ),
            (
                lambda r, b: ndimage.binary_dilation(r) & ~b,
                "The region has grown by a pixel: no dilation is needed.",
            ),
            (lambda r, b: r.astype(int) - b, "Numbers with -1 among them: masks are joined by & and ~."),
            (
                lambda r, b: r & ~ndimage.binary_dilation(b),
                "A pixel is left free all round the bone: the patch begins where bone ends.",
            ),
            (
                lambda r, b: r & ~ndimage.binary_erosion(b),
                "The edge of the bone is still in it: take all the bone away.",
            ),
        ),
        hints=(
            "What is in the region and not in the bone?",
            "~bone is everything that is not bone.",
            "`&` holds where both masks hold.",
        ),
        praise="nothing is designed where bone is.",
    ),
    "5.3": Exercise(
        cases=_dented,
        right=_lost,
        answer=Answer("a bool mask like the one given", unit="pixels", tolerance=0.0, error=different_bools),
        mistakes=(
            (_with_cavity, "The brain's place is in it: drop the biggest region too."),
            (lambda b, m: _with_cavity(b, m, _SIDES), "The brain's place is in it: drop the biggest region too."),
            (lambda b, m: _lost(b, 1), "Small islands are left: drop regions under min_pixels."),
            *(
                (lambda b, m, n=n: _lost(b, n), "A fixed number of pixels? min_pixels is another one each time.")
                for n in (10, 20, 30)
            ),
            (
                lambda b, m: _lost(b, m, _SIDES),
                "Pixels that touch at a corner belong together: measure.label counts them so.",
            ),
            (lambda b, m: _lost(b, m + 1), "A region of just min_pixels stays: >=, not >."),
            (
                lambda b, m: _lost(b, m + 1, _SIDES),
                "A region of just min_pixels stays (>=), and pixels that touch at a corner belong together.",
            ),
            (
                lambda b, m: np.zeros_like(b),
                "Nothing is left. Was the bone taken from the hull before labelling? A part alone is the biggest.",
            ),
            (
                _shifted,
                "bincount(...)[1:] begins with region 1: each mark went to the label before.",
            ),
            (_all_but_large, "Turned round, and label 0 with it: what has min_pixels and more stays."),
            (
                lambda b, m: convex_hull_image(b) & ~b,
                "This is the whole difference: the biggest region and the islands must go.",
            ),
            *(
                (way, "Filling holes finds the cavity, not the dent: use the convex hull.")
                for way in (
                    lambda b, m: ndimage.binary_fill_holes(b) & ~b,
                    lambda b, m: _lost(b, m, whole=ndimage.binary_fill_holes),
                )
            ),
            (
                lambda b, m: _only(b, -2),
                "This is the second biggest region alone; every region of min_pixels and more stays.",
            ),
            (lambda b, m: _only(b, -1), "This is the biggest region, the brain's place: it is the one to drop."),
            (
                lambda b, m: convex_hull_image(b),
                "This is the whole hull: take the bone away, then the biggest region and the islands.",
            ),
            (lambda b, m: _lost(b, m) | b, "This is the mended ring; the patch is what is new in it."),
            (lambda b, m: _small_regions(b, m), "These are the small islands: they go, the larger regions stay."),
        ),
        hints=(
            "The hull (morphology.convex_hull_image) without the bone, then measure.label.",
            "Count each label; 0 is background.",
            "Decide for each label whether it stays, the biggest not; that array, taken at labels, is the mask.",
        ),
        praise="only the dent is left (the paper's Fig. 6d).",
    ),
}
"""The exercises of lesson 05, by number."""
