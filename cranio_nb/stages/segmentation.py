"""Stage 1, segmentation: a CT in HU comes in -> the skull as a bool mask on the same grid goes out.

Frame: voxel (plane, row, col). Lengths in mm, areas in mm2, attenuation in HU. Source: VISAPP 2011, section 2.

The paper's three steps: a threshold at [400, 1000] HU, hole filling, and a search that discards artefacts. Cortical
bone goes past 1000 HU, so there is no upper bound here unless one is set.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..errors import InputRefused
from ..geometry.voxel_runs import Runs, find_pieces
from ..geometry.within_skin import within_skin
from ..grid import Box
from ..options import THRESHOLD
from ..volume import Volume

BONE_HU: float = THRESHOLD.default
"""Lowest HU of bone (the paper, section 2)."""


_MAX_HOLE_MM2 = 60.0
_MIN_PART = 0.02
_RIVAL = 0.2  # of the skull's voxels from which another part may be a second skull


@dataclass(frozen=True, eq=False)
class Parts:
    """What was found in a scan.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    others : tuple of Volume
        Bool masks of the other parts that are large beside it, each on a grid of its own box.
    """

    bone: Volume
    others: tuple[Volume, ...]


def segment(
    ct: Volume,
    *,
    threshold: float = BONE_HU,
    upper: float = np.inf,
    max_hole_mm2: float = _MAX_HOLE_MM2,
    min_part: float = _MIN_PART,
) -> Volume:
    """Separate the skull from everything else: threshold, drop artefacts, fill the holes of the diploe and sinuses.

    Parameters
    ----------
    ct : Volume
        HU, shape (P, R, C), or a bool mask, which is only cleaned.
    threshold, upper : float
        HU: bone is threshold <= HU <= upper.
    max_hole_mm2 : float
        Holes of a slice up to this area are filled. The cranial cavity (above 5000 mm2) never is.
    min_part : float, 0 to 1
        Loose parts smaller than this fraction of the skull's volume are dropped. What stands outside the skin (couch,
        head holder, frame) always is.

    Returns
    -------
    Volume
        Bool, on the grid of `ct`.

    Raises
    ------
    InputRefused
        ``NoBone`` when nothing reaches the threshold.

    Notes
    -----
    Section 2: "a simple binarization method", "a hole filling method to correct bone topology and a simple search
    process to discard acquisition artifacts".

    Examples
    --------
    A cube of bone with a pore in one slice, and a speck of metal outside it: the pore is filled, the speck is gone.

    >>> hu = np.full((12, 20, 20), -1000)
    >>> hu[1:11, 5:15, 5:15] = 900
    >>> hu[5, 9:11, 9:11] = 100
    >>> hu[5, 1, 1] = 3000
    >>> bone = segment(Volume(hu, np.eye(4)))
    >>> int(bone.voxels.sum()) == 10 * 10 * 10
    True
    """
    mask = ct.voxels
    if mask.dtype != bool:
        mask = within_skin(apply_threshold(ct.voxels, threshold, upper), ct)
    return _separate(ct, mask, threshold, max_hole_mm2, min_part).bone


def _separate(
    ct: Volume,
    mask: NDArray[np.bool_],
    threshold: float,
    max_hole_mm2: float = _MAX_HOLE_MM2,
    min_part: float = _MIN_PART,
) -> Parts:
    """The skull as `segment` gives it from what lies within the skin, and what is large beside it."""
    # all further work is in the box of that
    box = ct.with_voxels(mask).box()
    if not mask[box].size:
        raise InputRefused("NoBone", f"No voxel reaches {threshold:g} HU.", "Lower the bone threshold, or give a CT.")

    # artefacts first, so that no hole of theirs is filled
    skull, large = _choose_skull(mask[box], min_part)
    out = np.zeros(ct.shape, bool)
    out[box] = fill_holes(skull, max_hole_px=max_hole_mm2 / float(np.prod(ct.spacing[1:])))
    others = tuple(replace(ct.crop(box).crop(own), voxels=voxels) for own, voxels in large)
    return Parts(ct.with_voxels(out), others)


def bone_of(scan: Volume, threshold: float | None = None) -> Volume:
    """The skull of a scan, whether that is a CT or a bone mask already: what every design and measure starts from.

    Parameters
    ----------
    scan : Volume
        HU, or a bool mask, shape (P, R, C).
    threshold : float, optional
        Lowest HU of bone; `BONE_HU` when not given.

    Returns
    -------
    Volume
        Bool, on the grid of `scan`.

    Raises
    ------
    InputRefused
        ``ThresholdOfMask`` when a mask comes with a threshold; ``NoBone``.

    Examples
    --------
    A mask goes the same way as the CT it came from:

    >>> hu = np.full((6, 8, 8), -1000)
    >>> hu[1:5, 2:6, 2:6] = 900
    >>> from_ct, from_mask = bone_of(Volume(hu, np.eye(4))), bone_of(Volume(hu > 400, np.eye(4)))
    >>> bool((from_ct.voxels == from_mask.voxels).all())
    True
    """
    return parts_of(scan, threshold).bone


def parts_of(scan: Volume, threshold: float | None = None) -> Parts:
    """The skull of a scan as `bone_of` finds it, and what is large beside it.

    Parameters
    ----------
    scan, threshold
        As for `bone_of`.

    Returns
    -------
    Parts

    Raises
    ------
    InputRefused
        As `bone_of`.

    Examples
    --------
    >>> mask = np.zeros((6, 8, 16), bool)
    >>> mask[:, 1:7, 1:7] = mask[:, 2:6, 9:13] = True
    >>> [other.shape for other in parts_of(Volume(mask, np.eye(4))).others]
    [(6, 4, 4)]
    """
    used = threshold_of(scan, threshold)
    if used is None:
        return _separate(scan, scan.voxels, BONE_HU)
    return _separate(scan, within_skin(apply_threshold(scan.voxels, used), scan), used)


def threshold_of(scan: Volume, threshold: float | None = None) -> float | None:
    """The threshold that `bone_of` uses.

    Parameters
    ----------
    scan : Volume
        HU, or a bool mask, shape (P, R, C).
    threshold : float, optional
        Lowest HU of bone that was asked for.

    Returns
    -------
    float or None
        HU; None for a mask, which has no HU.

    Raises
    ------
    InputRefused
        ``ThresholdOfMask`` when a mask comes with a threshold; ``BadOption`` for one that is none of bone.

    Examples
    --------
    >>> threshold_of(Volume(np.zeros((2, 2, 2)), np.eye(4)))
    400.0
    """
    if scan.voxels.dtype != bool:
        return BONE_HU if threshold is None else float(THRESHOLD.check("The threshold", threshold))
    if threshold is not None:
        raise InputRefused("ThresholdOfMask", "A bone mask has no HU to set a threshold on.", "Leave it out.")
    return None


def apply_threshold(hu: NDArray, threshold: float, upper: float = np.inf) -> NDArray[np.bool_]:
    """Mark the voxels between two thresholds.

    Parameters
    ----------
    hu : ndarray, any shape
        HU.
    threshold, upper : float
        HU, both included.

    Returns
    -------
    ndarray of bool, shape of `hu`
        threshold <= hu <= upper.

    Examples
    --------
    >>> apply_threshold(np.array([399, 400, 1000, 1001]), 400, 1000)
    array([False,  True,  True, False])
    """
    if hu.dtype.kind in "iu" and np.isfinite(threshold):  # whole numbers are compared as they are, not as floats
        threshold = int(np.ceil(threshold))
    return hu >= threshold if np.isinf(upper) else (hu >= threshold) & (hu <= upper)


def drop_artefacts(mask: NDArray[np.bool_], *, min_part: float = _MIN_PART) -> NDArray[np.bool_]:
    """Keep the skull and its loose pieces; drop islands, and what stands beside it.

    Parameters
    ----------
    mask : ndarray of bool, shape (P, R, C)
        Thresholded CT.
    min_part : float, 0 to 1
        Smallest kept piece as a fraction of the largest.

    Returns
    -------
    ndarray of bool, shape (P, R, C)
        The skull, and the large pieces whose middle lies in its bounding box.

    Examples
    --------
    A frame keeps the piece inside it, and not the one beside it:

    >>> frame = np.zeros((3, 9, 16), bool)
    >>> frame[:, 1:8, 1:8] = True
    >>> frame[:, 2:7, 2:7] = False
    >>> inside, beside = np.zeros((2, *frame.shape), bool)
    >>> inside[:, 4, 4], beside[:, 4, 12] = True, True
    >>> bool((drop_artefacts(frame | inside | beside) == frame | inside).all())
    True
    """
    return _choose_skull(mask, min_part)[0]


def _choose_skull(
    mask: NDArray[np.bool_], min_part: float
) -> tuple[NDArray[np.bool_], list[tuple[Box, NDArray[np.bool_]]]]:
    """The mask that `drop_artefacts` gives; and box and voxels of each part that is large beside the skull."""
    parts = find_pieces(mask)
    if parts.n_pieces == 1:
        return mask, []
    large = parts.sizes >= min_part * parts.sizes.max()

    # the skull is large and encloses much; a couch plate encloses little
    start, stop = parts.boxes[:, 0], parts.boxes[:, 1]
    skull = np.argmax(large * (stop - start).prod(axis=1) * parts.sizes)
    inside = ((start[skull] <= (start + stop) / 2) & ((start + stop) / 2 <= stop[skull])).all(axis=1)
    kept = mask.copy()
    kept.ravel()[parts.places(~(large & inside))] = False
    every = np.arange(parts.n_pieces)
    rivals = every[large & (every != skull) & (parts.sizes >= _RIVAL * parts.sizes[skull])]
    return kept, [_cut_out(parts, rival) for rival in rivals]


def _cut_out(parts: Runs, one: int) -> tuple[Box, NDArray[np.bool_]]:
    """Box and voxels of one part."""
    plane, row, col = (slice(int(a), int(b)) for a, b in parts.boxes[one].T)
    voxels = np.zeros(parts.shape, bool)
    voxels.ravel()[parts.places(np.arange(parts.n_pieces) == one)] = True
    return (plane, row, col), voxels[plane, row, col]


def fill_holes(mask: NDArray[np.bool_], *, max_hole_px: float) -> NDArray[np.bool_]:
    """Fill the small enclosed holes of each slice (diploe, sinuses; not the cavity of the head).

    Parameters
    ----------
    mask : ndarray of bool, shape (P, R, C)
    max_hole_px : float
        Largest area of a hole that is filled, pixels.

    Returns
    -------
    ndarray of bool, shape (P, R, C)

    Examples
    --------
    A hole of four pixels is filled, one of five is not:

    >>> mask = np.ones((1, 5, 12), bool)
    >>> mask[0, 2, 1:5] = mask[0, 2, 6:11] = False
    >>> fill_holes(mask, max_hole_px=4)[0, 2].astype(int)
    array([1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 1])
    """
    free = find_pieces(~mask, in_slices=True)
    enclosed = np.ones(free.n_pieces, bool)
    enclosed[free.piece[free.at_edge]] = False
    filled = mask.copy()
    filled.ravel()[free.places(enclosed & (free.sizes <= max_hole_px))] = True
    return filled
