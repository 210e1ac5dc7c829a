"""One image of a NIfTI or NRRD file before anything is made of it, and what reading both kinds of file shares.

Only the declared number of bytes is ever read or inflated.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import BinaryIO

from numpy.typing import NDArray

from ..errors import InputRefused
from ..grid import Affine
from .load_report import Finding

MAX_VOXELS = 2**30
_MAX_REST = 2**26  # bytes


@dataclass(frozen=True, eq=False)
class Image:
    """What a file says, before anything is made of it.

    `raw` has the file's own axes (i, j, k) and numbers; `affine` maps their index to LPS mm; a value is
    raw * `slope` + `intercept`.
    """

    source: str
    raw: NDArray
    affine: Affine
    slope: float = 1.0
    intercept: float = 0.0
    findings: tuple[Finding, ...] = ()


def read_exactly(stream: BinaryIO, count: int) -> bytearray:
    """`count` bytes of a stream, inflated or not.

    Raises
    ------
    InputRefused
        ``CorruptFile`` where it ends before.
    """
    content = bytearray(count)
    view, filled = memoryview(content), 0
    while filled < count:
        part = stream.read(min(count - filled, 2**24))
        if not part:
            message = f"The file is cut short: it holds {filled} of {count} bytes of voxels."
            raise InputRefused("CorruptFile", message, "Copy the file again from its source.")
        view[filled : filled + len(part)] = part
        filled += len(part)
    return content


def check_rest(stream: BinaryIO) -> list[Finding]:
    """Read on to the end, where packed data hold their checksum; what is left there is remarked upon.

    No more than `_MAX_REST` bytes are inflated for it.
    """
    rest = 0
    while rest <= _MAX_REST:
        part = stream.read(2**22)
        if not part:
            break
        rest += len(part)
    if not rest:
        return []
    message = "The file holds more bytes than its header declares voxels; they were left."
    return [Finding("BytesLeft", "warning", message, {"at_least": rest})]


def spatial_shape(sizes: list[int]) -> tuple[int, int, int]:
    """Three sizes of an image, axes of one sample beyond the third left out.

    Raises
    ------
    InputRefused
        ``BadShape`` unless three axes remain; ``LimitExceeded`` beyond `MAX_VOXELS`.
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
    """The refusal for a file that does not say where left is."""
    return InputRefused("NoOrientation", what, "Convert it again with its orientation, or allow no_orientation.")
