"""Folder of DICOM files -> the head CT in it: headers first, then a plan, then the pixels.

Patient frame throughout: LPS, mm. Every recovery becomes a finding; what cannot be trusted is refused.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InputRefused
from ...grid import Affine, canonical_order
from ...volume import Volume
from ..hu_checks import AIR_HU, check_finite, check_hu, clear_padding, is_mask
from ..load_report import Finding, LoadReport
from ..regrid import resample_planes, slide_slices
from .codecs import LOSSY
from .duplicates import keep_one_per_position
from .file_list import IMAGE_SUFFIXES, list_files
from .geometry import Stack, build_stack
from .parse import MAX_SLICES, parse_file
from .pixel_data import check_format, read_pixels
from .rescale import apply_rescale, check_levels, check_rescale, check_unscaled
from .series_choice import choose_series
from .slice_header import SliceHeader, read_headers
from .steps import Plan, plan_steps

MAX_BYTES = 2**31  # of the voxels
Progress = Callable[[int, int], None]


def read_dicom(
    path: Path, *, mask: bool | None = None, allow: Collection[str] = (), progress: Progress | None = None
) -> tuple[Volume, LoadReport]:
    """Read the head CT of a folder, or of one multi-frame file.

    Parameters
    ----------
    path : Path
        Folder, or multi-frame file.
    mask, allow
        As for `cranio_nb.readers.read_ct`.
    progress : callable, optional
        Called with (slices done, slices in all).

    Returns
    -------
    volume : Volume
        HU as int16 or float32, or bool for a mask; planes up, rows back, columns left.
    report : LoadReport

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
    headers, findings = _all_headers(path)
    series, more = choose_series(headers, allow)
    findings += more
    slices, more = keep_one_per_position(series, allow)
    findings += more
    if path.is_file() and len(slices) < 2:
        raise InputRefused("TooFewSlices", "The file holds one slice of a scan.", "Give the folder with all slices.")

    # the plan: where the slices lie, and at which even steps the planes will
    stack = build_stack(slices)
    plan = plan_steps(stack, allow)
    _check_formats(stack)

    # the pixels, and the planes made of them
    voxels, more = _voxels(stack, mask, allow, progress)
    findings += [*more, *_remarks(stack), *plan.findings]
    voxels, affine, more = _upright(voxels, stack, plan)
    return _finish(voxels, affine, plan.corner_error, tuple(findings + more))


def _all_headers(path: Path) -> tuple[list[SliceHeader], list[Finding]]:
    """Headers of all images of a folder or file, and what else lies there."""
    files, findings = ([path], []) if path.is_file() else list_files(path)
    headers: list[SliceHeader] = []
    others: list[Path] = []
    empty = 0
    for index, file in enumerate(files):
        scanned = parse_file(file, index)
        images = read_headers(*scanned, index) if scanned else []
        headers += images
        if scanned is None:
            others.append(file)
        elif not images:
            empty += 1
    if others:
        misnamed = any(file.suffix.lower() in IMAGE_SUFFIXES for file in others)
        message = f"{len(others)} of {len(files)} files are not DICOM and were left."
        findings.append(Finding("FilesSkipped", "warning" if misnamed else "info", message, {"not_dicom": len(others)}))
    if empty:
        message = f"{empty} of {len(files)} files hold no image and were left."
        findings.append(Finding("FilesSkipped", "info", message, {"no_image": empty}))
    return headers, findings


def _check_formats(stack: Stack) -> None:
    """Refuse scans beyond the limits, and pixels that cannot be read, before any is decoded."""
    headers, first = stack.headers, stack.headers[0]
    n_bytes = len(headers) * first.rows * first.cols * 2
    for what, declared, cap in (("slices", len(headers), MAX_SLICES), ("bytes of voxels", n_bytes, MAX_BYTES)):
        if declared > cap:
            message = f"The scan declares {declared} {what}; at most {cap} are read."
            raise InputRefused("LimitExceeded", message, "Export it with fewer or smaller slices.")
    for index, header in enumerate(headers):
        check_format(header, index)


def _voxels(
    stack: Stack, mask: bool | None, allow: Collection[str], progress: Progress | None
) -> tuple[NDArray, list[Finding]]:
    """HU or mask of the slices as they are, shape (N, rows, cols), and what was noticed about the values."""
    pairs, unscaled = check_rescale(stack.headers)
    voxels, padded = _decode(stack, pairs, progress)
    check_finite(voxels)
    if mask or (mask is None and is_mask(voxels)):
        return voxels != 0, []

    # HU: rescaled, without padding, each slice at the level of the others
    findings = [check_unscaled(voxels, stack.headers[0].signed, allow)] if unscaled else []
    if padded:
        message = f"{padded} pixels of padding were set to {AIR_HU} HU."
        findings.append(Finding("Padding", "corrected", message, {"pixels": padded}))
    voxels, more = clear_padding(voxels)
    findings += more
    levels = np.array([np.percentile(plane[::8, ::8], 1) for plane in voxels])
    findings += check_levels(levels, pairs)
    return voxels, findings + check_hu(voxels, allow)


def _decode(stack: Stack, pairs: NDArray[np.float64], progress: Progress | None) -> tuple[NDArray, int]:
    """HU of all slices, shape (N, rows, cols), int16 if every slice can be, and the number of padding pixels."""
    headers = stack.headers
    voxels = np.empty((len(headers), headers[0].rows, headers[0].cols), np.int16)
    padded = 0
    for index, (header, (slope, intercept)) in enumerate(zip(headers, pairs, strict=True)):
        hu, padding = apply_rescale(read_pixels(header, index), header, slope, intercept)
        if hu.dtype != voxels.dtype:
            voxels = voxels.astype(np.float32)
        voxels[index] = hu
        padded += 0 if padding is None else int(np.count_nonzero(padding))
        if progress:
            progress(index + 1, len(headers))
    return voxels, padded


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
    units = {h.rescale_type.upper() for h in headers} - {"", "HU"}
    if units:
        findings.append(Finding("RescaleType", "warning", "The rescaled values are not declared to be HU.", {}))
    return findings


def _upright(voxels: NDArray, stack: Stack, plan: Plan) -> tuple[NDArray, Affine, list[Finding]]:
    """Voxels on an even grid with its affine (plane, row, col) -> mm."""
    # where each slice slides to in its own plane, px
    fill = 0 if voxels.dtype == bool else AIR_HU
    origin, direction, findings = stack.origin, stack.normal + stack.shear, []
    rows, cols = stack.along_rows * stack.spacing[0], stack.along_cols * stack.spacing[1]
    slides = stack.heights[:, None] * (stack.shear @ np.stack([rows, cols]).T / stack.spacing**2)

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
