"""What to know of a skull and its openings: how the head lies, how thick the slices are, what is left open -> findings.

Frame: world (mm, LPS).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..readers import Finding
from .head_frame import SURE, HeadFrame
from .opening_choice import JudgedOpening
from .smallest_hole import THICK_MM, smallest_hole_mm

_ODD_DEG = 60.0  # between the head's top and the end called top, beyond any nod or roll on a head rest
_OVER_DEG = 120.0


def orientation_remarks(frame: HeadFrame) -> tuple[Finding, ...]:
    """How the head lies against how the scan says it lies.

    Parameters
    ----------
    frame : HeadFrame

    Returns
    -------
    tuple of Finding
        Empty when both agree.
    """
    values = {"tilt_deg": round(frame.tilt_deg, 1), "confidence": round(frame.confidence, 2)}
    if frame.confidence < SURE:
        return (Finding("HeadAxesUnsure", "info", frame.reason, values),)
    if frame.tilt_deg > _OVER_DEG:
        message = "The end of the scan called top holds the face or the skull base: the head lies upside down."
        return (Finding("HeadUpsideDown", "warning", f"{message} Left and right may be exchanged.", values),)
    if frame.tilt_deg > _ODD_DEG:
        message = f"The head's top points {frame.tilt_deg:.0f} degrees away from the end of the scan called top."
        return (Finding("HeadLiesAside", "warning", message, values),)
    ahead = -frame.axes[1] @ -frame.grid_axes[1]
    if frame.asymmetry == frame.asymmetry and ahead < np.cos(np.radians(_ODD_DEG)):
        message = "The face does not look to the side of the scan called front."
        return (Finding("FaceElsewhere", "info", message, values),)
    return ()


def thickness_remarks(slice_mm: float) -> tuple[Finding, ...]:
    """What slices of a thickness cannot show.

    Parameters
    ----------
    slice_mm : float
        Distance of the slices.

    Returns
    -------
    tuple of Finding
        Empty for thin slices.

    Examples
    --------
    >>> thickness_remarks(1.0)
    ()
    >>> thickness_remarks(5.0)[0].code
    'ThickSlices'
    """
    if slice_mm < THICK_MM:
        return ()
    missed_mm = smallest_hole_mm(slice_mm)
    message = (
        f"The slices are {slice_mm:.1f} mm apart: bone nearly along a slice is blurred into its surroundings, "
        f"and holes narrower than {missed_mm:.0f} mm can be missed. Slices up to 1 mm are best."
    )
    return (Finding("ThickSlices", "warning", message, {"slice_mm": slice_mm, "missed_mm": missed_mm}),)


def opening_remarks(closed: Sequence[JudgedOpening], left_open: Sequence[JudgedOpening]) -> tuple[Finding, ...]:
    """What was closed or left open against the verdict, or in doubt.

    Parameters
    ----------
    closed, left_open : sequence of JudgedOpening
        All openings of a skull.

    Returns
    -------
    tuple of Finding
        ``DoubtfulOpening`` (warning) for each doubtful one that is left open, ``ChosenOpening`` (warning) for each that
        is closed only because it was chosen, ``OpeningAtEdge`` (warning) for each that is closed near the edge of the
        image, ``CutLeftOpen`` (info) for each that was cut and not chosen.
    """
    found = []
    for one in left_open:
        choose = f" To close it, choose it: --opening {one.number}."
        if one.verdict.kind == "doubtful":
            found.append(Finding("DoubtfulOpening", "warning", f"Left open: {one}{choose}", one.record()))
        if one.verdict.kind == "cut":
            found.append(Finding("CutLeftOpen", "info", f"Left open, as it was not chosen: {one}", one.record()))
    for one in closed:
        if one.verdict.kind != "cut":
            found.append(Finding("ChosenOpening", "warning", f"Closed, as it was chosen: {one}", one.record()))
        if one.edge:
            found.append(Finding("OpeningAtEdge", "warning", f"Closed near the edge of the image: {one}", one.record()))
    return tuple(found)
