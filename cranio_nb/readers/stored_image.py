"""One image of a NIfTI or NRRD file before anything is made of it, and what reading both kinds of file shares.

Only the declared number of bytes is ever read or inflated.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import BinaryIO, cast

from numpy.typing import NDArray
from zlib_ng import zlib_ng

from ..errors import InputRefused
from ..grid import Affine
from .load_report import Finding

MAX_VOXELS = 2**30
MAX_BYTES = 2**31  # of voxels as stored
GZIP_PACKING, BZIP2_PACKING = 1032, 10**6  # how many times smaller data become at most
NOT_UNPACKED = (EOFError, OSError, cast(type[Exception], zlib_ng.error))
"""What is raised where packed data are none, or are cut short."""
_LARGE_BYTES, _EMPTY_PACKING = 2**28, 1000  # zeros are packed 1030 times, the largest mask of a skull 980 times
_BLOCK = 2**24  # bytes read at once
_MAX_REST_BYTES = 2**26  # bytes


@dataclass(frozen=True, eq=False)
class Image:
    """What a file says, before anything is made of it.

    Parameters
    ----------
    source : {"NIfTI", "NRRD"}
        Kind of the file.
    raw : ndarray, shape (I, J, K)
        The file's own numbers on its own axes.
    affine : ndarray, shape (4, 4)
        Index (i, j, k, 1) -> world mm (LPS).
    slope, intercept : float
        A value is raw * slope + intercept.
    findings : tuple of Finding
        What was noticed.
    """

    source: str
    raw: NDArray
    affine: Affine
    slope: float = 1.0
    intercept: float = 0.0
    findings: tuple[Finding, ...] = ()


def read_voxels(stream: BinaryIO, count: int) -> tuple[bytearray, list[Finding]]:
    """Read as many bytes of voxels as a header declares, and on to the end, where packed data hold their checksum.

    Parameters
    ----------
    stream : binary stream
        At the first voxel, inflated or not. No more than 2^26 bytes behind the voxels are inflated.
    count : int
        Bytes that the header declares.

    Returns
    -------
    bytearray
        `count` of them.
    list of Finding
        A warning where bytes are left; else empty.

    Raises
    ------
    InputRefused
        ``CorruptFile`` where it ends before.

    Examples
    --------
    >>> import io
    >>> read_voxels(io.BytesIO(b"voxels"), 6)
    (bytearray(b'voxels'), [])
    >>> read_voxels(io.BytesIO(b"voxels and more"), 6)[1][0].values
    {'at_least': 9}
    """
    # grows with what is there, and not with what is promised
    content = bytearray()
    while len(content) < count:
        part = stream.read(min(count - len(content), _BLOCK))
        if not part:
            message = f"The file is cut short: it holds {len(content)} of {count} bytes of voxels."
            raise InputRefused("CorruptFile", message, "Copy the file again from its source.")
        content += part
    return content, _bytes_left(stream)


def check_promise(count: int, stored: int, *, packing: int) -> None:
    """Check that a file can hold the bytes of voxels that its header declares, before any is read.

    Parameters
    ----------
    count : int
        Bytes of voxels declared.
    stored : int
        Bytes of the file.
    packing : int
        How many times smaller the encoding makes data at most; 1 for raw voxels.

    Raises
    ------
    InputRefused
        ``LimitExceeded`` beyond `MAX_BYTES`, or for a file packed as no image is; ``CorruptFile`` for a file too
        small for what it declares.

    Examples
    --------
    >>> check_promise(2**20, 2**20 + 352, packing=1)
    >>> check_promise(2**33, 352, packing=1)
    Traceback (most recent call last):
    cranio_nb.errors.InputRefused: The image declares 8590 MB of voxels; at most 2147 MB are read. Crop it to the head.
    """
    if count > MAX_BYTES:
        message = f"The image declares {count / 1e6:.0f} MB of voxels; at most {MAX_BYTES / 1e6:.0f} MB are read."
        raise InputRefused("LimitExceeded", message, "Crop it to the head.")
    if count > stored * packing:
        message = f"The file is cut short: its {stored} bytes cannot hold {count} bytes of voxels."
        raise InputRefused("CorruptFile", message, "Copy the file again from its source.")
    if packing == GZIP_PACKING and count > _LARGE_BYTES and count > stored * _EMPTY_PACKING:
        message = f"The file packs {count / 1e6:.0f} MB into {stored / 1e6:.1f} MB, as a volume of a single value does."
        raise InputRefused("LimitExceeded", message, "Check where the file comes from.")


def stored_bytes(stream: BinaryIO) -> int:
    """Count the bytes of an open file, and leave it where it is.

    Parameters
    ----------
    stream : binary stream
        Not packed.

    Returns
    -------
    int

    Examples
    --------
    >>> import io
    >>> stored_bytes(io.BytesIO(b"four"))
    4
    """
    at = stream.tell()
    size = stream.seek(0, io.SEEK_END)
    stream.seek(at)
    return size


def _bytes_left(stream: BinaryIO) -> list[Finding]:
    """A warning where bytes are left."""
    rest = 0
    while rest <= _MAX_REST_BYTES:
        part = stream.read(2**22)
        if not part:
            break
        rest += len(part)
    if not rest:
        return []
    message = "The file holds more bytes than its header declares voxels; they were left."
    return [Finding("BytesLeft", "warning", message, {"at_least": rest})]


def check_shape(sizes: list[int]) -> tuple[int, int, int]:
    """Check that an image has three axes; further ones of one sample are left out.

    Parameters
    ----------
    sizes : list of int
        Samples along each axis.

    Returns
    -------
    tuple of int
        The three sizes.

    Raises
    ------
    InputRefused
        ``BadShape`` unless three axes remain; ``LimitExceeded`` beyond `MAX_VOXELS`.

    Examples
    --------
    >>> check_shape([512, 512, 68, 1])
    (512, 512, 68)
    """
    if len(sizes) < 3 or any(size != 1 for size in sizes[3:]) or min(sizes) < 1:
        message = f"The image has the sizes {' x '.join(str(s) for s in sizes)}; three axes are wanted."
        raise InputRefused("BadShape", message, "Give one 3-D volume.")
    shape = (int(sizes[0]), int(sizes[1]), int(sizes[2]))
    if shape[0] * shape[1] * shape[2] > MAX_VOXELS:
        message = f"The image declares {' x '.join(str(s) for s in shape)} voxels; at most {MAX_VOXELS} are read."
        raise InputRefused("LimitExceeded", message, "Crop it to the head.")
    return shape


def no_orientation(what: str) -> InputRefused:
    """The refusal for a file that does not say where left is.

    Parameters
    ----------
    what : str
        One sentence: what the file lacks.

    Returns
    -------
    InputRefused
    """
    return InputRefused("NoOrientation", what, "Convert it again with its orientation, or allow no_orientation.")
