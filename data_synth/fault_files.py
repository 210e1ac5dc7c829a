"""Edits of the files of a written series: cut, renamed, mislabelled, or with others beside them."""

from __future__ import annotations

import os
import struct
import warnings
from collections.abc import Callable
from pathlib import Path

import pydicom
from pydicom.dataset import Dataset

from .fault_series import FileEdit

DICOM_ZERO = bytes(128) + b"DICM"


def cut_file(index: int, keep: float | int) -> FileEdit:
    """One file cut to a part, or to so many bytes."""

    def change(folder: Path) -> None:
        path = folder / f"image{index:04d}.dcm"
        content = path.read_bytes()
        path.write_bytes(content[: keep if isinstance(keep, int) else int(len(content) * keep)])

    return change


def add_file(name: str, content: bytes) -> FileEdit:
    """One more file."""

    def change(folder: Path) -> None:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)

    return change


def rename_files(name: Callable[[int], str]) -> FileEdit:
    """Files named by a rule of their number."""

    def change(folder: Path) -> None:
        for number, path in enumerate(sorted(folder.iterdir())):
            target = folder / name(number)
            target.parent.mkdir(parents=True, exist_ok=True)
            path.rename(target)

    return change


def add_links(folder: Path) -> None:
    """A link to the folder itself, and one to a slice."""
    (folder / "loop").symlink_to(folder)
    (folder / "again.dcm").symlink_to(folder / "image0003.dcm")


def add_pipe(folder: Path) -> None:
    """A pipe named like an image, which must not be opened."""
    os.mkfifo(folder / "pipe.dcm")


def patch_bytes(index: int, old: bytes, new: bytes) -> FileEdit:
    """Bytes of one file changed for others."""

    def change(folder: Path) -> None:
        path = folder / f"image{index:04d}.dcm"
        content = path.read_bytes()
        if content.count(old) != 1 or len(old) != len(new):
            raise ValueError("The bytes to change are not there once.")
        path.write_bytes(content.replace(old, new))

    return change


def relabel_syntax(syntax: str) -> FileEdit:
    """Another transfer syntax in the meta elements than the file has."""

    def change(folder: Path) -> None:
        old = b"UI" + struct.pack("<H", 20) + b"1.2.840.10008.1.2.1\0"
        value = syntax.encode() + b"\0" * (len(syntax) % 2)
        new = b"UI" + struct.pack("<H", len(value)) + value
        for path in folder.iterdir():
            grown = path.read_bytes().replace(old, new, 1)
            at = grown.index(b"\2\0\0\0UL\4\0") + 8
            length = struct.unpack_from("<L", grown, at)[0] + len(new) - len(old)
            path.write_bytes(grown[:at] + struct.pack("<L", length) + grown[at + 4 :])

    return change


def drop_preamble(folder: Path) -> None:
    """Data sets without preamble and meta elements, implicit little endian, as old systems wrote them."""
    for path in folder.iterdir():
        ds = pydicom.dcmread(path)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            pydicom.dcmwrite(path, _without_meta(ds), implicit_vr=True, little_endian=True, force_encoding=True)


def _without_meta(ds: Dataset) -> Dataset:
    plain = Dataset()
    plain.update(ds)
    return plain


def claim_huge_element(folder: Path) -> None:
    """The pixel data of one slice claim 4 GB."""
    path = folder / "image0006.dcm"
    content = bytearray(path.read_bytes())
    at = content.index(b"\xe0\x7f\x10\x00OW") + 8
    content[at : at + 4] = struct.pack("<L", 0xFFFFFFFE)
    path.write_bytes(bytes(content))


def nested_sequences(depth: int) -> bytes:
    """A file of nothing but sequences in sequences."""
    meta = b"\2\0\x10\0UI\x14\x001.2.840.10008.1.2.1\0"
    opened = b"\x40\0\x30\xa7SQ\0\0\xff\xff\xff\xff\xfe\xff\x00\xe0\xff\xff\xff\xff" * depth
    return DICOM_ZERO + meta + opened
