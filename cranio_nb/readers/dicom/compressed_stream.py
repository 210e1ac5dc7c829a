"""Compressed stream of one image -> what it says of itself, and whether it is whole.

Decoders fill in what a stream lacks and pass over what it has too much. So a stream is walked from mark to mark before
it is decoded: its size, bits and components are those of the header, it ends where its image does, and of a JPEG 2000
image every tile is there. Other values within the coded data of a JPEG 2000 image cannot be told: it has no check sum.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from pydicom import uid

JPEG = {uid.JPEGBaseline8Bit, uid.JPEGExtended12Bit, uid.JPEGLossless, uid.JPEGLosslessSV1}
"""Transfer syntaxes of JPEG's first standard."""
JPEG_LS = {uid.JPEGLSLossless, uid.JPEGLSNearLossless}
JPEG2000 = {uid.JPEG2000Lossless, uid.JPEG2000, uid.HTJ2KLossless, uid.HTJ2KLosslessRPCL, uid.HTJ2K}
# start-of-frame markers of each process: baseline, extended, lossless, JPEG-LS
_PROCESSES = {
    uid.JPEGBaseline8Bit: {0xC0},
    uid.JPEGExtended12Bit: {0xC0, 0xC1},
    uid.JPEGLossless: {0xC3},
    uid.JPEGLosslessSV1: {0xC3},
    **{syntax: {0xF7} for syntax in JPEG_LS},
    **{syntax: {0x51} for syntax in JPEG2000},
}
# markers before the size: start of frame of JPEG and JPEG-LS (all but tables), and SIZ of JPEG 2000
_FRAME_MARKERS = {*range(0xC0, 0xD0), 0xF7} - {0xC4, 0xC8, 0xCC}
_NO_LENGTH = {0x01, *range(0xD0, 0xD9)}
_SCAN, _RESTARTS, _SIZ, _TILE = 0xDA, 0xDD, 0x51, 0x90
_END = b"\xff\xd9"
_MARK = re.compile(rb"\xff([^\x00\xff])")  # within coded data: a zero follows what is no mark
_MARK_LS = re.compile(rb"\xff([\x80-\xfe])")  # there a bit of zero does


@dataclass(frozen=True)
class Declared:
    """What a compressed stream says of its image.

    Parameters
    ----------
    marker : int
        Second byte of the marker of the segment that says it.
    rows, cols : int
    bits : int
        Of a number.
    components : int
        Numbers of a pixel.
    """

    marker: int
    rows: int
    cols: int
    bits: int
    components: int


def check_stream(frame: bytes, syntax: str, rows: int, cols: int, allocated: int) -> None:
    r"""Check that a stream is of the process that its transfer syntax names, of the header's image, and whole.

    Parameters
    ----------
    frame : bytes
        One compressed image.
    syntax : str
        UID of its transfer syntax, of the JPEG families.
    rows, cols : int
        Of the header.
    allocated : int
        Bits of a stored number, of the header.

    Raises
    ------
    ValueError
        The decoder would take such a stream, and fill what is missing.

    Examples
    --------
    >>> image = bytes.fromhex("FFC1 000B 0C 0200 0100 01 011100")
    >>> stream = b"\xff\xd8" + image + bytes.fromhex("FFDA 0008 0101 0000 3F00") + bytes(20)
    >>> check_stream(stream + b"\xff\xd9", uid.JPEGExtended12Bit, 512, 256, 16)
    >>> check_stream(stream, uid.JPEGExtended12Bit, 512, 256, 16)
    Traceback (most recent call last):
    ValueError: the stream has no end
    """
    found = read_declared(frame)
    if found is None or found.marker not in _PROCESSES[uid.UID(syntax)]:
        raise ValueError("the stream is of another process than its transfer syntax")
    if (found.rows, found.cols) != (rows, cols):
        raise ValueError("the size in the stream is not that of the header")
    if found.components != 1 or found.bits > allocated:
        raise ValueError("the stream holds colours or more bits than the header")
    end = _end_of_tiles(frame) if found.marker == _SIZ else _end_of_scan(frame, found)
    if frame[end : end + 2] != _END:
        raise ValueError("the stream has no end")
    if frame[end + 2 :].strip(b"\0\xff"):
        raise ValueError("the stream goes on behind its end")


