"""Stack of slices -> the even steps between the planes of the volume, or why there are none. Lengths in mm."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import InputRefused
from ..load_report import Finding
from ..regrid import even_heights, find_missing_gaps
from .geometry import CORNER_TOL_MM, MAX_STEP_MM, MAX_STEP_RATIO, MIN_SLICES, Stack, bad_geometry
from .parse import MAX_SLICES

_MIN_STEP_MM = 0.05
_REMEDY = "A head CT in thin slices, up to 2 mm apart, is best."


@dataclass(frozen=True, eq=False)
class Plan:
    """How the slices become planes.

    Parameters
    ----------
    step : float
        mm between planes.
    wanted : ndarray or None
        Heights in mm to interpolate at; None where the slices are the planes.
    corner_error : float
        Largest distance in mm between a slice's corner by its header and by the affine.
    findings : list of Finding
    """

    step: float
    wanted: NDArray[np.float64] | None
    corner_error: float
    findings: list[Finding]


def plan_steps(stack: Stack, allow: Collection[str] = ()) -> Plan:
    """Plan how the slices become an even stack.

    Parameters
    ----------
    stack : Stack
        One slice per height.
    allow : collection of str
        ``"gap_fill"`` interpolates missing slices.

    Returns
    -------
    Plan
        The step, and the heights to interpolate at where the slices are not even.

    Raises
    ------
    InputRefused
        ``MissingSlices``, ``TooFewSlices``, ``SlicesTooFarApart``, ``UnevenSpacing``, ``BadGeometry``.

    Examples
    --------
    Slices 1 mm apart below and 2 mm apart above are interpolated to 1 mm:

    >>> from data_synth import write_dicom
    >>> from .geometry import build_stack
    >>> from .parse import parse_file
    >>> from .slice_header import read_headers
    >>> heights = np.array([0, 1, 2, 3, 4, 6, 8, 10, 12.0])
    >>> files = write_dicom("scan", np.zeros((9, 4, 4), np.int16), np.eye(4)[[2, 1, 0, 3]], positions=heights)
    >>> stack = build_stack([header for file in files for header in read_headers(*parse_file(file, 0), 0)])
    >>> plan = plan_steps(stack)
    >>> plan.step, len(plan.wanted), [finding.code for finding in plan.findings]
    (1.0, 13, ['UnevenSpacing'])
    """
    # no slice may be missing
    gaps = np.diff(stack.heights)
    gone = find_missing_gaps(stack.heights, [header.instance for header in stack.headers])
    if gone and "gap_fill" not in allow:
        raise _missing(stack, gone, gaps)

    # enough of them, and near enough
    if len(stack.headers) < MIN_SLICES:
        message = f"The series has {len(stack.headers)} slices; at least {MIN_SLICES} are wanted."
        raise InputRefused("TooFewSlices", message, "Give the folder with all slices of a head CT.")
    if gaps.max() > MAX_STEP_MM + 0.02:
        message = f"Slices are up to {gaps.max():.2f} mm apart; at most {MAX_STEP_MM:g} mm are read."
        raise InputRefused("SlicesTooFarApart", message, _REMEDY)
    if gaps.min() < _MIN_STEP_MM:
        raise bad_geometry(f"Two slices are only {gaps.min():.3f} mm apart.")

    # even already, within the tolerance at every corner
    findings = _numbering(stack) + _thickness(stack, float(np.median(gaps)))
    step = stack.extent / (len(stack.headers) - 1)
    error = float(stack.corner_errors(step * np.arange(len(gaps) + 1, dtype=float)).max())
    if error <= CORNER_TOL_MM and np.abs(gaps - step).max() <= max(0.02, 0.005 * step):
        return Plan(step, None, error, findings)
    return _even_plan(stack, gaps, gone, findings)


def _even_plan(stack: Stack, gaps: NDArray[np.float64], gone: list[int], findings: list[Finding]) -> Plan:
    """A plan that interpolates uneven slices to steps of the smallest gap."""
    low, high = float(gaps.min()), float(gaps.max())
    if high > MAX_STEP_RATIO * low and not gone:
        message = f"Slices are between {low:.2f} and {high:.2f} mm apart: too uneven to be interpolated."
        raise InputRefused("UnevenSpacing", message, _REMEDY)
    # the smallest gap gives the step, so that no slice is lost
    wanted = even_heights(stack.heights, low)
    if len(wanted) > MAX_SLICES:
        raise bad_geometry(f"Even steps of {low:.2f} mm would need {len(wanted)} slices.")
    step = float(wanted[1] - wanted[0])
    message = f"Slices {low:.2f} to {high:.2f} mm apart were interpolated to even steps of {step:.3f} mm."
    values = {"min_mm": low, "max_mm": high, "step_mm": step}
    findings = [*findings, Finding("UnevenSpacing", "corrected", message, values)]
    if gone:
        findings.append(_filled(stack, gone, wanted))
    return Plan(step, wanted, float(stack.corner_errors(stack.heights).max()), findings)


def _filled(stack: Stack, gone: list[int], wanted: NDArray[np.float64]) -> Finding:
    """Which planes (of the stack, from below) hold interpolated data only."""
    ranges = [(float(stack.heights[i]), float(stack.heights[i + 1])) for i in gone]
    planes = [k for k, h in enumerate(wanted) if any(a + 1e-3 < h < b - 1e-3 for a, b in ranges)]
    places = "1 place" if len(gone) == 1 else f"{len(gone)} places"
    message = f"Missing slices were filled by interpolation at {places}: do not design across them."
    return Finding("GapsFilled", "warning", message, {"planes_from_below": planes, "heights_mm": ranges})


def _missing(stack: Stack, gone: list[int], gaps: NDArray[np.float64]) -> InputRefused:
    """The refusal for missing slices, with the places where they are missed."""
    base = float(np.median(gaps))
    positions = [float(np.asarray(stack.headers[i].position)[2]) for i in gone]
    listed = ", ".join(
        f"after slice {i} (z = {z:.1f} mm, {gaps[i]:.2f} mm wide)" for i, z in zip(gone[:4], positions, strict=False)
    )
    more = f" and {len(gone) - 4} more places" if len(gone) > 4 else ""
    message = f"Slices are missing {listed}{more}; the others are {base:.2f} mm apart."
    return InputRefused("MissingSlices", message, "Export the complete series again.")


def _numbering(stack: Stack) -> list[Finding]:
    """A remark where slice numbers do not run from 1 without holes: slices may be missing."""
    numbers = _numbers(stack)
    if not numbers or (numbers[0] in (0, 1) and numbers[-1] - numbers[0] == len(numbers) - 1):
        return []
    message = f"{len(numbers)} slices are numbered from {numbers[0]} to {numbers[-1]}: some may be missing."
    values = {"first": numbers[0], "last": numbers[-1], "slices": len(numbers)}
    return [Finding("SliceNumbers", "warning", message, values)]


def _numbers(stack: Stack) -> list[int]:
    """The slices' own numbers in rising order; empty where not every slice has one."""
    numbers = sorted(h.instance for h in stack.headers if h.instance is not None)
    return numbers if len(numbers) == len(stack.headers) else []


def _thickness(stack: Stack, step: float) -> list[Finding]:
    """Remarks where steps do not fit thickness and pixels; a refusal where slice numbers say that slices are gone."""
    thick = max((h.thickness for h in stack.headers if h.thickness is not None and h.thickness > 0), default=step)
    values = {"step_mm": step, "thickness_mm": thick, "pixel_mm": float(stack.spacing.min())}
    message = f"Slices are {step:.2f} mm apart but {thick:.2f} mm thick"
    # steps far below the thickness: positions in another unit, or slices that overlap
    if step < 0.2 * max(thick, values["pixel_mm"]):
        message += f" with pixels of {values['pixel_mm']:.2f} mm: are the positions in mm?"
        return [Finding("SmallSteps", "warning", message, values)]
    if step <= 1.5 * thick:
        return []
    if _numbers(stack) and np.diff(_numbers(stack)).min() > 1:
        raise InputRefused("MissingSlices", f"{message}, and their numbers jump.", "Export the complete series again.")
    return [Finding("ThinSlices", "warning", f"{message}: there are gaps between them.", values)]
