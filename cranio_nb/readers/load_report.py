"""What reading a scan found, chose, skipped and corrected: the load report. It never holds patient text."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

from ..grid import Affine, AxisOrder


@dataclass(frozen=True)
class Finding:
    """One thing a reader noticed.

    Parameters
    ----------
    code : str
        Stable CamelCase name, e.g. ``"GantryTilt"``.
    severity : {"info", "corrected", "warning"}
        "info": chosen or skipped, nothing changed. "corrected": the data was changed to be right. "warning":
        to be checked by a person.
    message : str
        One plain sentence.
    values : dict
        Numbers behind the sentence, JSON-able.
    """

    code: str
    severity: str
    message: str
    values: dict[str, Any] = field(default_factory=dict)


def warnings_of(findings: Iterable[Finding], what: str = "") -> tuple[Finding, ...]:
    """Those findings that a person has to check.

    Parameters
    ----------
    findings : iterable of Finding
    what : str
        What was read, named before each sentence; nothing when empty.

    Returns
    -------
    tuple of Finding

    Examples
    --------
    >>> found = Finding("ThickSlices", "warning", "The slices are thick."), Finding("OneSeries", "info", "One series.")
    >>> [one.message for one in warnings_of(found, "truth.nii.gz")]
    ['truth.nii.gz: The slices are thick.']
    """
    said = f"{what}: " if what else ""
    return tuple(replace(one, message=said + one.message) for one in findings if one.severity == "warning")


@dataclass(frozen=True, eq=False)
class LoadReport:
    """How a file or folder became a `Volume`.

    Parameters
    ----------
    source : {"DICOM", "NIfTI", "NRRD"}
        Kind of the input.
    kind : {"ct", "mask"}
        HU volume, or 0/1 data.
    shape : tuple of int
        (P, R, C) of the volume returned.
    spacing : tuple of float
        mm along (plane, row, col).
    corner_error : float
        Largest distance in mm between slice corners by the headers and by the affine (0 where the file has an affine).
    stored_affine : ndarray, shape (4, 4)
        Index -> world mm (LPS) of the grid in the file's own axis order.
    order : AxisOrder
        How the stored axes became (plane, row, col); its inverse brings a patch back onto the input's own grid.
    findings : tuple of Finding
        In the order met.
    """

    source: str
    kind: str
    shape: tuple[int, int, int]
    spacing: tuple[float, float, float]
    corner_error: float
    stored_affine: Affine
    order: AxisOrder
    findings: tuple[Finding, ...] = ()
