"""Stored numbers of each slice -> HU: slope and intercept are checked over the whole scan, then applied.

HU = stored * slope + intercept (DICOM PS3.3, C.11.1.1.2). A wrong pair gives plausible pictures and wrong bone, so
what cannot be trusted is refused.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import NDArray

from ...errors import InputRefused
from ..hu_checks import AIR_HU
from ..load_report import Finding
from .pixel_data import clear_unused_bits
from .slice_header import SliceHeader

_SLOPES = (1e-3, 1e3)
_MAX_INTERCEPT_HU = 32768.0  # HU
_AIR_PEAK_HU = (-1200, -900)  # HU of the smallest value in a scan that is already in HU
_JUMP_HU = 300.0  # HU between the air of one slice and that of the others
_REMEDY = "Export the scan again as a plain CT series."


def check_rescale(headers: Sequence[SliceHeader]) -> tuple[NDArray[np.float64], bool]:
    """Check slope and intercept of each slice.

    Parameters
    ----------
    headers : sequence of SliceHeader
        N slices of one scan.

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

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> slices = [SimpleNamespace(slope=1.0, intercept=-1024.0)] * 2
    >>> pairs, unscaled = check_rescale(slices)
    >>> pairs.tolist(), unscaled
    ([[1.0, -1024.0], [1.0, -1024.0]], False)
    """
    missing = [i for i, h in enumerate(headers) if h.slope is None or h.intercept is None]
    if len(missing) == len(headers):
        return np.tile([1.0, 0.0], (len(headers), 1)), True
    if missing:
        message = f"Slice {missing[0]} has no rescale slope and intercept; the other slices have."
        raise InputRefused("InconsistentRescale", message, _REMEDY)
    pairs = np.array([(h.slope, h.intercept) for h in headers], float)
    for index, (slope, intercept) in enumerate(pairs):
        if not (_SLOPES[0] <= slope <= _SLOPES[1] and abs(intercept) <= _MAX_INTERCEPT_HU):
            message = f"Slice {index} has the rescale slope {slope:g} and intercept {intercept:g}."
            raise InputRefused("BadRescale", message, _REMEDY)
    return pairs, False


def check_unscaled(hu: NDArray, signed: bool, allow: Collection[str] = ()) -> Finding:
    """Check that values without any rescale are HU already: stored with a sign, and air is their minimum.

    Parameters
    ----------
    hu : ndarray
        Stored numbers of all slices.
    signed : bool
        Whether they are stored with a sign.
    allow : collection of str
        ``"no_rescale"`` takes them as HU in any case.

    Returns
    -------
    Finding
        A warning that the numbers were taken as HU.

    Raises
    ------
    InputRefused
        ``MissingRescale``, unless allowed.

    Examples
    --------
    >>> check_unscaled(np.array([-1000, 40, 900]), signed=True).code
    'MissingRescale'
    """
    low = float(hu.min())
    if not (signed and _AIR_PEAK_HU[0] <= low <= _AIR_PEAK_HU[1]) and "no_rescale" not in allow:
        raise InputRefused(
            "MissingRescale",
            f"No slice has a rescale slope and intercept, and the smallest stored value is {low:g}: these are not HU.",
            _REMEDY,
        )
    message = f"No slice has a rescale slope and intercept; the stored values (from {low:g}) were taken as HU."
    return Finding("MissingRescale", "warning", message, {"minimum": low})


def check_levels(levels: NDArray[np.float64], pairs: NDArray[np.float64]) -> list[Finding]:
    """Check that the darkest part of each slice is as dark as in the others.

    Parameters
    ----------
    levels : ndarray, shape (N,)
        HU of the darkest part of each slice.
    pairs : ndarray, shape (N, 2)
        Slope and intercept of each slice.

    Returns
    -------
    list of Finding
        A warning for slices that are off with the rescale of the others; empty where none is, or where so many are
        that none is the exception.

    Raises
    ------
    InputRefused
        ``InconsistentRescale`` where a slice is off and its rescale is not that of most slices.

    Examples
    --------
    >>> pairs = np.tile([1.0, -1024.0], (10, 1))
    >>> check_levels(np.full(10, -1000.0), pairs)
    []
    >>> [finding.code for finding in check_levels(np.array([-500.0] + 9 * [-1000.0]), pairs)]
    ['LevelJump']
    """
    off = np.flatnonzero(np.abs(levels - np.median(levels)) > _JUMP_HU)
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
    message = f"The darkest part of {len(off)} slices is over {_JUMP_HU:g} HU away from that of the others."
    return [Finding("LevelJump", "warning", message, {"slices": [int(i) for i in off]})]


def apply_rescale(
    stored: NDArray[np.integer], header: SliceHeader, slope: float, intercept: float
) -> tuple[NDArray, NDArray[np.bool_] | None]:
    """Turn the stored numbers of one slice into HU, and its padding into air.

    Parameters
    ----------
    stored : ndarray, shape (rows, cols)
        From `pixel_data.read_pixels`.
    header : SliceHeader
        Of the slice: its bits and its padding.
    slope, intercept : float
        The slice's own rescale.

    Returns
    -------
    hu : ndarray, shape (rows, cols)
        int16 where slope and intercept are whole numbers and the values fit, else float32. Never inverted: the
        photometric interpretation only concerns displays.
    padding : ndarray of bool, shape (rows, cols), or None
        Where the slice was padded; None where it says of no padding.

    Notes
    -----
    HU = stored * slope + intercept.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> header = SimpleNamespace(padding=None, bits=(16, 16, 15))
    >>> hu, _ = apply_rescale(np.array([[0, 1024, 2024]], np.uint16), header, 1.0, -1024.0)
    >>> hu, hu.dtype.name
    (array([[-1024,     0,  1000]], dtype=int16), 'int16')
    """
    # padding is declared in stored numbers, before any bit is cleared
    padding = None
    if header.padding is not None and _is_padding(header.padding, slope, intercept):
        low, high = header.padding
        padding = (stored >= low) & (stored <= high)

    # whole numbers stay whole numbers, in 16 bits
    values = clear_unused_bits(stored, header)
    whole = float(slope).is_integer() and float(intercept).is_integer()
    if not whole or not _fits(values, slope, intercept):
        hu: NDArray = (values * slope + intercept).astype(np.float32)
    elif slope == 1:
        hu = (values + np.int32(intercept)).astype(np.int16)
    else:
        hu = (values.astype(np.int64) * int(slope) + int(intercept)).astype(np.int16)

    if padding is not None:
        hu[padding] = AIR_HU
    return hu, padding


def _is_padding(stored: tuple[float, float], slope: float, intercept: float) -> bool:
    """Whether a declared range of padding lies outside the values of a head; inside, it would cut holes into it."""
    low, high = sorted(value * slope + intercept for value in stored)
    return high <= -900 or low > 4000


def _fits(values: NDArray[np.integer], slope: float, intercept: float) -> bool:
    """Whether all HU fit into int16."""
    ends = (int(values.min()) * slope + intercept, int(values.max()) * slope + intercept)
    return min(ends) >= -32768 and max(ends) <= 32767
