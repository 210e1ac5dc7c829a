"""NIfTI or NRRD file -> `Volume` and its report. Only the declared number of bytes is ever read or inflated.

World is DICOM LPS, mm: NIfTI counts x and y the other way round, NRRD says how it counts.
"""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InputRefused
from ..grid import canonical_order
from ..volume import Volume
from .hu_checks import AIR_HU, as_mask, check_finite, check_hu, clear_padding
from .load_report import Finding, LoadReport
from .regrid import slide_slices
from .stored_image import Image

_SPACING_RANGE_MM = (0.1, 10.0)  # mm
_MAX_STEP_MM = 5.02  # mm between planes, as for DICOM
_MIN_PLANES = 8  # along each axis, as for DICOM
_FARTHEST_MM = 1e4  # mm: no scanner is so large, and single precision still tells 0.001 mm apart there
_CORNER_TOL_MM = 0.05  # mm


def read_image(
    path: Path, *, mask: bool | None = None, label: int | None = None, allow: Collection[str] = ()
) -> tuple[Volume, LoadReport]:
    """Read one NIfTI or NRRD file.

    Parameters
    ----------
    path : Path
        A .nii, .nii.gz or .nrrd file, known by its first bytes.
    mask, label, allow
        As for `cranio_nb.readers.read_ct`.

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
    NIfTI counts x to the right and y to the front; world here is LPS:

    >>> import nibabel
    >>> mask = np.zeros((8, 9, 10), np.uint8)
    >>> mask[1, 2, 3] = 1
    >>> nibabel.save(nibabel.Nifti1Image(mask, np.eye(4)), "mask.nii.gz")
    >>> bone, report = read_image(Path("mask.nii.gz"))
    >>> report.kind, bone.to_world(np.argwhere(bone.voxels))
    ('mask', array([[-1., -2.,  3.]]))
    """
    # each format's library is loaded only where it is needed
    with open(path, "rb") as stream:
        start = stream.read(352)
        stream.seek(0)
        if start.startswith(b"NRRD000"):
            from .nrrd import read_nrrd as read
        elif start[:2] == b"\x1f\x8b" or start[344:348] in (b"n+1\0", b"ni1\0") or start[4:8] in (b"n+2\0", b"ni2\0"):
            from .nifti import read_nifti as read
        else:
            message = "The file is neither DICOM nor NIfTI nor NRRD."
            raise InputRefused("UnsupportedFile", message, "Give a DICOM folder, or a .nii, .nii.gz or .nrrd file.")
        image = read(stream, allow)
    check_grid(image)
    voxels, findings = _values(image, mask, label, allow)
    return _finish(image, voxels, [*image.findings, *findings])


def check_grid(image: Image) -> None:
    """Refuse an affine that is not finite and invertible, or voxels of an impossible size.

    Parameters
    ----------
    image : Image

    Raises
    ------
    InputRefused
        ``BadGeometry``; ``BadShape`` for a single plane; ``TooFewSlices``, ``SlicesTooFarApart``.
    """
    matrix, remedy = image.affine[:3, :3], "Convert the file again from its source."
    if not np.isfinite(image.affine).all() or abs(np.linalg.det(matrix)) < 1e-9:
        raise InputRefused("BadGeometry", "The file's affine is not finite and invertible.", remedy)
    spacing, (low, high) = np.linalg.norm(matrix, axis=0), _SPACING_RANGE_MM
    if spacing.min() < low or spacing.max() > high:
        listed = " x ".join(f"{s:.4g}" for s in spacing)
        message = f"Voxels measure {listed} mm; {low:g} to {high:g} mm are wanted."
        raise InputRefused("BadGeometry", message, f"{remedy[:-1]}, and check its units.")
    if spacing.max() > _MAX_STEP_MM:
        message = f"Planes are {spacing.max():.2f} mm apart; at most 5 mm are read."
        raise InputRefused("SlicesTooFarApart", message, "A head CT in thin slices, up to 2 mm apart, is best.")
    if min(image.raw.shape) < 2:
        raise InputRefused("BadShape", f"The image has the shape {image.raw.shape}; a volume is wanted.", remedy)
    if min(image.raw.shape) < _MIN_PLANES:
        message = (
            f"The image has the shape {image.raw.shape}; at least {_MIN_PLANES} planes are wanted along each axis."
        )
        raise InputRefused("TooFewSlices", message, "Give a volume with all slices of a head.")
    far = np.abs(image.affine[:3, 3]).max()
    if far > _FARTHEST_MM:
        message = f"The image's origin is {far:.3g} mm away; at most {_FARTHEST_MM:g} mm are read."
        raise InputRefused("BadGeometry", message, remedy)


