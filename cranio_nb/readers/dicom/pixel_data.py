"""`SliceHeader` -> the numbers of its image as stored, shape (rows, cols). `rescale` turns them into HU.

The format is checked before anything is decoded.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray
from pydicom.uid import (
    DeflatedExplicitVRLittleEndian,
    ExplicitVRBigEndian,
    ExplicitVRLittleEndian,
    ImplicitVRLittleEndian,
    RLELossless,
    UID_dictionary,
)

from ...errors import InputRefused
from .codecs import COMPRESSED, decode, find_missing_decoder
from .inflated import open_dataset
from .parse import UNDEFINED_LENGTH, PixelPlace
from .slice_header import SliceHeader

_NATIVE = {ImplicitVRLittleEndian, ExplicitVRLittleEndian, ExplicitVRBigEndian, DeflatedExplicitVRLittleEndian}

_PATCHES = 0.75  # of neighbouring pixels that are alike in bits that belong to an image


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
        check_size(header, place, index)


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
    return next(pixels for _, pixels in read_stack([header], [index]))


def read_stack(
    headers: Sequence[SliceHeader], indices: Sequence[int] | None = None
) -> Iterator[tuple[int, NDArray[np.integer]]]:
    """Read the numbers of many images as stored, file by file, so that each file is opened (and inflated) once.

    Parameters
    ----------
    headers : sequence of SliceHeader
        Of images that passed `check_format`.
    indices : sequence of int, optional
        The slices' numbers in messages; by default their places in `headers`.

    Yields
    ------
    place : int
        Of the image in `headers`.
    pixels : ndarray of int, shape (rows, cols)
        As by `read_pixels`.

    Raises
    ------
    InputRefused
        ``CorruptPixelData`` naming the slice.

    Examples
    --------
    >>> from data_synth import write_dicom
    >>> from .parse import parse_file
    >>> from .slice_header import read_headers
    >>> files = write_dicom("scan", np.zeros((8, 4, 4), np.int16), np.eye(4)[[2, 1, 0, 3]])
    >>> headers = [header for i, file in enumerate(files) for header in read_headers(*parse_file(file, i), i)]
    >>> [place for place, _ in read_stack(headers[::-1])]
    [7, 6, 5, 4, 3, 2, 1, 0]
    """
    indices = range(len(headers)) if indices is None else indices
    order = sorted(range(len(headers)), key=lambda i: (headers[i].file, headers[i].frame))
    for _, group in groupby(order, key=lambda i: headers[i].file):
        places = list(group)
        place = _place(headers[places[0]], indices[places[0]])
        with open(place.path, "rb") as stream:
            data = None
            for i in places:
                try:
                    data = data or _opened(stream, place)
                    yield i, _pixels(headers[i], place, data, indices[i])
                except InputRefused:
                    raise
                except Exception as error:
                    raise _corrupt(indices[i], f"cannot be decoded ({type(error).__name__})") from None


def _opened(stream: BinaryIO, place: PixelPlace) -> BinaryIO:
    """The stream in which a place's offset counts: inflated, where the file is deflated."""
    return open_dataset(stream, place.file)[1] if place.syntax == DeflatedExplicitVRLittleEndian else stream


def _pixels(header: SliceHeader, place: PixelPlace, data: BinaryIO, index: int) -> NDArray[np.integer]:
    """The stored numbers of one image of an open file."""
    pixels = _native(header, place, data, index) if place.syntax in _NATIVE else decode(header, place, data)
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
    if bits == allocated or _place(header, 0).syntax in COMPRESSED - {RLELossless}:
        return stored
    up, down = allocated - 1 - high, allocated - bits
    return (stored << up) >> down


