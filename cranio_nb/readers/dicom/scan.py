"""Folder or file -> the headers of its images; what cannot be read is left out, unless it may be a slice."""

from __future__ import annotations

import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydicom.filereader import data_element_generator
from pydicom.uid import DeflatedExplicitVRLittleEndian, ExplicitVRBigEndian, ImplicitVRLittleEndian

from ...errors import InputRefused
from ..load_report import Finding
from .elements import Converted
from .file_list import IMAGE_SUFFIXES, list_files
from .file_refusals import corrupt
from .parse import CT_CLASSES, parse_file
from .slice_header import SliceHeader, count_frames, read_headers

MAX_IMAGES = 20_000  # of a folder, all frames counted
MAX_INFLATED_IN_ALL = 2**30  # bytes of all deflated files of a folder together
_PREAMBLE = 128  # bytes that a program may use as it likes; it uses them alike in all its files
_CLAIMS = {0x00020010: "syntax", 0x00020002: "class", 0x00080016: "class", 0x00080060: "modality", 0x0020000E: "series"}
_LAST_CLAIM = max(_CLAIMS)


@dataclass(frozen=True)
class Unread:
    """A file that gave no image because it is damaged, or is not DICOM.

    Parameters
    ----------
    file : int
        Index among the folder's files.
    path : Path
        The file.
    size : int
        Bytes.
    error : InputRefused or None
        What is wrong with it; None for a file that does not begin as DICOM.
    sop_class, modality, series : str
        What its readable start says; empty where it says nothing.
    """

    file: int
    path: Path
    size: int
    error: InputRefused | None
    sop_class: str = ""
    modality: str = ""
    series: str = ""


@dataclass(frozen=True)
class Contents:
    """What a folder holds.

    Parameters
    ----------
    headers : list of SliceHeader
        Of all images.
    unread : list of Unread
        Damaged files, and those that are not DICOM.
    without_image : int
        DICOM files that hold no image.
    n_files : int
        All files.
    """

    headers: list[SliceHeader]
    unread: list[Unread]
    without_image: int
    n_files: int


def scan(path: Path) -> tuple[Contents, list[Finding]]:
    """Read the headers of all images of a folder, or of one file.

    Parameters
    ----------
    path : Path
        Folder, or DICOM file.

    Returns
    -------
    contents : Contents
    findings : list of Finding
        What was left out by its kind alone.

    Raises
    ------
    InputRefused
        ``LimitExceeded`` for more than `MAX_IMAGES` images or `MAX_INFLATED_IN_ALL` bytes; for a single file,
        whatever is wrong with it.

    Examples
    --------
    >>> import numpy as np
    >>> from data_synth import write_dicom
    >>> files = write_dicom("scan", np.zeros((8, 4, 4), np.int16), np.eye(4)[[2, 1, 0, 3]])
    >>> _ = Path("scan/notes.txt").write_text("not DICOM")
    >>> contents, findings = scan(Path("scan"))
    >>> len(contents.headers), [unread.path.name for unread in contents.unread]
    (8, ['notes.txt'])
    """
    files, findings = ([path], []) if path.is_file() else list_files(path)
    headers: list[SliceHeader] = []
    unread: list[Unread] = []
    converted: Converted = {}
    without_image = n_frames = n_inflated = 0
    for index, file in enumerate(files):
        try:
            parsed = parse_file(file, index)
            if parsed is None:
                unread.append(Unread(index, file, file.stat().st_size, None))
                continue
            # what the headers promise is bounded before one is made for every frame
            n_frames += count_frames(parsed[0], index)
            n_inflated += 0 if parsed[1] is None else parsed[1].inflated
            images = [] if _over(n_frames, n_inflated) else read_headers(*parsed, index, converted)
        except InputRefused as error:
            if path.is_file():
                raise
            unread.append(_damaged(file, index, error))
            continue
        _check_limits(n_frames, n_inflated)
        headers += images
        without_image += not images
    return Contents(headers, unread, without_image, len(files)), findings


def _over(n_frames: int, n_inflated: int) -> bool:
    return n_frames > MAX_IMAGES or n_inflated > MAX_INFLATED_IN_ALL


def _check_limits(n_frames: int, n_inflated: int) -> None:
    """Refuse a folder that declares more than is read of one."""
    if _over(n_frames, n_inflated):
        what = f"more than {MAX_IMAGES} images" if n_frames > MAX_IMAGES else "more than 1 GB of deflated data"
        raise InputRefused("LimitExceeded", f"The folder holds {what}.", "Give the folder of one scan.")


def _damaged(path: Path, index: int, error: InputRefused) -> Unread:
    """A damaged file with what its readable start says of it."""
    claims = {"syntax": "", "class": "", "modality": "", "series": ""}
    with open(path, "rb") as stream, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            # element by element, so that those before the damage count
            stream.seek(_PREAMBLE)
            if stream.read(4) != b"DICM":
                stream.seek(0)
            for element in data_element_generator(stream, False, True, lambda tag, vr, length: tag >> 16 != 2):
                _add_claim(element, claims)
            syntax = claims["syntax"] or ImplicitVRLittleEndian
            implicit, little = syntax == ImplicitVRLittleEndian, syntax != ExplicitVRBigEndian
            if syntax != DeflatedExplicitVRLittleEndian:
                for element in data_element_generator(stream, implicit, little, lambda tag, *_: tag > _LAST_CLAIM):
                    _add_claim(element, claims)
        except Exception:
            # what was read until here is all that the file says
            pass
    return Unread(
        index,
        path,
        path.stat().st_size,
        error.with_traceback(None),
        claims["class"],
        claims["modality"],
        claims["series"],
    )


