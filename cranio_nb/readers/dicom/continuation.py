"""Chosen slices and the images left out -> would these have continued the scan? Then it is not whole.

World is DICOM LPS, lengths in mm.
"""

from __future__ import annotations

import numpy as np

from ...errors import InputRefused
from .geometry import MIN_SLICES, axes_of, check_geometry, sort_by_height
from .slice_header import SliceHeader

DIRECTION_TOL = 1e-4
_PARALLEL = np.cos(np.radians(10))  # images within this angle may be slices of one scan


def agree(a: np.ndarray | None, b: np.ndarray | None) -> bool:
    """Whether two vectors agree within rounding; absent ones agree with each other only.

    Parameters
    ----------
    a, b : ndarray or None
        Of equal shape.

    Returns
    -------
    bool

    Examples
    --------
    >>> agree(np.array([1.0, 0]), np.array([1.0, 1e-6])), agree(None, np.zeros(2))
    (True, False)
    """
    if a is None or b is None:
        return a is b
    return bool(np.allclose(a, b, rtol=DIRECTION_TOL, atol=DIRECTION_TOL, equal_nan=True))


def check_continued(slices: list[SliceHeader], step: float, others: list[SliceHeader]) -> None:
    """Refuse a scan that images left out of it would continue: it would lose its end, or slices inside.

    Parameters
    ----------
    slices : list of SliceHeader
        Of the scan.
    step : float
        mm between them.
    others : list of SliceHeader
        Images that are not of it: of another kind, direction, modality or series.

    Raises
    ------
    InputRefused
        ``MissingSlices`` for images of the same series, ``AmbiguousSeries`` for those of another one.

    Notes
    -----
    An image continues the scan if it has its size, spacing and frame of reference, lies within 10 degrees of its
    direction, and is on the line through its slices where no slice is.

    Examples
    --------
    The topmost four of twelve slices say that they are of another modality:

    >>> from dataclasses import replace
    >>> from data_synth import write_dicom
    >>> from .parse import parse_file
    >>> from .slice_header import read_headers
    >>> files = write_dicom("scan", np.zeros((12, 4, 4), np.int16), np.eye(4)[[2, 1, 0, 3]])
    >>> headers = [header for i, file in enumerate(files) for header in read_headers(*parse_file(file, i), i)]
    >>> check_continued(headers[:8], 1.0, [replace(header, modality="MR") for header in headers[8:]])
    Traceback (most recent call last):
    cranio_nb.errors.InputRefused: 4 images of the series continue the scan but differ from it in modality or class. ...
    """
    first = slices[0]
    try:
        check_geometry(slices)
        ordered, heights = sort_by_height(slices)
    except InputRefused:
        return  # refused later, with its own reason
    if step <= 0 or len(ordered) < MIN_SLICES:
        return
    alike = [header for header in others if _could_follow(first, header)]
    lost = [header for header, off in zip(alike, _places_beside(ordered, heights, step, alike), strict=True) if off]
    same = [header for header in lost if header.series == first.series]
    if same:
        message = (
            f"{len(same)} images of the series continue the scan but differ from it in {_difference(first, same[0])}."
        )
        raise InputRefused("MissingSlices", message, "Export the complete series again.")
    if any(header.kernel == first.kernel and header.image_type[:1] == first.image_type[:1] for header in lost):
        message = f"{len(lost)} images of another series continue the scan: it is stored in more than one series."
        raise InputRefused(
            "AmbiguousSeries", message, "Export it as one series, or give the folder of the wanted part."
        )


def _could_follow(first: SliceHeader, header: SliceHeader) -> bool:
    """Whether an image has the size, spacing, frame of reference and about the direction of a scan."""
    if (header.rows, header.cols) != (first.rows, first.cols) or not agree(header.spacing, first.spacing):
        return False
    if {header.frame_of_reference, first.frame_of_reference} - {""} > {first.frame_of_reference}:
        return False
    if header.position is None or header.orientation is None or first.orientation is None:
        return False
    directions = (header.orientation * first.orientation).reshape(2, 3).sum(axis=1)
    return bool(np.isfinite(header.position).all() and (directions > _PARALLEL).all())


def _places_beside(
    ordered: list[SliceHeader], heights: np.ndarray, step: float, others: list[SliceHeader]
) -> list[bool]:
    """Whether each image lies on the line through a scan's slices, where none of them is."""
    if not others or heights[-1] <= 0:
        return [False] * len(others)
    # height along the scan's own direction, and distance beside it
    start = np.asarray(ordered[0].position)
    line = (np.asarray(ordered[-1].position) - start) / heights[-1]
    *_, normal = axes_of(np.asarray(ordered[0].orientation))
    offsets = np.array([header.position for header in others]) - start
    along = offsets @ normal
    beside = np.linalg.norm(offsets - along[:, None] * line, axis=1)
    # no slice within half a step, and no farther from the ends than the images themselves reach
    k = np.clip(np.searchsorted(heights, along), 1, len(heights) - 1)
    free = np.minimum(np.abs(along - heights[k - 1]), np.abs(along - heights[k])) > 0.5 * step
    reach = (len(others) + 1.5) * step
    near = (along > -reach) & (along < heights[-1] + reach)
    return [bool(value) for value in free & near & (beside < max(2.0, step))]


def _difference(first: SliceHeader, other: SliceHeader) -> str:
    """What an image differs in from a scan of the same series."""
    if other.modality != first.modality or other.sop_class != first.sop_class:
        return "modality or class"
    return "kind" if other.image_type[:3] != first.image_type[:3] else "direction or format"
