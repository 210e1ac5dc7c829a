"""Compressed stream of one image -> what it says of itself, and whether it is whole.

Decoders fill in what a stream lacks and pass over what it has too much. So a stream is walked from mark to mark before
it is decoded: its size, bits and components are those of the header, it ends where its image does, and of a JPEG 2000
image every tile is there. Other values within the coded data of a JPEG 2000 image cannot be told: it has no check sum.
"""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass
from functools import cached_property

from pydicom import uid

JPEG = {uid.JPEGBaseline8Bit, uid.JPEGExtended12Bit, uid.JPEGLossless, uid.JPEGLosslessSV1}
"""Transfer syntaxes of JPEG's first standard."""
JPEG_LS = {uid.JPEGLSLossless, uid.JPEGLSNearLossless}
JPEG2000 = {uid.JPEG2000Lossless, uid.JPEG2000, uid.HTJ2KLossless, uid.HTJ2KLosslessRPCL, uid.HTJ2K}
_SCAN, _RESTARTS, _SIZ, _TILE, _FRAME_LS = 0xDA, 0xDD, 0x51, 0x90, 0xF7
# start-of-frame markers of each process: baseline, extended, lossless, JPEG-LS
_PROCESSES = {
    uid.JPEGBaseline8Bit: {0xC0},
    uid.JPEGExtended12Bit: {0xC0, 0xC1},
    uid.JPEGLossless: {0xC3},
    uid.JPEGLosslessSV1: {0xC3},
    **{syntax: {_FRAME_LS} for syntax in JPEG_LS},
    **{syntax: {_SIZ} for syntax in JPEG2000},
}
# markers before the size: start of frame of JPEG and JPEG-LS (all but tables), and SIZ of JPEG 2000
_FRAME_MARKERS = {*range(0xC0, 0xD0), _FRAME_LS} - {0xC4, 0xC8, 0xCC}
_NO_LENGTH = {0x01, *range(0xD0, 0xD9)}
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


