"""An open DICOM file -> the stream of its data set, inflated where it is deflated, and no farther than it is read.

The size of the inflated data is capped: a small file may hold a very large one.
"""

from __future__ import annotations

import io
import zlib
from typing import BinaryIO, cast

from pydicom.dataset import Dataset
from pydicom.filereader import read_dataset
from pydicom.uid import DeflatedExplicitVRLittleEndian

from .file_refusals import over_limit

MAX_INFLATED = 256 * 2**20  # bytes of one inflated file


def open_dataset(stream: BinaryIO, file: int) -> tuple[Dataset, BinaryIO]:
    """Read the meta elements of an open file, and come to the start of its data set.

    Parameters
    ----------
    stream : binary stream
        The whole file.
    file : int
        Index among the folder's files.

    Returns
    -------
    meta : Dataset
        Elements of group 2.
    stream : binary stream
        At the first element of the data set; `Inflated`, where the file is deflated.
    """
    stream.seek(128)
    # without preamble the elements begin at once
    if stream.read(4) != b"DICM":
        stream.seek(0)
    meta = read_dataset(stream, False, True, stop_when=lambda tag, vr, length: tag >> 16 != 2)
    # deflated: everything behind the meta elements is one packed stream
    if meta.get("TransferSyntaxUID") != DeflatedExplicitVRLittleEndian:
        return meta, stream
    return meta, cast(BinaryIO, Inflated(stream, file))


class Inflated:
    """A packed stream as the bytes it holds, inflated no farther than it is read.

    Parameters
    ----------
    stream : binary stream
        At the start of the packed data; it must stay open.
    file : int
        Index among the folder's files.

    Examples
    --------
    >>> packer = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
    >>> data = Inflated(io.BytesIO(packer.compress(bytes(10**7) + b"end") + packer.flush()), 0)
    >>> len(data.read(2)), data.tell(), data.size < 10**6
    (2, 2, True)
    """

    def __init__(self, stream: BinaryIO, file: int) -> None:
        self._stream, self._file = stream, file
        self._packer = zlib.decompressobj(-zlib.MAX_WBITS)
        self._bytes = bytearray()
        self._at = 0

    @property
    def size(self) -> int:
        """Bytes inflated so far."""
        return len(self._bytes)

    def read(self, count: int) -> bytes:
        """Read bytes.

        Parameters
        ----------
        count : int
            How many at most.

        Returns
        -------
        bytes
            Fewer at the end.

        Raises
        ------
        InputRefused
            ``LimitExceeded`` for more than `MAX_INFLATED` bytes from the start.
        """
        end = self._at + count
        if end > MAX_INFLATED:
            raise over_limit(self._file, "bytes once inflated", f"more than {MAX_INFLATED}", MAX_INFLATED)
        while len(self._bytes) < end and not self._packer.eof:
            packed = self._packer.unconsumed_tail or self._stream.read(2**16)
            if not packed:
                break
            self._bytes += self._packer.decompress(packed, max(end - len(self._bytes), 2**16))
        part = bytes(self._bytes[self._at : end])
        self._at = min(end, max(self._at, len(self._bytes)))
        return part

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        """Go to a place, counted from the start or from here.

        Parameters
        ----------
        offset : int
            Bytes.
        whence : int
            `io.SEEK_SET` or `io.SEEK_CUR`.

        Returns
        -------
        int
            The place.
        """
        self._at = offset + (self._at if whence == io.SEEK_CUR else 0)
        return self._at

    def tell(self) -> int:
        """Where the next byte is read.

        Returns
        -------
        int
            Bytes from the start.
        """
        return self._at
