"""Voxels as read -> are they a CT in HU, or a mask? Checks of the values themselves, which no header can replace."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from ..errors import InputRefused
from .load_report import Finding

AIR_HU = -1024  # HU given to pixels outside the field of view
_SAMPLE = 2_000_000  # voxels from which percentiles are taken
_MAX_LABELS = 32  # an image of so few whole values is a map of labels
_AIR_HU, _AIR_OFF_HU, _AIR_WRONG_HU = -1000.0, 60.0, 90.0  # HU: of air; so far off is odd; so far is another scale
_LARGEST_HU = 70_000.0  # HU: 16 bits with a slope of 1, and some more


def is_mask(voxels: NDArray) -> bool:
    """Whether there is nothing but 0 and 1 in the voxels, and both of them.

    Parameters
    ----------
    voxels : ndarray

    Returns
    -------
    bool

    Examples
    --------
    >>> is_mask(np.array([0, 1, 1])), is_mask(np.array([0, 0])), is_mask(np.array([0, 2]))
    (True, False, False)
    """
    if voxels.dtype == bool:
        return True
    if voxels.min() != 0 or voxels.max() != 1:
        return False
    return voxels.dtype.kind in "iu" or bool(((voxels == 0) | (voxels == 1)).all())


def as_mask(voxels: NDArray, mask: bool | None, label: int | None = None) -> NDArray[np.bool_] | None:
    """Take voxels as a mask, where they are one or are said to be.

    Parameters
    ----------
    voxels : ndarray
    mask : bool or None
        True: they are a mask; False: they are HU; None: data of nothing but 0 and 1 are a mask.
    label : int, optional
        Takes the voxels of this value.

    Returns
    -------
    ndarray of bool or None
        Of the same shape; None where they are to be taken as HU.

    Raises
    ------
    InputRefused
        ``NotAMask`` where there are more values than 0 and one other; ``NoSuchLabel``; ``LabelMap`` where a few
        labels are neither a mask nor HU.

    Examples
    --------
    >>> labels = np.array([[[0, 1, 2]]])
    >>> as_mask(labels, None, 2), as_mask(np.array([[[0, 255]]]), True)
    (array([[[False, False,  True]]]), array([[[False,  True]]]))
    >>> as_mask(labels, True)
    Traceback (most recent call last):
    cranio_nb.errors.InputRefused: The image holds the values 0, 1, 2, where a mask holds 0 and one other. ...
    """
    if label is not None:
        chosen = np.asarray(voxels == label)
        if not chosen.any():
            found = _listed(_few_values(voxels))
            raise InputRefused(
                "NoSuchLabel", f"No voxel has the label {label}; the image holds {found}.", "Give one of these."
            )
        return chosen
    if mask or (mask is None and is_mask(voxels)):
        low, high = voxels.min(), voxels.max()
        if voxels.dtype != bool and (low not in (0, high) or not ((voxels == low) | (voxels == high)).all()):
            found = _listed(_few_values(voxels))
            message = f"The image holds {found}, where a mask holds 0 and one other."
            raise InputRefused("NotAMask", message, "Choose the skull by its label (--label), or read it as a CT.")
        return np.asarray(voxels != 0)
    few = _few_values(voxels) if mask is None and voxels.min() >= 0 else []
    if 1 < len(few) <= _MAX_LABELS and all(float(value).is_integer() for value in few):
        message = f"The image holds {_listed(few)}: labels, not HU."
        remedy = "Read it as a mask (--mask)." if len(few) == 2 else "Choose the skull by its label (--label)."
        raise InputRefused("LabelMap", message, remedy)
    return None


def _few_values(voxels: NDArray) -> list[float]:
    """The different values of a selection of voxels, with the extremes of all; one more than `_MAX_LABELS` at most."""
    values = np.unique(np.append(_sample(voxels).ravel(), [voxels.min(), voxels.max()]))
    return [float(value) for value in values[: _MAX_LABELS + 1]]


def _listed(values: list[float]) -> str:
    if len(values) > 6:
        return "many different values"
    return f"the values {', '.join(f'{value:g}' for value in values)}"


def clear_padding(hu: NDArray) -> tuple[NDArray, list[Finding]]:
    """Set padding that no header names to air; the input is kept.

    Padding lies far below air with a clear gap between, fills no more than the corners outside a round field of
    view, and leaves a head with bone. Otherwise the whole scale is off, and the values stay as they are.

    Parameters
    ----------
    hu : ndarray, shape (P, R, C)
        HU; never modified.

    Returns
    -------
    hu : ndarray, shape (P, R, C)
        The same, or a copy with padding at `AIR_HU`.
    findings : list of Finding
        What was set to air; empty where nothing was.

    Examples
    --------
    >>> hu = np.full((4, 10, 10), 40, np.int16)
    >>> hu[:, 4:6, 4:6] = 900
    >>> hu[:, 0, :4] = -3024
    >>> cleared, findings = clear_padding(hu)
    >>> int(cleared.min()), findings[0].code
    (-1024, 'PaddingWithoutTag')
    """
    low = float(hu.min())
    if low > -1500:
        return hu, []
    # how much lies far below air, and how much between
    sample = _sample(hu)
    far, below = float((sample < -1350).mean()), float((sample < -1200).mean())
    if not 1e-3 <= far <= 0.35 or far < 0.9 * below or float((sample > 300).mean()) < 1e-4:
        return hu, []
    message = f"Voxels down to {low:g} HU lie outside the field of view; they were set to {AIR_HU} HU."
    cleared = np.where(hu < -1350, hu.dtype.type(AIR_HU), hu)
    return cleared, [Finding("PaddingWithoutTag", "corrected", message, {"value": low, "fraction": far})]


def check_hu(hu: NDArray, allow: Collection[str] = ()) -> list[Finding]:
    """Check that values are HU of a head: air near -1000, something like bone, nothing impossible.

    Parameters
    ----------
    hu : ndarray
        HU.
    allow : collection of str
        ``"implausible_hu"`` turns the refusal into a warning.

    Returns
    -------
    list of Finding
        Warnings; empty where nothing is odd.

    Raises
    ------
    InputRefused
        ``ImplausibleHU`` where the darkest voxels are not air, or most voxels are bone; ``ImpossibleHU`` where a
        value is beyond what a CT can hold.

    Examples
    --------
    >>> hu = np.full((4, 10, 10), -1000)
    >>> hu[:, 2:8, 2:8] = 900
    >>> hu[:, 3:7, 3:7] = 40
    >>> check_hu(hu)
    []
    >>> check_hu(hu + 1000)
    Traceback (most recent call last):
    cranio_nb.errors.InputRefused: The values are not those of a CT in HU: there is no air, ...
    """
    # beyond what any scanner stores; one such voxel spoils every mean
    low, top = float(hu.min()), float(hu.max())
    if max(-low, top) > _LARGEST_HU:
        message = f"There are values from {low:g} to {top:g} HU; no CT holds such."
        raise InputRefused("ImpossibleHU", message, "Export the scan again from its source.")

    # what the values are like: their air, their middle and their top
    sample = _sample(hu)
    dark = sample[sample < -500]
    air = float(np.median(dark)) if dark.size >= 0.005 * sample.size else float("nan")
    middle, high = (float(v) for v in np.percentile(sample, (50, 99.9)))
    values = {"median": middle, "p99_9": high, "max": top}

    # a shifted scale moves the air, a stretched one the middle
    wrong = ""
    if not abs(air - _AIR_HU) <= _AIR_WRONG_HU:
        found = "there is no air" if np.isnan(air) else f"the darkest voxels are near {air:.0f} HU"
        wrong = f"{found}, where air at -1000 HU is expected"
    elif middle > 300:
        wrong = f"more than half of the voxels are above 300 HU (median {middle:.0f})"
    if wrong and "implausible_hu" not in allow:
        raise InputRefused(
            "ImplausibleHU",
            f"The values are not those of a CT in HU: {wrong}.",
            "Check the source's rescale, read it as a mask, or allow implausible_hu.",
        )

    # odd, but read
    findings = [Finding("ImplausibleHU", "warning", f"The values look unlike HU: {wrong}.", values)] if wrong else []
    if not wrong and abs(air - _AIR_HU) > _AIR_OFF_HU:
        message = f"Air is near {air:.0f} HU instead of -1000: is the scale right?"
        findings.append(Finding("AirLevel", "warning", message, {"air": air}))
    if high <= 300:
        findings.append(Finding("LittleBone", "warning", "Hardly any voxel is above 300 HU: is there bone?", values))
    if high > 4000:
        findings.append(Finding("HighHU", "warning", "There are values above 4000 HU: metal or another scale.", values))
    return findings


def check_finite(voxels: NDArray) -> None:
    """Refuse voxels that are no numbers.

    Parameters
    ----------
    voxels : ndarray

    Raises
    ------
    InputRefused
        ``NonFinite``, with how many there are.

    Examples
    --------
    >>> check_finite(np.array([0.0, np.nan]))
    Traceback (most recent call last):
    cranio_nb.errors.InputRefused: 1 voxels are not finite numbers. Export the scan again.
    """
    if voxels.dtype.kind == "f" and not np.isfinite(voxels).all():
        bad = int((~np.isfinite(voxels)).sum())
        raise InputRefused("NonFinite", f"{bad} voxels are not finite numbers.", "Export the scan again.")


def _sample(voxels: NDArray) -> NDArray:
    """An even selection of voxels, the same each time."""
    # some 64 planes, and of those every so many pixels
    planes = voxels[:: max(1, voxels.shape[0] // 64)]
    step = max(1, int(np.sqrt(planes.size / _SAMPLE)))
    return planes[:, ::step, ::step]
