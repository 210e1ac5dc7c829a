"""Images of a folder -> those that may be slices of a CT, in groups that belong together.

Images belong together when series, size, spacing, orientation and kind of image agree.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right, insort
from collections import Counter
from dataclasses import replace

import numpy as np

from ...errors import InputRefused
from ..load_report import Finding
from .continuation import DIRECTION_TOL
from .geometry import MIN_SLICES
from .parse import CT_CLASSES
from .slice_header import SliceHeader

CT_MODALITIES = ("CT", "")
_MODALITIES = {"MR", "PT", "NM", "CR", "DX", "US", "XA", "RF", "MG", "OT", "SC", "SEG", "RTSTRUCT", "RTDOSE"}
_WEIGHTS = (1.41, 1.73, 2.24, 2.65, 3.32, 3.61, 4.12, 4.36, 4.8)  # any positive numbers that directions do not cancel


def split_usable(
    headers: list[SliceHeader], any_modality: bool
) -> tuple[list[SliceHeader], Counter[str], list[SliceHeader]]:
    """Split images into those that may be slices of a CT, and the others.

    Parameters
    ----------
    headers : list of SliceHeader
    any_modality : bool
        Whether images that are not CT may be slices too.

    Returns
    -------
    usable : list of SliceHeader
    left : Counter of str
        The others, counted by reason.
    others : list of SliceHeader
        The others themselves.
    """
    usable, left, others = [], Counter[str](), []
    for header in headers:
        reason = _why_not(header, any_modality)
        if reason:
            left[reason] += 1
            others.append(header)
        else:
            usable.append(header)
    return usable, left, others


def join_single_slices(headers: list[SliceHeader]) -> tuple[list[SliceHeader], list[Finding]]:
    """Join images into one series where each says that it is a series of its own, as some anonymisers leave them.

    Parameters
    ----------
    headers : list of SliceHeader
        At least one.

    Returns
    -------
    headers : list of SliceHeader
        In the same order; those that were single have no series.
    findings : list of Finding
        Empty where nothing was joined.
    """
    counts = Counter(header.series for header in headers)
    single = sum(count == 1 for count in counts.values())
    if single < MIN_SLICES or max(counts.values()) >= MIN_SLICES:
        return headers, []
    message = f"Each of {single} slices says that it is a series of its own; they were read as one series."
    joined = [replace(header, series="") if counts[header.series] == 1 else header for header in headers]
    return joined, [Finding("SeriesJoined", "warning", message, {"slices": single})]


def _why_not(header: SliceHeader, any_modality: bool) -> str:
    """Why an image is no slice of a CT; empty where it may be one."""
    if header.samples != 1 or header.photometric not in ("MONOCHROME1", "MONOCHROME2", ""):
        return "colour picture"
    if "LOCALIZER" in header.image_type:
        return "scout view"
    if header.modality not in CT_MODALITIES and not any_modality:
        return "other modality"
    if header.sop_class not in CT_CLASSES and not any_modality:
        return "not a CT image"
    if header.frames > 1 and header.position is None:
        return "film without positions"
    return ""


def nothing_usable(headers: list[SliceHeader], left: Counter[str]) -> InputRefused:
    """The refusal for a folder without CT slices, with what is there instead.

    Parameters
    ----------
    headers : list of SliceHeader
        All images of the folder.
    left : Counter of str
        How many were left, by reason.

    Returns
    -------
    InputRefused
        ``WrongModality`` or ``NoImages``.
    """
    others = sorted({h.modality for h in headers if h.modality not in CT_MODALITIES} & _MODALITIES)
    if left["other modality"]:
        found = ", ".join(others) or "another modality"
        return InputRefused("WrongModality", f"The images are {found}, not CT.", "Give the folder of a head CT.")
    listed = ", ".join(f"{count} x {reason}" for reason, count in sorted(left.items()))
    what = f"The folder holds no CT slices ({listed})." if listed else "The folder holds no DICOM images."
    return InputRefused("NoImages", what, "Give the folder of a head CT in DICOM format.")


def group_alike(headers: list[SliceHeader]) -> list[list[SliceHeader]]:
    """Group images that agree in series, size, kind, orientation and spacing, in file order.

    Parameters
    ----------
    headers : list of SliceHeader

    Returns
    -------
    list of list of SliceHeader

    Notes
    -----
    Each image is compared with those groups only whose geometry is near on one line, found by bisection; so the time
    grows with the number of images, and not with its square.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> axial, turned = np.array([1.0, 0, 0, 0, 1, 0]), np.array([0, 1.0, 0, 0, 0, 1])
    >>> common = {"series": "1", "rows": 4, "cols": 4, "modality": "CT", "image_type": (), "spacing": np.ones(2)}
    >>> images = [SimpleNamespace(orientation=v, **common) for v in (axial, turned, axial + 1e-6)]
    >>> [len(group) for group in group_alike(images)]
    [2, 1]
    """
    groups: list[list[SliceHeader]] = []
    near: dict[object, list[tuple[float, int, tuple[float, ...]]]] = {}
    for header in headers:
        # the first three values say original/derived, primary/secondary and axial/localizer; later ones may vary
        kind = (header.series, header.rows, header.cols, header.modality, header.image_type[:3])
        known = near.setdefault((*kind, header.orientation is None, header.spacing is None), [])
        numbers = _numbers(header)
        at = sum(weight * number for weight, number in zip(_WEIGHTS, numbers, strict=False))
        reach = 1.01 * DIRECTION_TOL * sum(w * (1 + abs(n)) for w, n in zip(_WEIGHTS, numbers, strict=False))
        low, high = bisect_left(known, (at - reach, -1, ())), bisect_right(known, (at + reach, len(headers), ()))
        for _, group, first in known[low:high]:
            if all(abs(a - b) <= DIRECTION_TOL * (1 + abs(b)) for a, b in zip(first, numbers, strict=True)):
                groups[group].append(header)
                break
        else:
            insort(known, (at, len(groups), numbers))
            groups.append([header])
    return groups


def _numbers(header: SliceHeader) -> tuple[float, ...]:
    """An image's orientation and spacing in one; what is no number is a number that none has."""
    parts = [part for part in (header.orientation, header.spacing) if part is not None]
    values = np.concatenate([*parts, [0.0]])
    return tuple(np.where(np.isfinite(values), values, 1e9).tolist())
