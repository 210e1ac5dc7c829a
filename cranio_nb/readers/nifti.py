"""NIfTI stream -> `Image`: nibabel reads the header, the voxels are read here, bounded by what it declares."""

from __future__ import annotations

import warnings
from collections.abc import Collection
from typing import Any, BinaryIO, cast

import numpy as np
from zlib_ng import gzip_ng

from ..errors import InputRefused
from ..grid import Affine
from .load_report import Finding
from .stored_image import (
    GZIP_PACKING,
    NOT_UNPACKED,
    Image,
    check_promise,
    check_shape,
    no_orientation,
    read_voxels,
    stored_bytes,
)

_MM_PER_UNIT = {0: 1.0, 1: 1000.0, 2: 1.0, 3: 1e-3}  # unknown, metre, mm, micrometre (xyzt_units & 7)
_LPS = np.diag([-1.0, -1.0, 1.0, 1.0])  # NIfTI: x to the right, y to the front
_UNPACK = "Give a .nii or .nii.gz file, or unpack an archive first."
_MAX_OFFSET = 2**24  # bytes of header extensions


def read_nifti(stream: BinaryIO, allow: Collection[str] = ()) -> Image:
    """Read a single-file NIfTI-1 or NIfTI-2, compressed or not.

    Parameters
    ----------
    stream : binary stream
        The whole file.
    allow : collection of str
        ``"no_orientation"`` takes a file without orientation as it lies.

    Returns
    -------
    Image

    Raises
    ------
    InputRefused
        ``CorruptFile``, ``UnsupportedFile``, ``UnsupportedPixels``, ``BadShape``, ``LimitExceeded``,
        ``NoOrientation`` or ``BadGeometry``.

    Examples
    --------
    >>> import io
    >>> import nibabel
    >>> file = nibabel.Nifti1Image(np.zeros((4, 5, 6), np.int16), np.diag([2.0, 2, 3, 1]))
    >>> image = read_nifti(io.BytesIO(file.to_bytes()))
    >>> image.raw.shape, image.affine.diagonal()
    ((4, 5, 6), array([-2., -2.,  3.,  1.]))
    """
    # the header, and as many voxels as it declares
    packed, size = stream.read(2) == b"\x1f\x8b", stored_bytes(stream)
    stream.seek(0)
    data = cast(BinaryIO, gzip_ng.GzipFile(fileobj=stream)) if packed else stream
    try:
        header = _header(data)
        shape = check_shape([int(n) for n in header.get_data_shape()])
        dtype = _dtype(header)
        offset = _offset(header)
        count = int(np.prod(shape)) * dtype.itemsize
        check_promise(count, size if packed else size - offset, packing=GZIP_PACKING if packed else 1)
        data.seek(offset)
        content, rest = read_voxels(data, count)
    except NOT_UNPACKED as error:
        raise _corrupt(f"it cannot be unpacked ({type(error).__name__})") from None

    # index -> LPS mm, and the scaling of the numbers
    affine, findings = _affine(header, allow)
    slope, intercept, more = _scaling(header)
    raw = np.frombuffer(content, dtype)
    native = raw.reshape(shape, order="F").astype(dtype.newbyteorder("="), copy=False)
    return Image("NIfTI", native, affine, slope, intercept, tuple(findings + more + rest))


def _header(data: BinaryIO) -> Any:
    """The header of a file that holds its own voxels."""
    import nibabel as nib
    from nibabel.imageglobals import LoggingOutputSuppressor
    from nibabel.spatialimages import HeaderDataError

    # two files, one file, or none of NIfTI
    start = data.read(540)
    data.seek(0)
    if start[344:347] == b"ni1" or start[4:7] == b"ni2":
        message = "The voxels of this NIfTI file lie in a second file."
        raise InputRefused("UnsupportedFile", message, "Give a single .nii or .nii.gz file.")
    kind = {b"n+1\0": nib.Nifti1Header, b"n+2\0": nib.Nifti2Header}.get(start[344:348], None)
    kind = kind or {b"n+2\0": nib.Nifti2Header}.get(start[4:8])
    if kind is None:
        raise InputRefused("UnsupportedFile", "The packed file is no NIfTI image.", _UNPACK)
    try:
        # what nibabel would remark or repair is checked below
        with LoggingOutputSuppressor(), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return kind.from_fileobj(data, check=False)
    except HeaderDataError as error:
        raise _corrupt(f"its header cannot be parsed ({type(error).__name__})") from None


