"""Compressed frame of a DICOM file -> its numbers. One named decoder per transfer syntax.

A decoder that is tried "if another fails" may accept damaged data, so there is no second one. The size inside the
compressed stream is compared with the header before the decoder may allocate for it.
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray
from pydicom import uid
from pydicom.encaps import encapsulate
from pydicom.pixels import get_decoder

from .parse import PixelPlace
from .slice_header import SliceHeader

LOSSY = {uid.JPEGLSNearLossless, uid.JPEG2000, uid.HTJ2K, uid.JPEGBaseline8Bit, uid.JPEGExtended12Bit}
_JPEG_LS = {uid.JPEGLSLossless, uid.JPEGLSNearLossless}
_JPEG2000 = {uid.JPEG2000Lossless, uid.JPEG2000, uid.HTJ2KLossless, uid.HTJ2KLosslessRPCL, uid.HTJ2K}
_JPEG = {uid.JPEGBaseline8Bit, uid.JPEGExtended12Bit, uid.JPEGLossless, uid.JPEGLosslessSV1}
# start-of-frame markers of each process: baseline, extended, lossless
_PROCESSES = {
    uid.JPEGBaseline8Bit: {0xC0},
    uid.JPEGExtended12Bit: {0xC0, 0xC1},
    uid.JPEGLossless: {0xC3},
    uid.JPEGLosslessSV1: {0xC3},
}
COMPRESSED = {uid.RLELossless, *_JPEG_LS, *_JPEG2000, *_JPEG}
# (module, package) of each family's decoder; run length coding needs none
_NEEDED = {
    **dict.fromkeys(_JPEG_LS, ("jpeg_ls", "pyjpegls")),
    **dict.fromkeys(_JPEG2000, ("openjpeg", "pylibjpeg-openjpeg")),
    **dict.fromkeys(_JPEG, ("imagecodecs", "imagecodecs")),
}
# markers before the size: start of frame of JPEG and JPEG-LS (all but tables), and SIZ of JPEG 2000
_FRAME_MARKERS = {*range(0xC0, 0xD0), 0xF7} - {0xC4, 0xC8, 0xCC}
_NO_LENGTH = {0x01, *range(0xD0, 0xD9)}


def decode(header: SliceHeader, place: PixelPlace, data: BinaryIO) -> NDArray[np.integer]:
    """Decode the stored numbers of one compressed image.

    Parameters
    ----------
    header : SliceHeader
        Of an image whose transfer syntax is in `COMPRESSED`.
    place : PixelPlace
        Where its compressed data lie.
    data : binary stream
        The file.

    Returns
    -------
    ndarray of int, shape (rows, cols)
        Signed as the header says.

    Raises
    ------
    Exception
        Whatever the decoder meets; `ValueError` where the stream's own size is not the header's.

    Warns
    -----
    UserWarning
        Where the stream holds more than the image needs.
    """
    frame = _frame_bytes(header, place, data)
    if place.syntax in _JPEG:
        check_jpeg_stream(frame, place.syntax, header.bits[0])
    if place.syntax != uid.RLELossless and read_frame_size(frame) != (header.rows, header.cols):
        raise ValueError("the size in the stream is not that of the header")
    if place.syntax in _JPEG2000:
        import openjpeg

        return _signed_as(openjpeg.decode(frame), header)
    if place.syntax in _JPEG:
        import imagecodecs

        return _signed_as(imagecodecs.jpeg8_decode(frame), header)
    if place.syntax in _JPEG_LS:
        import jpeg_ls

        return _signed_as(jpeg_ls.decode(np.frombuffer(frame, np.uint8)), header)
    return _run_lengths(frame, header)


def _run_lengths(frame: bytes, header: SliceHeader) -> NDArray[np.integer]:
    """The numbers of a run-length coded image."""
    options: dict[str, Any] = {
        "rows": header.rows,
        "columns": header.cols,
        "number_of_frames": 1,
        "samples_per_pixel": 1,
        "bits_allocated": header.bits[0],
        "bits_stored": header.bits[1],
        "photometric_interpretation": "MONOCHROME2",
        "pixel_representation": int(header.signed),
        "pixel_keyword": "PixelData",
    }
    data = encapsulate([frame], has_bot=False)
    return get_decoder(uid.RLELossless).as_array(data, raw=True, decoding_plugin="pydicom", **options)[0]


def _frame_bytes(header: SliceHeader, place: PixelPlace, data: BinaryIO) -> bytes:
    """The compressed stream of one frame: all fragments of a single image, or a frame's own."""
    table, *fragments = place.items
    if header.frames == 1:
        own = fragments
    elif len(fragments) == header.frames:
        own = fragments[header.frame : header.frame + 1]
    else:
        own = _fragments_by_table(header, table, fragments, data)
    parts = []
    for offset, length in own:
        data.seek(offset)
        parts.append(data.read(length))
    return b"".join(parts)


