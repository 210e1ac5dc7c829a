"""Stage 1, bone: a CT in HU comes in -> the skull as a bool mask on the same grid goes out.

Frame: voxel (plane, row, col). Lengths in mm, areas in mm2, attenuation in HU.

The paper thresholds at [400, 1000] HU. Cortical bone goes past 1000 HU, so there is no upper bound unless one is set.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..errors import InputRefused
from ..volume import Volume

BONE_HU = 400.0
"""Lowest HU of bone (the paper, section 2)."""


def segment(
    ct: Volume, *, threshold: float = BONE_HU, upper: float = np.inf, max_hole: float = 60.0, min_part: float = 0.02
) -> Volume:
    """Separate the skull from everything else: threshold, drop artefacts, fill the holes of the diploe and sinuses.

    Parameters
    ----------
    ct : Volume
        HU, shape (P, R, C), or a bool mask, which is only cleaned.
    threshold, upper : float
        Bone is threshold <= HU <= upper.
    max_hole : float
        Holes of a slice up to this area in mm2 are filled. The cranial cavity (above 5000 mm2) never is.
    min_part : float
        Loose parts smaller than this fraction of the skull's volume are dropped, as are larger ones that lie outside
        the head (couch, head holder).

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
    Section 2 of the paper: "simple binarization", "hole filling", "a simple search process to discard acquisition
    artifacts".
    """
    mask = ct.voxels if ct.voxels.dtype == bool else threshold_hu(ct.voxels, threshold, upper)
    box = ndimage.find_objects(mask.view(np.uint8))
    if not box:
        raise InputRefused("NoBone", f"No voxel reaches {threshold:g} HU.", "Lower the bone threshold, or give a CT.")
    skull = drop_artefacts(mask[box[0]], min_part=min_part)
    out = np.zeros(ct.shape, bool)
    out[box[0]] = fill_holes(skull, max_hole / float(np.prod(ct.spacing[1:])))
    return ct.with_voxels(out)


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
    """
    used = threshold_of(scan, threshold)
    return segment(scan) if used is None else segment(scan, threshold=used)


def threshold_of(scan: Volume, threshold: float | None = None) -> float | None:
    """The threshold in HU that `bone_of` uses; None for a mask. Parameters and errors as there."""
    if scan.voxels.dtype != bool:
        return BONE_HU if threshold is None else threshold
    if threshold is not None:
        raise InputRefused("ThresholdOfMask", "A bone mask has no HU to set a threshold on.", "Leave it out.")
    return None


def threshold_hu(hu: NDArray, threshold: float, upper: float = np.inf) -> NDArray[np.bool_]:
    """Voxels with threshold <= HU <= upper, shape (P, R, C)."""
    return hu >= threshold if np.isinf(upper) else (hu >= threshold) & (hu <= upper)


def drop_artefacts(mask: NDArray[np.bool_], *, min_part: float = 0.02) -> NDArray[np.bool_]:
    """Keep the skull and its loose pieces; drop islands, couch and head holder.

    Parameters
    ----------
    mask : ndarray of bool, shape (P, R, C)
        Thresholded CT.
    min_part : float
        Smallest kept piece as a fraction of the skull.

    Returns
    -------
    ndarray of bool, shape (P, R, C)
    """
    labels, n_parts = ndimage.label(mask)
    if n_parts == 1:
        return mask
    sizes = np.bincount(labels.ravel())
    sizes[0] = 0
    boxes = ndimage.find_objects(labels)
    large = [part for part in range(1, n_parts + 1) if sizes[part] >= min_part * sizes.max()]
    skull = max(large, key=lambda part: _extent(boxes[part - 1]) * sizes[part])
    keep = np.zeros(n_parts + 1, bool)
    keep[[part for part in large if part == skull or _inside(boxes[part - 1], boxes[skull - 1])]] = True
    return keep[labels]


def fill_holes(mask: NDArray[np.bool_], max_hole: float) -> NDArray[np.bool_]:
    """Fill the enclosed holes of each slice that hold at most `max_hole` pixels (diploe, sinuses; not the cavity).

    Parameters
    ----------
    mask : ndarray of bool, shape (P, R, C)
    max_hole : float
        Area in pixels.
    """
    in_plane = np.zeros((3, 3, 3), bool)
    in_plane[1] = ndimage.generate_binary_structure(2, 1)
    labels, n_holes = ndimage.label(~mask, in_plane)
    sizes = np.bincount(labels.ravel(), minlength=n_holes + 1)
    small = sizes <= max_hole
    small[0] = False
    small[_border_labels(labels)] = False
    return mask | small[labels]


def _border_labels(labels: NDArray) -> NDArray:
    """Labels that touch the edge of their slice: outside, not holes."""
    edges = (labels[:, 0], labels[:, -1], labels[:, :, 0], labels[:, :, -1])
    return np.unique(np.concatenate([edge.ravel() for edge in edges]))


def _extent(box: tuple[slice, ...]) -> int:
    """Voxels in a bounding box: a skull encloses much, a couch plate little."""
    return int(np.prod([side.stop - side.start for side in box]))


def _inside(inner: tuple[slice, ...], outer: tuple[slice, ...]) -> bool:
    """Whether the middle of one box lies within another."""
    return all(o.start <= (i.start + i.stop) / 2 <= o.stop for i, o in zip(inner, outer, strict=True))