def _offset(header: Any) -> int:
    """Where the voxels start, bytes; NIfTI-1 keeps it as a real number, which may be none."""
    start = float(header["vox_offset"])
    if not header.sizeof_hdr <= start <= _MAX_OFFSET:
        raise _corrupt(f"its voxels are said to start at byte {start:g}")
    return int(start)


def _dtype(header: Any) -> np.dtype:
    """Type of the voxels: integers or real numbers of up to 8 bytes."""
    try:
        dtype = np.dtype(header.get_data_dtype())
    except KeyError:
        raise _corrupt(f"its type of voxels has the code {int(header['datatype'])}") from None
    if dtype.kind not in "iuf" or dtype.itemsize > 8:
        message = f"The voxels are of the type {dtype.name}; integers or real numbers are wanted."
        raise InputRefused("UnsupportedPixels", message, "Convert the image to 16-bit integers.")
    return dtype


def _affine(header: Any, allow: Collection[str]) -> tuple[Affine, list[Finding]]:
    """Index -> LPS mm, in the file's own units: from the sform, else the qform."""
    unit = int(header["xyzt_units"]) & 7
    if unit not in _MM_PER_UNIT:
        raise _corrupt(f"its unit of length has the code {unit}")
    if not (np.isfinite(header["pixdim"][1:4]).all() and (np.asarray(header["pixdim"][1:4]) > 0).all()):
        message = "The voxel size (pixdim) is not positive in every direction."
        raise InputRefused("BadGeometry", message, "Convert the file again from its source.")

    # the sform goes before the qform
    findings = []
    if int(header["sform_code"]) > 0:
        affine = header.get_sform()
    elif int(header["qform_code"]) > 0:
        affine = header.get_qform()
    elif "no_orientation" in allow:
        affine = np.diag([*(float(p) for p in header["pixdim"][1:4]), 1.0])
        message = "The file has no orientation: its axes were taken as right, front and top."
        findings.append(Finding("NoOrientation", "warning", message, {}))
    else:
        raise no_orientation("The file has neither an sform nor a qform: it does not say where left is.")
    if unit == 0:
        findings.append(Finding("NoUnits", "info", "The file does not state its unit of length: mm was taken.", {}))
    affine = np.array(affine, float)
    affine[:3] *= _MM_PER_UNIT[unit]
    return _LPS @ affine, findings + _disagreement(header) + _sizes_disagree(header)


def _sizes_disagree(header: Any) -> list[Finding]:
    """A remark where the sform gives the voxels another size than pixdim does."""
    if int(header["sform_code"]) <= 0:
        return []
    # the sform's columns are the steps between voxels
    pixdim, spacing = np.asarray(header["pixdim"][1:4], float), np.linalg.norm(header.get_sform()[:3, :3], axis=0)
    if np.allclose(pixdim, spacing, rtol=0.01):
        return []
    message = "The file's sform and pixdim give different voxel sizes; the sform was taken."
    return [Finding("TwoSpacings", "warning", message, {"pixdim": pixdim.tolist()})]


def _disagreement(header: Any) -> list[Finding]:
    """A remark where sform and qform place the image's far corner apart."""
    if int(header["sform_code"]) <= 0 or int(header["qform_code"]) <= 0:
        return []
    # the corner where a difference shows most
    far = np.array([*header.get_data_shape()[:3], 1.0])
    apart = float(np.linalg.norm((header.get_sform() - header.get_qform()) @ far))
    if not apart > 1.0:
        return []
    message = f"The file's sform and qform are {apart:.1f} apart at its far corner; the sform was taken."
    return [Finding("TwoOrientations", "warning", message, {"apart": apart})]


def _scaling(header: Any) -> tuple[float, float, list[Finding]]:
    """Slope and intercept; 0, NaN or infinity mean none, as the standard has it for 0."""
    slope, intercept = float(header["scl_slope"]), float(header["scl_inter"])
    if slope == 0 or (np.isnan(slope) and np.isnan(intercept)):
        return 1.0, 0.0, []
    if np.isfinite(slope) and np.isfinite(intercept):
        return slope, intercept, []
    message = "The file's scaling is not finite: its numbers were taken as they are."
    return 1.0, 0.0, [Finding("BadScaling", "warning", message, {})]


def _corrupt(what: str) -> InputRefused:
    return InputRefused("CorruptFile", f"The NIfTI file is damaged: {what}.", "Copy the file again from its source.")
