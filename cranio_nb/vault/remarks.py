"""What to know before a skull is designed on: how the head lies and how thick the slices are -> findings.

Frame: world (mm, LPS).
"""

from __future__ import annotations

import numpy as np

from ..readers import Finding
from ..volume import Volume
from .head_frame import SURE, HeadFrame

_ODD_DEG = 60.0  # between the head's top and the end called top, beyond any nod or roll on a head rest
_OVER_DEG = 120.0
_THICK_MM = 2.9  # a slice as thick as the vault's thin places is wide: 3 mm, and what is rounded to it


def remarks(bone: Volume, frame: HeadFrame) -> tuple[Finding, ...]:
    """What the bone and its grid show.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    frame : HeadFrame
        How the head lies.

    Returns
    -------
    tuple of Finding
    """
    return (*orientation_remarks(frame), *thickness_remarks(float(bone.spacing[0])))


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
    if slice_mm < _THICK_MM:
        return ()
    message = (
        f"The slices are {slice_mm:.1f} mm apart: bone nearly along a slice is blurred into its surroundings, "
        f"and holes narrower than {2 * slice_mm:.0f} mm can be missed. Slices up to 1 mm are best."
    )
    return (Finding("ThickSlices", "warning", message, {"slice_mm": slice_mm}),)
