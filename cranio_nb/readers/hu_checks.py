"""Voxels as read -> are they a CT in HU, or a mask? Checks of the values themselves, which no header can replace."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from ..errors import InputRefused
from .load_report import Finding

AIR_HU = -1024  # HU given to pixels outside the field of view
_SAMPLE = 2_000_000  # voxels from which percentiles are taken


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
        ``ImplausibleHU`` where the darkest voxels are not air, or most voxels are bone.

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
    # what the values are like: their air, their middle and their top
    sample = _sample(hu)
    dark = sample[sample < -500]
    air = float(np.median(dark)) if dark.size >= 0.005 * sample.size else float("nan")
    middle, high = (float(v) for v in np.percentile(sample, (50, 99.9)))
    values = {"median": middle, "p99_9": high, "max": float(hu.max())}

    # a shifted scale moves the air, a stretched one the middle
    wrong = ""
    if not -1100 <= air <= -900:
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