def _values(
    image: Image, mask: bool | None, label: int | None, allow: Collection[str]
) -> tuple[NDArray, list[Finding]]:
    """HU or mask on the file's own axes, and what was noticed."""
    check_finite(image.raw)
    scaled = (image.slope, image.intercept) != (1.0, 0.0)
    hu = _scaled(image.raw, image.slope, image.intercept) if scaled else image.raw
    bone = as_mask(hu, mask, label)
    if bone is not None:
        return bone, []
    hu, findings = clear_padding(_compact(hu))
    return hu, findings + check_hu(hu, allow)


def _scaled(raw: NDArray, slope: float, intercept: float) -> NDArray:
    """The values: whole numbers stay whole, as long as none can pass the range of whole numbers."""
    small = raw.itemsize <= 4 and abs(slope) < 2**14 and abs(intercept) < 2**30
    if small and raw.dtype.kind in "iu" and slope.is_integer() and intercept.is_integer():
        wide = np.int32 if raw.itemsize <= 2 else np.int64
        return raw.astype(wide) * int(slope) + int(intercept)
    # plane by plane, so that no second volume in double precision is made
    values = np.empty_like(raw, dtype=np.float32)
    with np.errstate(over="ignore"):
        for plane, scaled in zip(raw.T, values.T, strict=True):
            scaled[...] = plane * slope + intercept
    return values


def _compact(hu: NDArray) -> NDArray:
    """int16 where all values are whole and fit, else float32."""
    # whole numbers may be stored as real ones
    info = np.iinfo(np.int16)
    if info.min <= hu.min() and hu.max() <= info.max:
        whole = hu.astype(np.int16)
        # plane by plane, so that no second volume is made for the comparison
        if hu.dtype.kind in "iu" or all(map(np.array_equal, whole.T, hu.T)):
            return whole
    with np.errstate(over="ignore"):
        return hu.astype(np.float32, copy=False)


def _finish(image: Image, voxels: NDArray, findings: list[Finding]) -> tuple[Volume, LoadReport]:
    """The upright volume on the package's axes, and the report."""
    # axes permuted and flipped into the package's order
    stored = Volume(voxels, image.affine)
    order = canonical_order(image.affine)
    volume = stored.reorder(order)
    volume = volume.with_voxels(np.ascontiguousarray(volume.voxels))
    upright, more = _upright(volume)
    stored_affine = image.affine if upright is volume else upright.reorder(order.inverse).affine
    p, r, c = (float(s) for s in upright.spacing)
    kind = "mask" if voxels.dtype == bool else "ct"
    report = LoadReport(image.source, kind, upright.shape, (p, r, c), 0.0, stored_affine, order, tuple(findings + more))
    return upright, report


def _upright(volume: Volume) -> tuple[Volume, list[Finding]]:
    """A volume whose planes lie straight above each other: a sheared one has its planes shifted back."""
    planes, rows, cols = volume.affine[:3, :3].T
    spacing = volume.spacing
    if abs(rows @ cols) / (spacing[1] * spacing[2]) * max(volume.shape[1:]) * spacing[1:].max() > _CORNER_TOL_MM:
        message = "The rows and columns of the file's affine are not at right angles."
        raise InputRefused("BadGeometry", message, "Resample the image onto a straight grid.")

    # how far each plane slides against the one below, in px along rows and columns
    in_plane = np.stack([rows, cols])
    slide = in_plane @ planes / spacing[1:] ** 2
    count = volume.shape[0]
    if np.abs(slide).max() * (count - 1) <= 0.5:
        return volume, []

    # the planes shifted back, and the plane axis set upright
    fill = 0 if volume.voxels.dtype == bool else AIR_HU
    voxels, start = slide_slices(volume.voxels, np.arange(count)[:, None] * slide, fill=fill)
    affine = volume.affine.copy()
    affine[:3, 0] = planes - slide @ in_plane
    affine[:3, 3] += start @ in_plane
    angle = float(np.degrees(np.arccos(np.clip(np.linalg.norm(affine[:3, 0]) / spacing[0], -1, 1))))
    message = f"The planes were sheared by {angle:.1f} degrees; they were shifted back onto a straight grid."
    return Volume(voxels, affine), [Finding("Sheared", "corrected", message, {"degrees": round(angle, 3)})]
