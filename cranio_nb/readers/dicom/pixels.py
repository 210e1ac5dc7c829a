"""`SliceHeader` -> stored numbers of its image, (rows, cols); then stored numbers -> HU."""

from __future__ import annotations

import hashlib

import numpy as np
from numpy.typing import NDArray
from pydicom.uid import (
    DeflatedExplicitVRLittleEndian,
    ExplicitVRBigEndian,
    ExplicitVRLittleEndian,
    ImplicitVRLittleEndian,
)

from ...errors import InputRefused
from ..hu_checks import AIR
from .codecs import COMPRESSED, decode, missing_decoder
from .headers import SliceHeader
from .scan import UNDEFINED_LENGTH, PixelPlace, dataset_stream

_NATIVE = {ImplicitVRLittleEndian, ExplicitVRLittleEndian, ExplicitVRBigEndian, DeflatedExplicitVRLittleEndian}


def check_format(header: SliceHeader, index: int) -> None:
    """Refuse pixels that cannot be read as one number per pixel, before anything is decoded.

    Raises
    ------
    InputRefused
        ``UnsupportedTransferSyntax``, ``UnsupportedPixels`` or ``CorruptPixelData``, naming the slice.
    """
    place, (allocated, stored, high) = _place(header, index), header.bits
    if place.syntax not in _NATIVE and place.syntax not in COMPRESSED:
        raise InputRefused(
            "UnsupportedTransferSyntax",
            f"Slice {index} is stored in the transfer syntax {_uid(place.syntax)}, which cannot be read.",
            "Export the scan again as uncompressed DICOM.",
        )
    package = missing_decoder(place.syntax)
    if package:
        message = f"Slice {index} is stored in the transfer syntax {_uid(place.syntax)}, whose decoder is missing."
        raise InputRefused("UnsupportedTransferSyntax", message, f"Install it: pip install {package}")
    big = place.syntax == ExplicitVRBigEndian
    if place.is_float or header.has_lut or allocated not in (8, 16, 32) or (big and allocated != 16):
        what = "floating point" if place.is_float else "table" if header.has_lut else f"{allocated}-bit"
        raise InputRefused(
            "UnsupportedPixels",
            f"Slice {index} holds {what} pixels; integers of 8, 16 or 32 bits are wanted.",
            "Export the scan again as a plain CT series.",
        )
    if not 1 <= stored <= allocated or not stored - 1 <= high < allocated:
        raise _corrupt(index, f"declares {stored} of {allocated} bits with the highest at {high}")
    if (place.length == UNDEFINED_LENGTH) != (place.syntax in COMPRESSED):
        raise _corrupt(index, "is labelled with a transfer syntax that its pixel data do not have")
    if place.length != UNDEFINED_LENGTH:
        _check_size(header, place, index)


def stored_pixels(header: SliceHeader, index: int) -> NDArray[np.integer]:
    """The numbers of one image as stored, shape (rows, cols), of the header's bits and sign.

    Unused high bits are still there in uncompressed data: `to_hu` clears them.

    Raises
    ------
    InputRefused
        ``CorruptPixelData`` naming the slice, whatever the decoder met.
    """
    try:
        place = _place(header, index)
        pixels = _native(header, place, index) if place.syntax in _NATIVE else decode(header, place)
    except InputRefused:
        raise
    except Exception as error:
        raise _corrupt(index, f"cannot be decoded ({type(error).__name__})") from None
    if pixels.shape != (header.rows, header.cols):
        raise _corrupt(index, f"decodes to {pixels.shape} pixels instead of {(header.rows, header.cols)}")
    return pixels


def pixel_digest(header: SliceHeader, index: int) -> str:
    """Digest of the stored numbers, to tell a copied slice from another one at the same place."""
    pixels = stored_pixels(header, index)
    return hashlib.sha256(np.ascontiguousarray(pixels).tobytes()).hexdigest()


