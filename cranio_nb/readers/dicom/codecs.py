"""Compressed frame of a DICOM file -> its numbers. One named decoder per transfer syntax.

A decoder that is tried "if another fails" may accept damaged data, so there is no second one. The size inside the
compressed stream is compared with the header before the decoder may allocate for it.
"""

from __future__ import annotations

import warnings
from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray
from pydicom import uid
from pydicom.encaps import get_frame
from pydicom.pixels import pixel_array

from .parse import PixelPlace
from .slice_header import SliceHeader

LOSSY = {uid.JPEGLSNearLossless, uid.JPEG2000, uid.HTJ2K, uid.JPEGBaseline8Bit, uid.JPEGExtended12Bit}
_JPEG_LS = {uid.JPEGLSLossless, uid.JPEGLSNearLossless}
_JPEG2000 = {uid.JPEG2000Lossless, uid.JPEG2000, uid.HTJ2KLossless, uid.HTJ2KLosslessRPCL, uid.HTJ2K}
_JPEG = {uid.JPEGBaseline8Bit, uid.JPEGExtended12Bit, uid.JPEGLossless, uid.JPEGLosslessSV1}
COMPRESSED = {uid.RLELossless, *_JPEG_LS, *_JPEG2000, *_JPEG}
# (module, package) of each family's decoder; run length coding needs none
_NEEDED = {
    **dict.fromkeys(_JPEG_LS, ("jpeg_ls", "pyjpegls")),
    **dict.fromkeys(_JPEG2000, ("openjpeg", "pylibjpeg-openjpeg")),
    **dict.fromkeys(_JPEG, ("libjpeg", "pylibjpeg-libjpeg")),
}
# markers before the size: start of frame of JPEG and JPEG-LS (all but tables), and SIZ of JPEG 2000
_FRAME_MARKERS = {*range(0xC0, 0xD0), 0xF7} - {0xC4, 0xC8, 0xCC}
_NO_LENGTH = {0x01, *range(0xD0, 0xD9)}


def decode(header: SliceHeader, place: PixelPlace) -> NDArray[np.integer]:
    """Decode the stored numbers of one compressed image.

    Parameters
    ----------
    header : SliceHeader
        Of an image whose transfer syntax is in `COMPRESSED`.
    place : PixelPlace
        Where its compressed data lie.

    Returns
    -------
    ndarray of int, shape (rows, cols)
        Signed as the header says.

    Raises
    ------
    Exception
        Whatever the decoder meets; `ValueError` where the stream's own size is not the header's.
    """
    with open(place.path, "rb") as stream:
        stream.seek(place.offset)
        frame = get_frame(stream, header.frame, number_of_frames=header.frames)
    if place.syntax != uid.RLELossless and read_frame_size(frame) != (header.rows, header.cols):
        raise ValueError("the size in the stream is not that of the header")
    if place.syntax in _JPEG2000:
        import openjpeg

        return _signed_as(openjpeg.decode(frame), header)
    if place.syntax in _JPEG:
        import libjpeg

        return _signed_as(libjpeg.decode(frame), header)
    plugin = "pyjpegls" if place.syntax in _JPEG_LS else "pydicom"
    index = header.frame if header.frames > 1 else None
    with warnings.catch_warnings():
        # remarks on odd but readable headers
        warnings.simplefilter("ignore")
        return pixel_array(place.path, index=index, raw=True, decoding_plugin=plugin)


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
    at = 2  # behind the start-of-image marker
    while at + 22 <= len(frame) and frame[at] == 0xFF:
        marker = frame[at + 1]
        if marker == 0x51:  # JPEG 2000: the image's two corners on the reference grid
            x1, y1, x0, y0 = (int.from_bytes(frame[at + 6 + 4 * i : at + 10 + 4 * i], "big") for i in range(4))
            return y1 - y0, x1 - x0
        if marker in _FRAME_MARKERS:  # JPEG, JPEG-LS: precision, then rows and columns
            rows, cols = (int.from_bytes(frame[at + 5 + 2 * i : at + 7 + 2 * i], "big") for i in range(2))
            return rows, cols
        # any other segment is passed over; FF FF is filling
        step = 0 if marker in _NO_LENGTH or marker == 0xFF else int.from_bytes(frame[at + 2 : at + 4], "big")
        at += 1 if marker == 0xFF else 2 + step
    return None


def _signed_as(numbers: NDArray[np.integer], header: SliceHeader) -> NDArray[np.integer]:
    """The same bits read with the header's sign: some encoders write signed data as unsigned."""
    if (numbers.dtype.kind == "i") == header.signed:
        return numbers
    # shift the sign to the highest bit and back
    width = 8 * numbers.itemsize
    spare = width - min(header.bits[1], width)
    if header.signed:
        return (numbers << spare).view(f"i{numbers.itemsize}") >> spare
    return (numbers.view(f"u{numbers.itemsize}") << spare) >> spare
