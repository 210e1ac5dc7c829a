"""Folder of DICOM files -> the head CT in it: headers first, then a plan, then the pixels.

Patient frame throughout: LPS, mm. Every recovery becomes a finding; what cannot be trusted is refused.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Collection
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InputRefused
from ...grid import Affine, canonical_order
from ...volume import Volume
from ..hu_checks import AIR_HU, as_mask, check_finite, check_hu, clear_padding
from ..load_report import Finding, LoadReport
from ..regrid import resample_planes, slide_slices
from .codecs import LOSSY
from .duplicates import keep_one_per_position
from .geometry import Stack, build_stack
from .parse import MAX_SLICES, UNDEFINED_LENGTH
from .pixel_data import check_format, check_size, holds_unused_bits, read_stack
from .rescale import apply_rescale, check_levels, check_rescale, check_unscaled
from .scan import Contents, leave_unread, scan
from .series_choice import choose_series
from .slice_header import SliceHeader
from .steps import Plan, plan_steps

MAX_BYTES = 2**31  # of the voxels, at two bytes each
_TILT_TOL_DEG = 1.0  # degrees
Progress = Callable[[int, int], None]


def read_dicom(
    path: Path,
    *,
    mask: bool | None = None,
    label: int | None = None,
    allow: Collection[str] = (),
    progress: Progress | None = None,
) -> tuple[Volume, LoadReport]:
    """Read the head CT of a folder, or of one multi-frame file.

    Parameters
    ----------
    path : Path
        Folder, or multi-frame file.
    mask, label, allow
        As for `cranio_nb.readers.read_ct`.
    progress : callable, optional
        Called with (slices done, slices in all).

    Returns
    -------
    volume, report
        As for `cranio_nb.readers.read_ct`.

    Raises
    ------
    InputRefused
        Whatever cannot be read safely.

    Examples
    --------
    >>> from data_synth import write_dicom
    >>> hu = np.full((12, 40, 40), -1000, np.int16)
    >>> hu[:, 10:30, 10:30] = 900
    >>> affine = np.array([[0, 0, 0.5, 0], [0, 0.5, 0, 0], [2.5, 0, 0, 0], [0, 0, 0, 1]])
    >>> files = write_dicom("scan", hu, affine)
    >>> ct, report = read_dicom(Path("scan"))
    >>> bool((ct.voxels == hu).all()), ct.spacing, [finding.code for finding in report.findings]
    (True, array([2.5, 0.5, 0.5]), ['SeriesChosen'])
    """
    # what the headers say: which images are the scan, and in which order
    contents, findings = scan(path)
    series, more = _choose(contents, allow)
    findings += more + leave_unread(contents, series)
    slices, more = keep_one_per_position(series, allow)
    findings += more
    if path.is_file() and len(slices) < 2:
        raise InputRefused("TooFewSlices", "The file holds one slice of a scan.", "Give the folder with all slices.")

    # the plan: where the slices lie, and at which even steps the planes will
    stack = build_stack(slices)
    plan = plan_steps(stack, allow)
    _check_formats(stack, plan)

    # the pixels, and the planes made of them
    voxels, more = _voxels(stack, mask, label, allow, progress)
    findings += [*more, *_remarks(stack), *plan.findings]
    voxels, affine, more = _upright(voxels, stack, plan)
    return _finish(voxels, affine, plan.corner_error, tuple(findings + more))


def _choose(contents: Contents, allow: Collection[str]) -> tuple[list[SliceHeader], list[Finding]]:
    """The slices of the scan; where there are none, the damage is what to say."""
    try:
        return choose_series(contents.headers, allow)
    except InputRefused as error:
        damaged = [unread.error for unread in contents.unread if unread.error is not None]
        if error.code == "NoImages" and damaged:
            raise damaged[0] from None
        raise


def _check_formats(stack: Stack, plan: Plan) -> None:
    """Refuse scans beyond the limits, and pixels that cannot be read, before any is decoded."""
    headers, first = stack.headers, stack.headers[0]
    # an upright volume is wider than tilted slices, and even steps are more than uneven ones
    sides = np.array([first.rows, first.cols]) + np.ceil(np.abs(_slides(stack)).max(axis=0))
    planes = len(headers) if plan.wanted is None else len(plan.wanted)
    n_bytes = int(max(planes, len(headers)) * np.prod(sides) * 2)
    for what, declared, cap in (("slices", len(headers), MAX_SLICES), ("bytes of voxels", n_bytes, MAX_BYTES)):
        if declared > cap:
            message = f"The scan declares {declared} {what}; at most {cap} are read."
            raise InputRefused("LimitExceeded", message, "Export it with fewer or smaller slices.")
    for index, header in enumerate(headers):
        check_format(header, index)


def _voxels(
    stack: Stack, mask: bool | None, label: int | None, allow: Collection[str], progress: Progress | None
) -> tuple[NDArray, list[Finding]]:
    """HU or mask of the slices as they are, shape (N, rows, cols), and what was noticed about the values."""
    pairs, unscaled = check_rescale(stack.headers)
    voxels, findings = _decode(stack, pairs, progress)
    check_finite(voxels)
    bone = as_mask(voxels, mask, label)
    if bone is not None:
        return bone, [f for f in findings if f.code != "Padding"]

    # HU: rescaled, without padding, each slice at the level of the others
    findings = ([check_unscaled(voxels, stack.headers[0].signed, allow)] if unscaled else []) + findings
    voxels, more = clear_padding(voxels)
    findings += more
    levels = np.array([np.percentile(plane[::8, ::8], 1) for plane in voxels])
    findings += check_levels(levels, pairs)
    return voxels, findings + check_hu(voxels, allow)


def _decode(stack: Stack, pairs: NDArray[np.float64], progress: Progress | None) -> tuple[NDArray, list[Finding]]:
    """HU of all slices, shape (N, rows, cols), int16 if every slice can be, and what was noticed."""
    headers = stack.headers
    voxels = np.empty((len(headers), headers[0].rows, headers[0].cols), np.int16)
    n_padded = n_unused = 0
    with warnings.catch_warnings(record=True) as remarks:
        warnings.simplefilter("always")
        for done, (index, pixels) in enumerate(read_stack(headers), start=1):
            n_unused += holds_unused_bits(pixels, headers[index], index)
            hu, padding = apply_rescale(pixels, headers[index], *pairs[index])
            if hu.dtype.kind == "f" and voxels.dtype.kind == "i":
                # once: a slice of whole numbers fits into real ones
                voxels = voxels.astype(np.float32)
            voxels[index] = hu
            n_padded += 0 if padding is None else int(np.count_nonzero(padding))
            if progress:
                progress(done, len(headers))
    return voxels, _decoding(n_padded, n_unused, len(remarks))


def _decoding(n_padded: int, n_unused: int, n_remarks: int) -> list[Finding]:
    """What was noticed while the slices were decoded."""
    findings = []
    if n_padded:
        message = f"{n_padded} pixels of padding were set to {AIR_HU} HU."
        findings.append(Finding("Padding", "corrected", message, {"pixels": n_padded}))
    if n_unused:
        message = f"Bits outside the stored ones were set in {n_unused} slices; they were cleared."
        findings.append(Finding("UnusedBits", "corrected", message, {"slices": n_unused}))
    if n_remarks:
        message = f"The decoder met more data than the images need, or odd ones, {n_remarks} times; they were left."
        findings.append(Finding("DecoderRemarks", "warning", message, {"remarks": n_remarks}))
    return findings


def _remarks(stack: Stack) -> list[Finding]:
    """What to know about the pixels that changes nothing."""
    headers, findings = stack.headers, []
    if any(h.lossy or (h.place and h.place.syntax in LOSSY) for h in headers):
        findings.append(Finding("LossyCompression", "warning", "The pixels were compressed with loss.", {}))
    if any(h.photometric == "MONOCHROME1" for h in headers):
        message = "The pixels are meant to be shown inverted; HU are not."
        findings.append(Finding("Monochrome1", "info", message, {}))
    if len({(h.slope, h.intercept) for h in headers}) > 1:
        message = "The slices have different rescale slopes or intercepts; each was given its own."
        findings.append(Finding("RescaleVaries", "warning", message, {}))
    if len({(h.bits, h.signed, h.photometric) for h in headers}) > 1:
        message = "The slices store their pixels in different ways; each was read in its own."
        findings.append(Finding("PixelFormatVaries", "warning", message, {}))
    excess = sum(
        1 for i, h in enumerate(headers) if h.place and h.place.length != UNDEFINED_LENGTH and check_size(h, h.place, i)
    )
    if excess:
        message = f"{excess} slices hold more bytes of pixels than they announce; these were left."
        findings.append(Finding("ExcessPixels", "warning", message, {"slices": excess}))
    units = {h.rescale_type.upper() for h in headers} - {"", "HU"}
    if units:
        findings.append(Finding("RescaleType", "warning", "The rescaled values are not declared to be HU.", {}))
    return findings + _tilt_remark(stack)


def _tilt_remark(stack: Stack) -> list[Finding]:
    """A warning where the stated tilt of the gantry is neither in the slices' positions nor in their directions."""
    stated = [abs(h.tilt) for h in stack.headers if h.tilt is not None and np.isfinite(h.tilt)]
    if not stated:
        return []
    tilt = float(np.median(stated))
    slid = float(np.degrees(np.arctan(np.linalg.norm(stack.shear))))
    leaning = float(np.degrees(np.arccos(np.clip(np.abs(stack.normal).max(), 0, 1))))
    if min(abs(tilt - slid), abs(tilt - leaning)) <= _TILT_TOL_DEG:
        return []
    message = (
        f"The gantry is said to be tilted by {tilt:.1f} degrees, but by their positions the slices are sheared by "
        f"{slid:.1f}: the head may be sheared."
    )
    return [Finding("TiltUnclear", "warning", message, {"stated_deg": tilt, "found_deg": round(slid, 3)})]