def _fragments_by_table(
    header: SliceHeader, table: tuple[int, int], fragments: list[tuple[int, int]], data: BinaryIO
) -> list[tuple[int, int]]:
    """The fragments of one frame, by the table of offsets from the first fragment's item."""
    data.seek(table[0])
    starts = np.frombuffer(data.read(table[1] // 4 * 4), "<u4")
    if len(starts) != header.frames:
        raise ValueError("the frames cannot be told apart")
    first = fragments[0][0] - 8
    begin = int(starts[header.frame])
    end = int(starts[header.frame + 1]) if header.frame + 1 < header.frames else np.inf
    return [(offset, length) for offset, length in fragments if begin <= offset - 8 - first < end]


def check_jpeg_stream(frame: bytes, syntax: str, allocated: int) -> None:
    """Check that a JPEG stream is of the process that its transfer syntax names, of one component, and whole.

    Parameters
    ----------
    frame : bytes
        One compressed image.
    syntax : str
        UID of the transfer syntax.
    allocated : int
        Bits of a stored number.

    Raises
    ------
    ValueError
        The decoder would take such a stream, and fill what is missing.

    Examples
    --------
    >>> start = bytes.fromhex("FFD8 FFC1 000B 0C 0200 0100 01 011100")
    >>> check_jpeg_stream(start + bytes(20) + bytes.fromhex("FFD9"), uid.JPEGExtended12Bit, 16)
    >>> check_jpeg_stream(start + bytes(20), uid.JPEGExtended12Bit, 16)
    Traceback (most recent call last):
    ValueError: the stream has no end
    """
    marker, at = _frame_marker(frame)
    if frame[:2] != b"\xff\xd8" or marker not in _PROCESSES[uid.UID(syntax)]:
        raise ValueError("the stream is of another process than its transfer syntax")
    if not frame.rstrip(b"\0\xff").endswith(b"\xff\xd9"):
        raise ValueError("the stream has no end")
    if frame[at + 9] != 1 or frame[at + 4] > allocated:
        raise ValueError("the stream holds colours or more bits than the header")


def find_missing_decoder(syntax: str) -> str:
    """Find the package that is missing to decode a transfer syntax.

    Parameters
    ----------
    syntax : str
        UID of the transfer syntax.

    Returns
    -------
    str
        Name of the package to install; empty where it is there, or none is needed.

    Examples
    --------
    >>> find_missing_decoder(uid.ExplicitVRLittleEndian)
    ''
    """
    module, package = _NEEDED.get(uid.UID(syntax), ("", ""))
    return package if module and find_spec(module) is None else ""


def read_frame_size(frame: bytes) -> tuple[int, int] | None:
    """Read the size that a JPEG, JPEG-LS or JPEG 2000 stream declares.

    Parameters
    ----------
    frame : bytes
        One compressed image.

    Returns
    -------
    tuple of int or None
        (rows, cols); None where the stream declares no size.

    Examples
    --------
    The head of a JPEG of 512 x 256 pixels with 12 bits:

    >>> start = bytes.fromhex("FFD8 FFC1 000B 0C 0200 0100 01 011100")
    >>> read_frame_size(start + bytes(20))
    (512, 256)
    """
    marker, at = _frame_marker(frame)
    if marker == 0x51:  # JPEG 2000: the image's two corners on the reference grid
        x1, y1, x0, y0 = (int.from_bytes(frame[at + 6 + 4 * i : at + 10 + 4 * i], "big") for i in range(4))
        return y1 - y0, x1 - x0
    if marker:  # JPEG, JPEG-LS: precision, then rows and columns
        rows, cols = (int.from_bytes(frame[at + 5 + 2 * i : at + 7 + 2 * i], "big") for i in range(2))
        return rows, cols
    return None


def _frame_marker(frame: bytes) -> tuple[int, int]:
    """The marker of the segment that holds the image's size, and where it is; 0 where there is none."""
    at = 2  # behind the start-of-image marker
    while at + 22 <= len(frame) and frame[at] == 0xFF:
        marker = frame[at + 1]
        if marker == 0x51 or marker in _FRAME_MARKERS:
            return marker, at
        # any other segment is passed over; FF FF is filling
        step = 0 if marker in _NO_LENGTH or marker == 0xFF else int.from_bytes(frame[at + 2 : at + 4], "big")
        at += 1 if marker == 0xFF else 2 + step
    return 0, 0


def _signed_as(numbers: NDArray[np.integer], header: SliceHeader) -> NDArray[np.integer]:
    """The same bits read with the header's sign: some encoders write signed data as unsigned."""
    # in the header's width: a stream of few bits may come in single bytes
    numbers = numbers.astype(f"{numbers.dtype.kind}{max(numbers.itemsize, header.bits[0] // 8)}", copy=False)
    if (numbers.dtype.kind == "i") == header.signed:
        return numbers
    # shift the sign to the highest bit and back
    width = 8 * numbers.itemsize
    spare = width - min(header.bits[1], width)
    if header.signed:
        return (numbers << spare).view(f"i{numbers.itemsize}") >> spare
    return (numbers.view(f"u{numbers.itemsize}") << spare) >> spare
