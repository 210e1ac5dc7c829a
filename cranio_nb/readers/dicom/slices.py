"""Slices of one series -> one slice per position: copies are dropped, two scans at the same places told apart."""

from __future__ import annotations

from collections.abc import Callable, Collection
from itertools import pairwise

import numpy as np

from ...errors import InputRefused
from ..load_report import Finding
from .geometry import SAME_PLACE, bad_geometry, by_height, check_geometry
from .headers import SliceHeader
from .pixels import check_format, pixel_digest

# what may tell two scans at the same positions apart
_SPLITS: dict[str, Callable[[SliceHeader], object]] = {
    "acquisition": lambda h: h.acquisition,
    "kind of image": lambda h: h.image_type,
    "kernel": lambda h: h.kernel,
    "content time": lambda h: h.content_time,
}
_REMEDY = "Give a folder with one of them."


def one_per_position(
    headers: list[SliceHeader], allow: Collection[str] = ()
) -> tuple[list[SliceHeader], list[Finding]]:
    """Slices in the order of their height, each position once.

    Parameters
    ----------
    headers : list of SliceHeader
        Of one series.
    allow : collection of str
        ``"gap_fill"`` lets slices without pixel data go: what they leave is a gap.

    Raises
    ------
    InputRefused
        ``BadGeometry``, ``MissingSlices`` (no pixel data), or ``AmbiguousSeries`` where slices with different pixels
        share a position.
    """
    check_geometry(headers)
    headers, findings = _with_pixels(headers, "gap_fill" in allow)
    ordered, heights = by_height(headers)
    if len(ordered) > 1 and heights[-1] < SAME_PLACE:
        raise bad_geometry(f"All {len(ordered)} slices lie at one position.")
    kept, dropped = _without_copies(_position_groups(ordered, heights))
    if dropped:
        message = f"{dropped} exact cop{'ies' if dropped > 1 else 'y'} of slices dropped."
        findings.append(Finding("DuplicatesDropped", "corrected", message, {"copies": dropped}))
    if any(len(group) > 1 for group in kept):
        raise _two_scans(kept)
    return [group[0] for group in kept], findings


def _with_pixels(headers: list[SliceHeader], may_drop: bool) -> tuple[list[SliceHeader], list[Finding]]:
    ordered, _ = by_height(headers)
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
    groups = [[ordered[0]]]
    for (below, above), header in zip(pairwise(heights), ordered[1:], strict=True):
        if above - below < SAME_PLACE:
            groups[-1].append(header)
        else:
            groups.append([header])
    return groups


def _without_copies(groups: list[list[SliceHeader]]) -> tuple[list[list[SliceHeader]], int]:
    kept, dropped = [], 0
    for index, group in enumerate(groups):
        if len(group) == 1:
            kept.append(group)
            continue
        different: dict[object, SliceHeader] = {}
        for header in group:
            check_format(header, index)
            meaning = (pixel_digest(header, index), header.slope, header.intercept, tuple(np.asarray(header.position)))
            different.setdefault(meaning, header)
        kept.append(list(different.values()))
        dropped += len(group) - len(different)
    return kept, dropped


def _two_scans(groups: list[list[SliceHeader]]) -> InputRefused:
    doubled = [i for i, group in enumerate(groups) if len(group) > 1]
    differ = [name for name, key in _SPLITS.items() if all(len({key(h) for h in groups[i]}) > 1 for i in doubled)]
    by = f"; they differ in {' and '.join(differ)}" if differ else ""
    message = f"{len(doubled)} of {len(groups)} positions hold more than one slice with different pixels{by}."
    return InputRefused("AmbiguousSeries", message, _REMEDY)