def _upright(voxels: NDArray, stack: Stack, plan: Plan) -> tuple[NDArray, Affine, list[Finding]]:
    """Voxels on an even grid with its affine (plane, row, col) -> mm."""
    # where each slice slides to in its own plane, px
    fill = 0 if voxels.dtype == bool else AIR_HU
    origin, direction, findings = stack.origin, stack.normal + stack.shear, []
    rows, cols = stack.along_rows * stack.spacing[0], stack.along_cols * stack.spacing[1]
    slides = _slides(stack)

    # slid by more than half a pixel in all: shifted back
    if np.ptp(slides, axis=0).max() > 0.5:
        voxels, start = slide_slices(voxels, slides, fill=fill)
        origin, direction = origin + start @ np.stack([rows, cols]), stack.normal
        findings.append(_tilt_finding(stack))
    if plan.wanted is not None:
        voxels = resample_planes(voxels, stack.heights, plan.wanted)

    affine = np.eye(4)
    affine[:3] = np.stack([direction * plan.step, rows, cols, origin], axis=1)
    return voxels, affine, findings


def _slides(stack: Stack) -> NDArray[np.float64]:
    """Where each slice slides to in its own plane, px along (row, col), shape (N, 2)."""
    steps = np.stack([stack.along_rows, stack.along_cols]) * stack.spacing[:, None]
    return stack.heights[:, None] * (stack.shear @ steps.T / stack.spacing**2)


def _tilt_finding(stack: Stack) -> Finding:
    slope = float(np.linalg.norm(stack.shear))
    angle, shift = float(np.degrees(np.arctan(slope))), slope * stack.extent
    message = f"The gantry was tilted by {angle:.1f} degrees; slices were shifted back by up to {shift:.1f} mm."
    return Finding("GantryTilt", "corrected", message, {"degrees": round(angle, 3), "max_shift_mm": round(shift, 3)})


def _finish(
    voxels: NDArray, affine: Affine, corner_error: float, findings: tuple[Finding, ...]
) -> tuple[Volume, LoadReport]:
    """The canonical volume and its report; the stored order is (col, row, slice)."""
    stored = Volume(voxels.transpose(2, 1, 0), affine[:, [2, 1, 0, 3]])
    order = canonical_order(stored.affine)
    volume = stored.reorder(order)
    volume = volume.with_voxels(np.ascontiguousarray(volume.voxels))
    p, r, c = (float(s) for s in volume.spacing)
    kind = "mask" if voxels.dtype == bool else "ct"
    report = LoadReport("DICOM", kind, volume.shape, (p, r, c), corner_error, stored.affine, order, findings)
    return volume, report
