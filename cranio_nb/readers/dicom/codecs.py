"""Compressed frame of a DICOM file -> its numbers. One named decoder per transfer syntax.

A decoder that is tried "if another fails" may accept damaged data, so there is no second one for that. What the stream
says of itself is compared with the header before the decoder may allocate for it (`compressed_stream`). Lossless JPEG
has no check sum and its decoder fills in what it cannot read, so there two decoders must read the same.
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray
from pydicom import uid
from pydicom.encaps import encapsulate
from pydicom.pixels import get_decoder

from .compressed_stream import JPEG, JPEG2000, JPEG_LS, CompressedStream, check_stream
from .parse import PixelPlace
from .slice_header import SliceHeader

LOSSY = {uid.JPEGLSNearLossless, uid.JPEG2000, uid.HTJ2K, uid.JPEGBaseline8Bit, uid.JPEGExtended12Bit}
_LOSSLESS_JPEG = {uid.JPEGLossless, uid.JPEGLosslessSV1}
COMPRESSED = {uid.RLELossless, *JPEG_LS, *JPEG2000, *JPEG}
# (module, package) of each family's decoder; run length coding needs none
_NEEDED = {
    **dict.fromkeys(JPEG_LS, ("jpeg_ls", "pyjpegls")),
    **dict.fromkeys(JPEG2000, ("openjpeg", "pylibjpeg-openjpeg")),
    **dict.fromkeys(JPEG, ("imagecodecs", "imagecodecs")),
}


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
        Whatever the decoder meets; `ValueError` where the stream is not whole, or not of the header's image.

    Warns
    -----
    UserWarning
        Where the stream holds more than the image needs.
    """
    frame = _frame_bytes(header, place, data)
    stream = CompressedStream(frame)
    if place.syntax != uid.RLELossless:
        check_stream(stream, place.syntax, header.rows, header.cols, header.bits[0])
    if place.syntax in JPEG2000:
        import openjpeg

        return _signed_as(openjpeg.decode(frame), header)
    if place.syntax in JPEG:
        return _signed_as(_jpeg(stream, place.syntax), header)
    if place.syntax in JPEG_LS:
        import jpeg_ls

        return _signed_as(jpeg_ls.decode(np.frombuffer(frame, np.uint8)), header)
    return _run_lengths(frame, header)


def _jpeg(stream: CompressedStream, syntax: str) -> NDArray[np.integer]:
    """The numbers of a JPEG image; of a lossless one, as two decoders read them alike."""
    import imagecodecs

    numbers = imagecodecs.jpeg8_decode(stream.data)
    # the second one knows no streams in parts; there the marks between the parts show what is lost
    if syntax in _LOSSLESS_JPEG and not stream.part_length:
        if not np.array_equal(numbers, imagecodecs.jpegsof3_decode(stream.data)):
            raise ValueError("the stream is damaged: two decoders read other numbers")
    return numbers


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