def to_hu(
    stored: NDArray[np.integer], header: SliceHeader, slope: float, intercept: float
) -> tuple[NDArray, NDArray[np.bool_] | None]:
    """HU of stored numbers, and where the padding is.

    Parameters
    ----------
    stored : ndarray, shape (rows, cols)
        From `stored_pixels`.
    slope, intercept : float
        The slice's own rescale.

    Returns
    -------
    hu : ndarray, shape (rows, cols)
        int16 where slope and intercept are whole numbers and the values fit, else float32. Never inverted: the
        photometric interpretation only concerns displays.
    padding : ndarray of bool, shape (rows, cols), or None
    """
    padding = None
    if header.padding is not None and _is_padding(header.padding, slope, intercept):
        low, high = header.padding
        padding = (stored == low) if low == high else (stored >= low) & (stored <= high)
    values = _without_unused_bits(stored, header)
    whole = float(slope).is_integer() and float(intercept).is_integer()
    if not whole or not _fits(values, slope, intercept):
        hu: NDArray = (values * slope + intercept).astype(np.float32)
    elif slope == 1:
        hu = (values + np.int32(intercept)).astype(np.int16) if intercept else values.astype(np.int16)
    else:
        hu = (values.astype(np.int64) * int(slope) + int(intercept)).astype(np.int16)
    if padding is not None:
        hu[padding] = AIR
    return hu, padding


def _is_padding(stored: tuple[float, float], slope: float, intercept: float) -> bool:
    """Padding lies outside the values of a head; a range inside them would punch holes into it."""
    low, high = sorted(value * slope + intercept for value in stored)
    return high <= -900 or low > 4000


def _fits(values: NDArray[np.integer], slope: float, intercept: float) -> bool:
    ends = (int(values.min()) * slope + intercept, int(values.max()) * slope + intercept)
    return min(ends) >= -32768 and max(ends) <= 32767


def _without_unused_bits(stored: NDArray[np.integer], header: SliceHeader) -> NDArray[np.integer]:
    """The stored bits alone, sign extended: what stands above or below them is not image."""
    allocated, bits, high = header.bits
    if bits == allocated or _place(header, 0).syntax in COMPRESSED:
        return stored
    up, down = allocated - 1 - high, allocated - bits
    return (stored << up) >> down


def _native(header: SliceHeader, place: PixelPlace, index: int) -> NDArray[np.integer]:
    size = _frame_bytes(header)
    with open(place.path, "rb") as stream:
        if place.syntax == DeflatedExplicitVRLittleEndian:
            _, data = dataset_stream(stream, place.file)
        else:
            data = stream
        data.seek(place.offset + header.frame * size)
        content = data.read(size)
    if len(content) != size:
        raise _corrupt(index, "is cut short")
    order = ">" if place.syntax == ExplicitVRBigEndian else "<"
    dtype = np.dtype(f"{order}{'i' if header.signed else 'u'}{header.bits[0] // 8}")
    return np.frombuffer(content, dtype).reshape(header.rows, header.cols).astype(dtype.newbyteorder("="), copy=False)


def _check_size(header: SliceHeader, place: PixelPlace, index: int) -> None:
    wanted, row = _frame_bytes(header) * header.frames, header.cols * header.bits[0] // 8
    if not wanted <= place.length < wanted + max(row, 2):
        raise _corrupt(index, f"holds {place.length} bytes of pixels where its header announces {wanted}")


def _frame_bytes(header: SliceHeader) -> int:
    return header.rows * header.cols * header.samples * header.bits[0] // 8


def _place(header: SliceHeader, index: int) -> PixelPlace:
    if header.place is None:
        raise InputRefused("MissingSlices", f"Slice {index} has no pixel data.", "Copy the scan again from its source.")
    return header.place


def _uid(syntax: str) -> str:
    return "".join(c for c in syntax if c.isdigit() or c == ".")[:64]


def _corrupt(index: int, what: str) -> InputRefused:
    return InputRefused("CorruptPixelData", f"Slice {index} {what}.", "Copy the scan again from its source.")
