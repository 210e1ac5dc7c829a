"""Slice headers -> slope and intercept of each slice, or a refusal. HU = stored * slope + intercept."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

from ...errors import InputRefused
from ..load_report import Finding
from .headers import SliceHeader

_SLOPES = (1e-3, 1e3)
_MAX_INTERCEPT = 32768.0  # HU
_AIR_PEAK = (-1200, -900)  # HU of the smallest value in a scan that is already in HU
_JUMP = 300.0  # HU between the air of one slice and that of the others
_REMEDY = "Export the scan again as a plain CT series."


def check_rescale(headers: Sequence[SliceHeader]) -> tuple[NDArray[np.float64], bool]:
    """Slope and intercept of each slice.

    Returns
    -------
    pairs : ndarray, shape (N, 2)
        Slope and intercept; 1 and 0 where no slice has any.
    unscaled : bool
        Whether no slice has any: `check_unscaled` then decides on the values.

    Raises
    ------
    InputRefused
        ``InconsistentRescale`` where some slices have none, ``BadRescale`` where a value is out of range.
    """
    missing = [i for i, h in enumerate(headers) if h.slope is None or h.intercept is None]
    if len(missing) == len(headers):
        return np.tile([1.0, 0.0], (len(headers), 1)), True
    if missing:
        message = f"Slice {missing[0]} has no rescale slope and intercept; the other slices have."
        raise InputRefused("InconsistentRescale", message, _REMEDY)
    pairs = np.array([(h.slope, h.intercept) for h in headers], float)
    for index, (slope, intercept) in enumerate(pairs):
        if not (_SLOPES[0] <= slope <= _SLOPES[1] and abs(intercept) <= _MAX_INTERCEPT):
            message = f"Slice {index} has the rescale slope {slope:g} and intercept {intercept:g}."
            raise InputRefused("BadRescale", message, _REMEDY)
    return pairs, False


def check_unscaled(hu: NDArray, signed: bool, allow: Collection[str] = ()) -> Finding:
    """Whether values without any rescale are HU already: stored with a sign, and air is their minimum.

    Raises
    ------
    InputRefused
        ``MissingRescale``, unless ``"no_rescale"`` is allowed.
    """
    low = float(hu.min())
    if not (signed and _AIR_PEAK[0] <= low <= _AIR_PEAK[1]) and "no_rescale" not in allow:
        raise InputRefused(
            "MissingRescale",
            f"No slice has a rescale slope and intercept, and the smallest stored value is {low:g}: these are not HU.",
            _REMEDY,
        )
    message = f"No slice has a rescale slope and intercept; the stored values (from {low:g}) were taken as HU."
    return Finding("MissingRescale", "warning", message, {"minimum": low})


def check_levels(levels: NDArray[np.float64], pairs: NDArray[np.float64]) -> list[Finding]:
    """Whether the darkest part of each slice (HU, shape (N,)) is as dark as in the others.

    Raises
    ------
    InputRefused
        ``InconsistentRescale`` where a slice is off and its rescale is not that of most slices.
    """
    off = np.flatnonzero(np.abs(levels - np.median(levels)) > _JUMP)
    if not 0 < len(off) <= 0.2 * len(levels):
        return []
    common = np.median(pairs, axis=0)
    strange = [int(i) for i in off if not np.allclose(pairs[i], common)]
    if strange:
        slope, intercept = pairs[strange[0]]
        message = (
            f"Slice {strange[0]} has the rescale slope {slope:g} and intercept {intercept:g}, unlike most slices, and "
            f"its air is then at {levels[strange[0]]:.0f} HU instead of {np.median(levels):.0f}."
        )
        raise InputRefused("InconsistentRescale", message, _REMEDY)
    message = f"The darkest part of {len(off)} slices is over {_JUMP:g} HU away from that of the others."
    return [Finding("LevelJump", "warning", message, {"slices": [int(i) for i in off]})]
