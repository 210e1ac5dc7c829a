"""NRRD stream -> `Image`: pynrrd reads the header, the voxels are read here, bounded by what it declares."""

from __future__ import annotations

import bz2
import warnings
from collections.abc import Collection
from typing import Any, BinaryIO, cast

import numpy as np
from numpy.typing import NDArray
from zlib_ng import gzip_ng

from ..errors import InputRefused
from ..grid import Affine
from .load_report import Finding
from .stored_image import (
    BZIP2_PACKING,
    GZIP_PACKING,
    NOT_UNPACKED,
    Image,
    check_promise,
    check_shape,
    no_orientation,
    read_voxels,
    stored_bytes,
)

# sign of (x, y, z) from the file's frame to LPS
_SPACES = {
    "left-posterior-superior": (1, 1, 1),
    "lps": (1, 1, 1),
    "right-anterior-superior": (-1, -1, 1),
    "ras": (-1, -1, 1),
    "left-anterior-superior": (1, -1, 1),
    "las": (1, -1, 1),
}
_MM_PER_UNIT = {"mm": 1.0, "millimeter": 1.0, "cm": 10.0, "m": 1000.0, "um": 1e-3, "": 1.0}
_ENCODINGS = {"raw", "gzip", "gz", "bzip2", "bz2"}
_OTHER_ENCODINGS = {"txt", "text", "ascii", "hex", "zrl"}
_OTHER_TYPES = {"block"}
_TYPES = {
    "i1": ("signed char", "int8", "int8_t"),
    "u1": ("uchar", "unsigned char", "uint8", "uint8_t"),
    "i2": ("short", "short int", "signed short", "signed short int", "int16", "int16_t"),
    "u2": ("ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"),
    "i4": ("int", "signed int", "int32", "int32_t"),
    "u4": ("uint", "unsigned int", "uint32", "uint32_t"),
    "i8": ("longlong", "long long", "long long int", "signed long long", "int64", "int64_t"),
    "u8": ("ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"),
    "f4": ("float",),
    "f8": ("double",),
}
_DTYPES = {name: code for code, names in _TYPES.items() for name in names}


def read_nrrd(stream: BinaryIO, allow: Collection[str] = ()) -> Image:
    """Read a NRRD file that holds its own voxels.

    Parameters
    ----------
    stream, allow
        As for `read_nifti`.

    Returns
    -------
    Image

    Raises
    ------
    InputRefused
        With the codes of `read_nifti`.

    Examples
    --------
    >>> import nrrd
    >>> space = {"space": "RAS", "space directions": np.diag([2.0, 2, 3]), "space origin": np.zeros(3)}
    >>> nrrd.write("scan.nrrd", np.zeros((4, 5, 6), np.int16), space)
    >>> with open("scan.nrrd", "rb") as stream:
    ...     image = read_nrrd(stream)
    >>> image.raw.shape, image.affine.diagonal()
    ((4, 5, 6), array([-2., -2.,  3.,  1.]))
    """
    # three axes in space; others may hold one sample only
    header = _header(stream)
    sizes = [int(n) for n in header["sizes"]]
    directions = _directions(header, len(sizes))
    space = [i for i, row in enumerate(directions) if row is not None] if directions else list(range(len(sizes)))
    if len(space) != 3 and any(size != 1 for size in sizes[3:]):
        check_shape(sizes)
    if directions and (len(space) != 3 or any(sizes[i] != 1 for i in range(len(sizes)) if i not in space)):
        raise _unsupported(f"has {len(space)} axes in space and others besides", "BadShape")
    shape = check_shape([sizes[i] for i in space])

    # as many voxels as the header declares
    dtype = _dtype(header)
    content, rest = _voxel_bytes(stream, header, int(np.prod(shape)) * dtype.itemsize)
    raw = np.frombuffer(content, dtype)
    affine, findings = _affine(header, [directions[i] for i in space] if directions else None, allow)
    native = raw.reshape(shape, order="F").astype(dtype.newbyteorder("="), copy=False)
    return Image("NRRD", native, affine, findings=tuple(findings + rest))


def _header(stream: BinaryIO) -> dict[str, Any]:
    """The fields of the header, and the stream at the first voxel."""
    import nrrd

    try:
        with warnings.catch_warnings():
            # remarks on doubled fields; the values are checked here
            warnings.simplefilter("ignore")
            header = dict(nrrd.read_header(cast(Any, stream)))
        for field in ("type", "sizes", "dimension", "encoding"):
            if field not in header:
                raise _corrupt(f"its header has no {field}")
    except InputRefused:
        raise
    except Exception as error:
        raise _corrupt(f"its header cannot be parsed ({type(error).__name__})") from None

    # damage that the parser lets pass
    start = stream.tell()
    stream.seek(0)
    lines = [line for line in stream.read(start).split(b"\n") if not line.startswith(b"#") and b":=" not in line]
    if not b"".join(lines).isascii():
        raise _corrupt("its header holds characters that do not belong there")
    if "data file" in header or "datafile" in header:
        message = "The voxels of this NRRD file lie in a second file."
        raise InputRefused("UnsupportedFile", message, "Give a single .nrrd file that holds its voxels.")
    if int(header["dimension"]) != len(header["sizes"]):
        raise _corrupt("its dimension and sizes disagree")
    return header