@dataclass(frozen=True)
class CompressedStream:
    """The bytes of one image in JPEG, JPEG-LS or JPEG 2000.

    Parameters
    ----------
    data : bytes

    Examples
    --------
    The head of a JPEG of 512 x 256 pixels with 12 bits:

    >>> start = bytes.fromhex("FFD8 FFC1 000B 0C 0200 0100 01 011100")
    >>> CompressedStream(start + bytes(40)).image
    Declared(marker=193, rows=512, cols=256, bits=12, components=1)
    """

    data: bytes

    @cached_property
    def segments(self) -> list[tuple[int, int]]:
        """Marker and place of each segment ahead of the coded data.

        Returns
        -------
        list of (int, int)
        """
        found: list[tuple[int, int]] = []
        at = 2  # behind the start-of-image marker
        while at + 2 <= len(self.data) and self.data[at] == 0xFF:
            marker = self.data[at + 1]
            if marker == 0xFF:  # filling
                at += 1
                continue
            found.append((marker, at))
            if marker in (_SCAN, _TILE, 0xD9):
                break
            at += 2 + (0 if marker in _NO_LENGTH else int.from_bytes(self.data[at + 2 : at + 4]))
        return found

    @cached_property
    def image(self) -> Declared | None:
        """What it says of its image.

        Returns
        -------
        Declared or None
            None where it says nothing.
        """
        data = self.data
        at = next((at for marker, at in self.segments if marker == _SIZ or marker in _FRAME_MARKERS), 0)
        if not at or at + 42 > len(data):
            return None
        if data[at + 1] == _SIZ:  # JPEG 2000: the image's two corners on the reference grid, its tiles, its components
            x1, y1, x0, y0 = struct.unpack_from(">4L", data, at + 6)
            return Declared(_SIZ, y1 - y0, x1 - x0, (data[at + 40] & 0x7F) + 1, int.from_bytes(data[at + 38 : at + 40]))
        # JPEG, JPEG-LS: bits, then rows, columns and components
        rows, cols = struct.unpack_from(">2H", data, at + 5)
        return Declared(data[at + 1], rows, cols, data[at + 4], data[at + 9])

    @cached_property
    def part_length(self) -> int:
        """How many pixels, or blocks of 8 x 8, one part of a JPEG stream holds; 0 where it is coded in one part.

        Returns
        -------
        int
        """
        places = [at for marker, at in self.segments if marker == _RESTARTS]
        return int.from_bytes(self.data[places[-1] + 4 : places[-1] + 6]) if places else 0

    @cached_property
    def restarts(self) -> int | None:
        """How many marks must stand between the parts of a JPEG stream.

        Returns
        -------
        int or None
            None where it is not known: JPEG-LS counts in another way.
        """
        if not self.part_length or self.image is None:
            return 0
        if self.image.marker == _FRAME_LS:
            return None
        side = 1 if self.image.marker in _PROCESSES[uid.JPEGLossless] else 8
        return -(-(-(-self.image.rows // side) * -(-self.image.cols // side)) // self.part_length) - 1

    @cached_property
    def end_of_scan(self) -> int:
        """Where the coded data of a JPEG or JPEG-LS image end; all of its parts must be there, in their order.

        Returns
        -------
        int

        Raises
        ------
        ValueError
        """
        data, (marker, at) = self.data, (self.segments or [(0, 0)])[-1]
        if marker != _SCAN or self.image is None:
            raise ValueError("the stream has no coded data")
        begin, pattern = (
            at + 2 + int.from_bytes(data[at + 2 : at + 4]),
            _MARK_LS if self.image.marker == _FRAME_LS else _MARK,
        )
        marks = [(mark[1][0], mark.start()) for mark in pattern.finditer(data, begin)]
        n = next((i for i, (mark, _) in enumerate(marks) if not 0xD0 <= mark <= 0xD7), len(marks))
        starts, ends = [begin, *(at + 2 for _, at in marks[:n])], [*(at for _, at in marks[: n + 1]), len(data)]
        in_order = [mark for mark, _ in marks[:n]] == [0xD0 + i % 8 for i in range(n)]
        if not in_order or self.restarts not in (None, n) or any(map(int.__ge__, starts, ends)):
            raise ValueError("parts of the stream are missing or out of order")
        return ends[n]

    @cached_property
    def end_of_tiles(self) -> int:
        """Where the last part of the last tile of a JPEG 2000 image ends; every tile must be there.

        Returns
        -------
        int

        Raises
        ------
        ValueError
        """
        data, segments = self.data, dict(self.segments)
        at, siz = segments.get(_TILE, len(data)), segments[_SIZ]
        x1, y1, _, _, width, height, x0, y0 = (
            int.from_bytes(data[siz + 6 + 4 * i : siz + 6 + 4 * i + 4]) for i in range(8)
        )
        n_tiles = -(-(x1 - x0) // max(width, 1)) * -(-(y1 - y0) // max(height, 1))
        seen: set[int] = set()
        while data[at : at + 2] == b"\xff\x90" and at + 12 <= len(data):
            seen.add(int.from_bytes(data[at + 4 : at + 6]))
            length = int.from_bytes(data[at + 6 : at + 10])
            # a length of 0: the last part, up to the end
            at = at + length if length >= 14 else data.rfind(_END) if not length else len(data)
        if len(seen) != n_tiles or max(seen, default=0) >= n_tiles:
            raise ValueError("tiles of the stream are missing")
        return at


def check_stream(stream: CompressedStream, syntax: str, rows: int, cols: int, allocated: int) -> None:
    r"""Check that a stream is of the process that its transfer syntax names, of the header's image, and whole.

    Parameters
    ----------
    stream : CompressedStream
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
    >>> data = b"\xff\xd8" + image + bytes.fromhex("FFDA 0008 0101 0000 3F00") + bytes(20)
    >>> check_stream(CompressedStream(data + b"\xff\xd9"), uid.JPEGExtended12Bit, 512, 256, 16)
    >>> check_stream(CompressedStream(data), uid.JPEGExtended12Bit, 512, 256, 16)
    Traceback (most recent call last):
    ValueError: the stream has no end
    """
    found = stream.image
    if found is None or found.marker not in _PROCESSES[uid.UID(syntax)]:
        raise ValueError("the stream is of another process than its transfer syntax")
    if (found.rows, found.cols) != (rows, cols):
        raise ValueError("the size in the stream is not that of the header")
    if found.components != 1 or found.bits > allocated:
        raise ValueError("the stream holds colours or more bits than the header")
    end = stream.end_of_tiles if found.marker == _SIZ else stream.end_of_scan
    if stream.data[end : end + 2] != _END:
        raise ValueError("the stream has no end")
    if stream.data[end + 2 :].strip(b"\0\xff"):
        raise ValueError("the stream goes on behind its end")
