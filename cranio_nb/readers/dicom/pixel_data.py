"""`SliceHeader` -> the numbers of its image as stored, shape (rows, cols). `rescale` turns them into HU.

The format is checked before anything is decoded.
"""

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
from .codecs import COMPRESSED, decode, find_missing_decoder
from .parse import UNDEFINED_LENGTH, PixelPlace, open_dataset
from .slice_header import SliceHeader

_NATIVE = {ImplicitVRLittleEndian, ExplicitVRLittleEndian, ExplicitVRBigEndian, DeflatedExplicitVRLittleEndian}


def check_format(header: SliceHeader, index: int) -> None:
    """Refuse pixels that cannot be read as one number per pixel, before anything is decoded.

    Parameters
    ----------
    header : SliceHeader
    index : int
        The slice's number in messages.

    Raises
    ------
    InputRefused
        ``UnsupportedTransferSyntax``, ``UnsupportedPixels`` or ``CorruptPixelData``, naming the slice.
    """
    # a transfer syntax that can be decoded here
    place, (allocated, stored, high) = _place(header, index), header.bits
    if place.syntax not in _NATIVE and place.syntax not in COMPRESSED:
        raise InputRefused(
            "UnsupportedTransferSyntax",
            f"Slice {index} is stored in the transfer syntax {_uid(place.syntax)}, which cannot be read.",
            "Export the scan again as uncompressed DICOM.",
        )
    package = find_missing_decoder(place.syntax)
    if package:
        message = f"Slice {index} is stored in the transfer syntax {_uid(place.syntax)}, whose decoder is missing."
        raise InputRefused("UnsupportedTransferSyntax", message, f"Install it: pip install {package}")

    # integers of whole bytes
    big = place.syntax == ExplicitVRBigEndian
    if place.is_float or header.has_lut or allocated not in (8, 16, 32) or (big and allocated != 16):
        what = "floating point" if place.is_float else "table" if header.has_lut else f"{allocated}-bit"
        raise InputRefused(
            "UnsupportedPixels",
            f"Slice {index} holds {what} pixels; integers of 8, 16 or 32 bits are wanted.",
            "Export the scan again as a plain CT series.",
        )

    # bits, syntax and length agree with each other
    if not 1 <= stored <= allocated or not stored - 1 <= high < allocated:
        raise _corrupt(index, f"declares {stored} of {allocated} bits with the highest at {high}")
    if (place.length == UNDEFINED_LENGTH) != (place.syntax in COMPRESSED):
        raise _corrupt(index, "is labelled with a transfer syntax that its pixel data do not have")
    if place.length != UNDEFINED_LENGTH:
        _check_size(header, place, index)


def read_pixels(header: SliceHeader, index: int) -> NDArray[np.integer]:
    """Read the numbers of one image as stored.

    Parameters
    ----------
    header : SliceHeader
        Of an image that passed `check_format`.
    index : int
        The slice's number in messages.

    Returns
    -------
    ndarray of int, shape (rows, cols)
        Of the header's bits and sign. Unused high bits are still there in uncompressed data: `clear_unused_bits`.

    Raises
    ------
    InputRefused
        ``CorruptPixelData`` naming the slice, whatever the decoder met.

    Examples
    --------
    >>> from data_synth import write_dicom
    >>> from .parse import parse_file
    >>> from .slice_header import read_headers
    >>> hu = np.arange(8 * 4 * 4, dtype=np.int16).reshape(8, 4, 4)
    >>> path = write_dicom("scan", hu, np.eye(4)[[2, 1, 0, 3]])[5]
    >>> (header,) = read_headers(*parse_file(path, 0), 0)
    >>> bool((read_pixels(header, 0) + header.intercept == hu[5]).all())
    True
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


def digest_pixels(pixels: NDArray[np.integer]) -> str:
    """Digest the stored numbers of one image, to tell a copied slice from another one at the same place.

    Parameters
    ----------
    pixels : ndarray of int, shape (rows, cols)

    Returns
    -------
    str
        SHA-256 in hexadecimal digits.

    Examples
    --------
    >>> digest_pixels(np.eye(3, dtype=np.int16)) == digest_pixels(np.eye(3, dtype=np.int16).T)
    True
    """
    return hashlib.sha256(np.ascontiguousarray(pixels).tobytes()).hexdigest()


def clear_unused_bits(stored: NDArray[np.integer], header: SliceHeader) -> NDArray[np.integer]:
    """Keep the stored bits alone: what lies above or below them is not image.

    Parameters
    ----------
    stored : ndarray of int, shape (rows, cols)
    header : SliceHeader
        Its `bits`: allocated, stored, and the highest of the stored.

    Returns
    -------
    ndarray of int, shape (rows, cols)
        Of the same type, shifted down to the lowest bit, the sign extended.

    Examples
    --------
    Twelve of sixteen bits are image; the four above hold something else:

    >>> from types import SimpleNamespace
    >>> header = SimpleNamespace(bits=(16, 12, 11), place=SimpleNamespace(syntax=ExplicitVRLittleEndian))
    >>> clear_unused_bits(np.array([0xF123], np.uint16), header) == 0x123
    array([ True])
    """
    allocated, bits, high = header.bits
    if bits == allocated or _place(header, 0).syntax in COMPRESSED:
        return stored
    up, down = allocated - 1 - high, allocated - bits
    return (stored << up) >> down


def _native(header: SliceHeader, place: PixelPlace, index: int) -> NDArray[np.integer]:
    """Uncompressed pixels of one frame, in the machine's byte order."""
    size = _frame_bytes(header)
    with open(place.path, "rb") as stream:
        if place.syntax == DeflatedExplicitVRLittleEndian:
            _, data = open_dataset(stream, place.file)
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
    """Refuse pixel data that are shorter than announced, or longer by a row or more."""
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