def _voxel_bytes(stream: BinaryIO, header: dict[str, Any], count: int) -> tuple[bytearray, list[Finding]]:
    """The declared bytes of voxels, and a remark where there are more."""
    encoding = str(header["encoding"]).lower()
    # what is skipped or coded otherwise would be misread
    skips = [int(header.get(name, 0)) for name in ("line skip", "lineskip", "byte skip", "byteskip")]
    if encoding not in _ENCODINGS or any(skips):
        what = "skips lines or bytes" if any(skips) else f"has {_known(encoding, _OTHER_ENCODINGS)} encoding"
        raise _unsupported(what)
    packing = 1 if encoding == "raw" else BZIP2_PACKING if encoding.startswith("b") else GZIP_PACKING
    check_promise(count, stored_bytes(stream) - stream.tell(), packing=packing)
    data = stream
    if encoding in ("gzip", "gz"):
        data = cast(BinaryIO, gzip_ng.GzipFile(fileobj=stream))
    elif encoding in ("bzip2", "bz2"):
        data = cast(BinaryIO, bz2.BZ2File(stream))
    try:
        return read_voxels(data, count)
    except NOT_UNPACKED as error:
        raise _corrupt(f"it cannot be unpacked ({type(error).__name__})") from None


def _dtype(header: dict[str, Any]) -> np.dtype:
    """Type and byte order of the voxels."""
    name = str(header["type"]).lower().strip()
    if name not in _DTYPES:
        raise _unsupported(f"has voxels of {_known(name, _OTHER_TYPES)} type", "UnsupportedPixels")
    dtype = np.dtype(_DTYPES[name])
    endian = str(header.get("endian", "")).lower()
    if dtype.itemsize > 1 and endian not in ("little", "big"):
        raise _corrupt("it does not state its byte order")
    return dtype.newbyteorder(">" if endian == "big" else "<")


def _directions(header: dict[str, Any], dimension: int) -> list[NDArray[np.float64] | None]:
    """One vector per axis, None for an axis outside space; empty where the file has none."""
    # rows of nan belong to axes outside space
    rows = header.get("space directions")
    if rows is None:
        return []
    vectors = [None if row is None or np.isnan(row).all() else np.asarray(row, float) for row in rows]
    if len(vectors) != dimension or any(v is not None and v.shape != (3,) for v in vectors):
        raise _corrupt("its space directions do not fit its dimension")
    return vectors


def _affine(
    header: dict[str, Any], directions: list[NDArray[np.float64] | None] | None, allow: Collection[str]
) -> tuple[Affine, list[Finding]]:
    """Index -> LPS mm."""
    signs = _SPACES.get(str(header.get("space", "")).lower())
    findings = []
    if directions is None or signs is None:
        if "no_orientation" not in allow:
            raise no_orientation("The file states no anatomical space with directions: it does not say where left is.")
        message = "The file has no orientation: its axes were taken as left, back and top."
        findings.append(Finding("NoOrientation", "warning", message, {}))

    # columns of the affine: one step along each axis, in the file's own frame and unit
    signs = signs or (1, 1, 1)
    if directions is None:
        columns = np.diag(_three(header, "spacings", np.nan))
    else:
        columns = np.stack([np.full(3, np.nan) if d is None else d for d in directions], axis=1)
    if header.get("space origin") is None:
        findings.append(Finding("NoOrigin", "warning", "The file states no origin: (0, 0, 0) was taken.", {}))

    # mm, LPS
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = columns, _three(header, "space origin", 0.0)
    affine[:3] *= _unit(header)
    return np.diag([*signs, 1.0]) @ affine, findings


def _three(header: dict[str, Any], field: str, absent: float) -> NDArray[np.float64]:
    """The numbers of a field, one for each axis in space; axes outside space come after them, if at all."""
    numbers = header.get(field)
    if numbers is None:
        return np.full(3, absent)
    if len(numbers) < 3:
        raise _corrupt(f"its {field} does not hold three numbers")
    return np.asarray(numbers[:3], float)


def _unit(header: dict[str, Any]) -> float:
    """Mm per unit of the file's space."""
    names = header.get("space units")
    units = {str(u).strip().lower() for u in (names if names is not None else ["mm"])}
    if len(units) != 1 or not units <= set(_MM_PER_UNIT):
        raise InputRefused("BadGeometry", "The file's unit of length is not known.", "Convert the file to mm.")
    return _MM_PER_UNIT[units.pop()]


def _known(text: str, words: Collection[str]) -> str:
    """A word of the format with its article; what is none of its words is not shown."""
    return f"the {text}" if text in words else "an unknown"


def _corrupt(what: str) -> InputRefused:
    return InputRefused("CorruptFile", f"The NRRD file is damaged: {what}.", "Copy the file again from its source.")


def _unsupported(what: str, code: str = "UnsupportedFile") -> InputRefused:
    return InputRefused(code, f"The NRRD file {what}.", "Save it as one 3-D volume, raw or gzip.")