def holds_unused_bits(stored: NDArray[np.integer], header: SliceHeader, index: int) -> bool:
    """Whether bits outside the stored ones are set, and mean nothing.

    Parameters
    ----------
    stored : ndarray of int, shape (rows, cols)
    header : SliceHeader
        Its `bits`, and its `padding`, which may lie outside them.
    index : int
        The slice's number in messages.

    Returns
    -------
    bool

    Raises
    ------
    InputRefused
        ``CorruptPixelData`` where these bits are alike in neighbouring pixels, as parts of an image are: the numbers
        need more bits than they declare.

    Examples
    --------
    A ramp up to 4000 needs 12 bits; with 11 it would fall back to 0 on its way:

    >>> from types import SimpleNamespace
    >>> place = SimpleNamespace(syntax=ExplicitVRLittleEndian)
    >>> header = SimpleNamespace(bits=(16, 11, 10), place=place, padding=None, overlay=False)
    >>> holds_unused_bits(np.arange(0, 4000, 100, np.uint16).reshape(1, -1), header, 3)
    Traceback (most recent call last):
    cranio_nb.errors.InputRefused: Slice 3 declares 11 bits, but its numbers need more. Copy the scan again ...
    """
    kept = clear_unused_bits(stored, header)
    if kept is stored:
        return False
    raw = stored >> (header.bits[2] + 1 - header.bits[1])
    if header.padding is not None:
        low, high = header.padding
        raw = np.where((stored >= low) & (stored <= high), kept, raw)
    if np.array_equal(raw, kept):
        return False
    # bits of an image lie in patches; rubbish differs from pixel to pixel, or is the same everywhere
    beyond = raw.astype(np.int64) - kept
    alike = float((beyond[:, 1:] == beyond[:, :-1]).mean()) if beyond.shape[1] > 1 else 1.0
    if np.ptp(beyond) and alike > _PATCHES and not header.overlay:
        raise _corrupt(index, f"declares {header.bits[1]} bits, but its numbers need more")
    return True


def _native(header: SliceHeader, place: PixelPlace, data: BinaryIO, index: int) -> NDArray[np.integer]:
    """Uncompressed pixels of one frame, in the machine's byte order."""
    size = _frame_bytes(header)
    data.seek(place.offset + header.frame * size)
    content = data.read(size)
    if len(content) != size:
        raise _corrupt(index, "is cut short")
    order = ">" if place.syntax == ExplicitVRBigEndian else "<"
    dtype = np.dtype(f"{order}{'i' if header.signed else 'u'}{header.bits[0] // 8}")
    return np.frombuffer(content, dtype).reshape(header.rows, header.cols).astype(dtype.newbyteorder("="), copy=False)


def check_size(header: SliceHeader, place: PixelPlace, index: int) -> int:
    """Check that uncompressed pixel data are as long as announced.

    Parameters
    ----------
    header : SliceHeader
    place : PixelPlace
        Where its uncompressed pixels lie.
    index : int
        The slice's number in messages.

    Returns
    -------
    int
        Bytes beyond those announced, one of padding not counted.

    Raises
    ------
    InputRefused
        ``CorruptPixelData`` where bytes are missing, or where so many are left that a row, a column or a frame more
        may have been meant.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> header = SimpleNamespace(rows=4, cols=6, samples=1, bits=(16, 16, 15), frames=1)
    >>> check_size(header, SimpleNamespace(length=48), 0), check_size(header, SimpleNamespace(length=55), 0)
    (0, 7)
    >>> check_size(header, SimpleNamespace(length=60), 0)
    Traceback (most recent call last):
    cranio_nb.errors.InputRefused: Slice 0 holds 60 bytes of pixels where its header announces 48. Copy the scan ...
    """
    wanted, width = _frame_bytes(header) * header.frames, header.bits[0] // 8
    excess = place.length - wanted
    sides = [side * width for side in (header.rows, header.cols)]
    whole = excess >= min(sides) and any(excess % side in (0, 1) for side in sides)
    if excess < 0 or whole or excess >= wanted // 4:
        raise _corrupt(index, f"holds {place.length} bytes of pixels where its header announces {wanted}")
    return 0 if excess == 1 and wanted % 2 else excess


def _frame_bytes(header: SliceHeader) -> int:
    return header.rows * header.cols * header.samples * header.bits[0] // 8


def _place(header: SliceHeader, index: int) -> PixelPlace:
    if header.place is None:
        raise InputRefused("MissingSlices", f"Slice {index} has no pixel data.", "Copy the scan again from its source.")
    return header.place


def _uid(syntax: str) -> str:
    """The number of a transfer syntax; what the standard does not list may be anything and is not shown."""
    return syntax if syntax in UID_dictionary else "of an unknown number"


def _corrupt(index: int, what: str) -> InputRefused:
    return InputRefused("CorruptPixelData", f"Slice {index} {what}.", "Copy the scan again from its source.")