def _add_claim(element: Any, claims: dict[str, str]) -> None:
    """Add what an element says; one that is cut says nothing."""
    name, value = _CLAIMS.get(int(element.tag)), element.value
    if name and isinstance(value, bytes) and len(value) == element.length:
        claims[name] = value.decode("ascii", "replace").strip("\0 ")


def leave_unread(contents: Contents, slices: Sequence[SliceHeader]) -> list[Finding]:
    """Leave out the files that were not read, unless one may be a slice of the scan.

    Parameters
    ----------
    contents : Contents
        From `scan`.
    slices : sequence of SliceHeader
        Of the chosen scan.

    Returns
    -------
    list of Finding
        What was left, as a warning where a file is damaged or only named like an image.

    Raises
    ------
    InputRefused
        The error of the first file that may be a slice; a scan that lacks a slice is not the scan.

    Notes
    -----
    A file may be a slice if it says that it is of this series, or if it says nothing, begins as the slices do and
    is named as they are.

    Examples
    --------
    A slice that was cut to 100 bytes is missed; a text file is not:

    >>> import numpy as np
    >>> from data_synth import write_dicom
    >>> files = write_dicom("scan", np.zeros((8, 4, 4), np.int16), np.eye(4)[[2, 1, 0, 3]])
    >>> _ = Path("scan/notes.txt").write_text("not DICOM")
    >>> contents, _ = scan(Path("scan"))
    >>> leave_unread(contents, contents.headers)[0].message
    '1 of 9 files are not DICOM and were left.'
    >>> _ = files[7].write_bytes(files[7].read_bytes()[:100])
    >>> contents, _ = scan(Path("scan"))
    >>> leave_unread(contents, contents.headers)
    Traceback (most recent call last):
    cranio_nb.errors.InputRefused: DICOM file 7 of the folder has only 100 bytes. Copy the scan again from its source.
    """
    paths = sorted({header.place.path for header in slices if header.place is not None})
    names = {_pattern(path) for path in paths}
    start = b"" if not paths else _start(paths[0])
    for unread in contents.unread:
        if _may_be_slice(unread, {header.series for header in slices}, names, start):
            what = (
                f"has only {unread.size} bytes" if unread.size <= 132 else "does not begin as DICOM, as the slices do"
            )
            raise unread.error or corrupt(unread.file, what)
    return _left(contents)


def _may_be_slice(unread: Unread, series: set[str], names: set[str], start: bytes) -> bool:
    """Whether a file that was not read may be a slice of the chosen scan."""
    if unread.series and "" not in series:
        return unread.series in series
    if unread.sop_class not in CT_CLASSES or unread.modality not in ("CT", ""):
        return False
    if unread.sop_class or unread.modality:
        return True
    # it says nothing: an empty file with the suffix of images, or one that begins and is named as slices are
    if unread.size == 0 and unread.path.suffix.lower() in IMAGE_SUFFIXES & {Path(name).suffix for name in names}:
        return True
    return _pattern(unread.path) in names and start.startswith(_start(unread.path))


def _pattern(path: Path) -> str:
    """A file's name with every number replaced: slices of one export differ in numbers only."""
    return re.sub(r"\d+", "#", path.name.lower())


def _start(path: Path) -> bytes:
    with open(path, "rb") as stream:
        return stream.read(_PREAMBLE)


def _left(contents: Contents) -> list[Finding]:
    """What was left out of the folder."""
    findings, total = [], contents.n_files
    broken = [u for u in contents.unread if u.error is not None]
    for unread in broken[:4]:
        message = (
            f"File {unread.file} of the folder in order of name ({unread.size} bytes) cannot be read and says nothing "
            "of being a slice of this scan; it was left out."
        )
        findings.append(Finding("DamagedLeft", "warning", message, {"file": unread.file, "bytes": unread.size}))
    if len(broken) > 4:
        message = f"{len(broken) - 4} more files cannot be read and were left out."
        findings.append(Finding("DamagedLeft", "warning", message, {"files": len(broken)}))
    empty = [u for u in contents.unread if u.error is None and not u.size]
    others = [u for u in contents.unread if u.error is None and u.size]
    if empty:
        message = f"{len(empty)} of {total} files are empty and were left."
        findings.append(Finding("FilesSkipped", "warning", message, {"empty": len(empty)}))
    if others:
        misnamed = any(u.path.suffix.lower() in IMAGE_SUFFIXES for u in others)
        message = f"{len(others)} of {total} files are not DICOM and were left."
        findings.append(Finding("FilesSkipped", "warning" if misnamed else "info", message, {"not_dicom": len(others)}))
    if contents.without_image:
        message = f"{contents.without_image} of {total} files hold no image and were left."
        findings.append(Finding("FilesSkipped", "info", message, {"no_image": contents.without_image}))
    return findings
