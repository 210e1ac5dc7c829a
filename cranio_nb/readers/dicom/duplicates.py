"""Slices of one series -> one slice per position: copies are dropped, two scans at the same places are refused."""

from __future__ import annotations

from collections.abc import Callable, Collection
from itertools import pairwise

import numpy as np

from ...errors import InputRefused
from ..load_report import Finding
from .geometry import SAME_PLACE_MM, bad_geometry, check_geometry, sort_by_height
from .pixel_data import check_format, digest_pixels, read_stack
from .slice_header import SliceHeader

# what may tell two scans at the same positions apart
_SPLITS: dict[str, Callable[[SliceHeader], object]] = {
    "acquisition": lambda h: h.acquisition,
    "kind of image": lambda h: h.image_type,
    "kernel": lambda h: h.kernel,
    "content time": lambda h: h.content_time,
}
_REMEDY = "Give a folder with one of them."


def keep_one_per_position(
    headers: list[SliceHeader], allow: Collection[str] = ()
) -> tuple[list[SliceHeader], list[Finding]]:
    """Keep one slice per position, in the order of their height.

    Parameters
    ----------
    headers : list of SliceHeader
        Of one series.
    allow : collection of str
        ``"gap_fill"`` lets slices without pixel data go: what they leave is a gap.

    Returns
    -------
    headers : list of SliceHeader
        From the lowest to the highest, each position once.
    findings : list of Finding
        What was dropped.

    Raises
    ------
    InputRefused
        ``BadGeometry``, ``MissingSlices`` (no pixel data), or ``AmbiguousSeries`` where slices with different pixels
        share a position.

    Examples
    --------
    A scan in which one slice was copied twice:

    >>> import shutil
    >>> from data_synth import write_dicom
    >>> from .parse import parse_file
    >>> from .slice_header import read_headers
    >>> hu = np.zeros((8, 4, 4), np.int16)
    >>> files = write_dicom("scan", hu, np.eye(4)[[2, 1, 0, 3]])
    >>> files.append(shutil.copy(files[3], "scan/copy.dcm"))
    >>> headers = [header for i, file in enumerate(files) for header in read_headers(*parse_file(file, i), i)]
    >>> kept, findings = keep_one_per_position(headers)
    >>> len(headers), len(kept), findings[0].code
    (9, 8, 'DuplicatesDropped')
    """
    check_geometry(headers)
    headers, findings = _with_pixels(headers, "gap_fill" in allow)
    ordered, heights = sort_by_height(headers)
    if len(ordered) > 1 and heights[-1] < SAME_PLACE_MM:
        raise bad_geometry(f"All {len(ordered)} slices lie at one position.")

    # copies go; what is left at one place are two scans
    kept, dropped = _without_copies(_position_groups(ordered, heights))
    if dropped:
        message = f"{dropped} exact cop{'ies' if dropped > 1 else 'y'} of slices dropped."
        findings.append(Finding("DuplicatesDropped", "corrected", message, {"copies": dropped}))
    if any(len(group) > 1 for group in kept):
        raise _two_scans(kept)
    return [group[0] for group in kept], findings


def _with_pixels(headers: list[SliceHeader], may_drop: bool) -> tuple[list[SliceHeader], list[Finding]]:
    """Slices that have pixel data, by height; a refusal where some have none and may not be left out."""
    ordered, _ = sort_by_height(headers)
    empty = [i for i, header in enumerate(ordered) if header.place is None]
    if not empty:
        return ordered, []
    kept = [header for header in ordered if header.place is not None]
    if not may_drop or not kept:
        message = f"Slice {empty[0]} has no pixel data ({len(empty)} of {len(headers)} have none)."
        raise InputRefused("MissingSlices", message, "Copy the scan again from its source.")
    message = f"{len(empty)} slices without pixel data were left out."
    return kept, [Finding("MissingPixels", "warning", message, {"slices": empty})]


def _position_groups(ordered: list[SliceHeader], heights: np.ndarray) -> list[list[SliceHeader]]:
    """Slices at one place together, by height."""
    groups = [[ordered[0]]]
    for (below, above), header in zip(pairwise(heights), ordered[1:], strict=True):
        if above - below < SAME_PLACE_MM:
            groups[-1].append(header)
        else:
            groups.append([header])
    return groups


def _without_copies(groups: list[list[SliceHeader]]) -> tuple[list[list[SliceHeader]], int]:
    """The groups with slices of equal pixels and rescale once, and how many were dropped."""
    # what the doubled slices hold, read file by file
    doubled = [(index, header) for index, group in enumerate(groups) if len(group) > 1 for header in group]
    for index, header in doubled:
        check_format(header, index)
    stack = read_stack([header for _, header in doubled], [index for index, _ in doubled])
    digests = {id(doubled[i][1]): digest_pixels(pixels) for i, pixels in stack}

    # by pixels and rescale; the first of equals stays
    kept, dropped = [], 0
    for group in groups:
        different: dict[object, SliceHeader] = {}
        for header in group:
            meaning = (digests.get(id(header)), header.slope, header.intercept, tuple(np.asarray(header.position)))
            different.setdefault(meaning, header)
        kept.append(list(different.values()))
        dropped += len(group) - len(different)
    return kept, dropped


def _two_scans(groups: list[list[SliceHeader]]) -> InputRefused:
    """The refusal for two scans in one series, with what tells them apart."""
    # what differs at every doubled position is what tells the scans apart
    doubled = [i for i, group in enumerate(groups) if len(group) > 1]
    differ = [name for name, key in _SPLITS.items() if all(len({key(h) for h in groups[i]}) > 1 for i in doubled)]
    by = f"; they differ in {' and '.join(differ)}" if differ else ""
    message = f"{len(doubled)} of {len(groups)} positions hold more than one slice with different pixels{by}."
    return InputRefused("AmbiguousSeries", message, _REMEDY)