def read_declared(frame: bytes) -> Declared | None:
    """Read what a JPEG, JPEG-LS or JPEG 2000 stream says of its image.

    Parameters
    ----------
    frame : bytes
        One compressed image.

    Returns
    -------
    Declared or None
        None where the stream says nothing.

    Examples
    --------
    The head of a JPEG of 512 x 256 pixels with 12 bits:

    >>> start = bytes.fromhex("FFD8 FFC1 000B 0C 0200 0100 01 011100")
    >>> read_declared(start + bytes(40))
    Declared(marker=193, rows=512, cols=256, bits=12, components=1)
    """
    at = next((at for marker, at in _segments(frame) if marker == _SIZ or marker in _FRAME_MARKERS), 0)
    if not at or at + 42 > len(frame):
        return None
    if frame[at + 1] == _SIZ:  # JPEG 2000: the image's two corners on the reference grid, its tiles, its components
        x1, y1, x0, y0 = (_number(frame, at + 6 + 4 * i, 4) for i in range(4))
        return Declared(_SIZ, y1 - y0, x1 - x0, (frame[at + 40] & 0x7F) + 1, _number(frame, at + 38, 2))
    # JPEG, JPEG-LS: bits, then rows, columns and components
    rows, cols = (_number(frame, at + 5 + 2 * i, 2) for i in range(2))
    return Declared(frame[at + 1], rows, cols, frame[at + 4], frame[at + 9])


def read_part_length(frame: bytes) -> int:
    """Read how many pixels, or blocks of 8 x 8, one part of a JPEG stream holds.

    Parameters
    ----------
    frame : bytes
        One compressed image.

    Returns
    -------
    int
        0 where it is coded in one part.

    Examples
    --------
    >>> read_part_length(bytes.fromhex("FFD8 FFDD 0004 0010 FFDA"))
    16
    """
    return next((_number(frame, at + 4, 2) for marker, at in reversed(_segments(frame)) if marker == _RESTARTS), 0)


def _segments(frame: bytes) -> list[tuple[int, int]]:
    """Marker and place of each segment ahead of the coded data."""
    found: list[tuple[int, int]] = []
    at = 2  # behind the start-of-image marker
    while at + 2 <= len(frame) and frame[at] == 0xFF:
        marker = frame[at + 1]
        if marker == 0xFF:  # filling
            at += 1
            continue
        found.append((marker, at))
        if marker in (_SCAN, _TILE, 0xD9):
            break
        at += 2 + (0 if marker in _NO_LENGTH else _number(frame, at + 2, 2))
    return found


def _end_of_scan(frame: bytes, image: Declared) -> int:
    """Where the coded data of a JPEG or JPEG-LS image end; all of its parts must be there, in their order."""
    marker, at = (_segments(frame) or [(0, 0)])[-1]
    if marker != _SCAN:
        raise ValueError("the stream has no coded data")
    begin = at + 2 + _number(frame, at + 2, 2)
    pattern = _MARK_LS if image.marker in _PROCESSES[uid.JPEGLSLossless] else _MARK
    marks = [(mark[1][0], mark.start()) for mark in pattern.finditer(frame, begin)]
    n = next((i for i, (mark, _) in enumerate(marks) if not 0xD0 <= mark <= 0xD7), len(marks))
    starts, ends = [begin, *(at + 2 for _, at in marks[:n])], [*(at for _, at in marks[: n + 1]), len(frame)]
    in_order = [mark for mark, _ in marks[:n]] == [0xD0 + i % 8 for i in range(n)]
    if not in_order or n != _restarts(frame, image, n) or any(map(int.__ge__, starts, ends)):
        raise ValueError("parts of the stream are missing or out of order")
    return ends[n]


def _restarts(frame: bytes, image: Declared, found: int) -> int:
    """How many marks between parts a JPEG stream must have; JPEG-LS counts in another way, there what was found."""
    length = read_part_length(frame)
    if not length or image.marker in _PROCESSES[uid.JPEGLSLossless]:
        return found if length else 0
    side = 1 if image.marker in _PROCESSES[uid.JPEGLossless] else 8
    return -(-(-(-image.rows // side) * -(-image.cols // side)) // length) - 1


def _end_of_tiles(frame: bytes) -> int:
    """Where the last part of the last tile of a JPEG 2000 image ends; every tile must be there."""
    segments = dict(_segments(frame))
    at, siz = segments.get(_TILE, len(frame)), segments[_SIZ]
    x1, y1, _, _, width, height, x0, y0 = (_number(frame, siz + 6 + 4 * i, 4) for i in range(8))
    n_tiles = -(-(x1 - x0) // max(width, 1)) * -(-(y1 - y0) // max(height, 1))
    seen: set[int] = set()
    while frame[at : at + 2] == b"\xff\x90" and at + 12 <= len(frame):
        seen.add(_number(frame, at + 4, 2))
        length = _number(frame, at + 6, 4)
        # a length of 0: the last part, up to the end
        at = at + length if length >= 14 else frame.rfind(_END) if not length else len(frame)
    if seen != set(range(n_tiles)):
        raise ValueError("tiles of the stream are missing")
    return at


def _number(frame: bytes, at: int, count: int) -> int:
    """A number of some bytes, the highest first."""
    return int.from_bytes(frame[at : at + count], "big")
