"""Folder -> the regular files in it that may be DICOM, in a fixed order. Links are never followed.

Nothing is parsed here, and pydicom is not loaded.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from ...errors import InputRefused
from ..load_report import Finding

MAX_FILES = 20_000
MAX_DEPTH = 8
# A file index by name only: it points elsewhere, and the folder is walked anyway.
_INDEX_NAMES = {"dicomdir"}
IMAGE_SUFFIXES = {".dcm", ".dicom", ".ima"}
_MAC_PREFIX = "._"  # a Mac keeps what other file systems cannot hold in a second file of this name


def looks_like_dicom(start: bytes) -> bool:
    r"""Whether a file's first bytes are those of DICOM, with its preamble or without.

    Parameters
    ----------
    start : bytes
        136 or more.

    Returns
    -------
    bool

    Examples
    --------
    >>> looks_like_dicom(bytes(128) + b"DICM" + b"\x02\x00\x00\x00"), looks_like_dicom(bytes(136))
    (True, False)
    """
    if start[128:132] == b"DICM":
        return start[132:134] in (b"\x02\x00", b"\x08\x00", b"")
    return len(start) >= 132 and start[:2] in (b"\x08\x00", b"\x02\x00") and start[3:4] == b"\x00"


def list_files(folder: Path) -> tuple[list[Path], list[Finding]]:
    """List the regular files below a folder, sorted by name.

    Parameters
    ----------
    folder : Path
        Walked `MAX_DEPTH` levels deep; symbolic links, pipes and devices are left out and counted.

    Returns
    -------
    files : list of Path
    findings : list of Finding
        ``EntriesSkipped`` counts what was left out by its kind.

    Raises
    ------
    InputRefused
        ``LimitExceeded`` for too many files, ``PermissionDenied``.

    Examples
    --------
    >>> Path("scan/a").mkdir(parents=True)
    >>> for name in ("a/2.dcm", "1.dcm", "DICOMDIR"):
    ...     _ = Path("scan", name).write_bytes(bytes(200))
    >>> files, findings = list_files(Path("scan"))
    >>> [file.name for file in files], findings[0].values
    (['1.dcm', '2.dcm'], {'file index': 1})
    """
    files: list[Path] = []
    skipped: Counter[str] = Counter()
    for entry, kind in _walk(folder, depth=0):
        if kind == "file":
            files.append(Path(entry.path))
        else:
            skipped[kind] += 1
        if len(files) + skipped.total() > MAX_FILES:
            raise InputRefused(
                "LimitExceeded",
                f"The folder holds more than {MAX_FILES} files.",
                "Give the folder of one scan.",
            )
    return sorted(files), _skipped_findings(skipped)


def _walk(folder: Path, depth: int) -> Iterator[tuple[os.DirEntry[str], str]]:
    """Each entry of the tree with what it is: a file, or why it is left out."""
    with os.scandir(folder) as entries:
        for entry in sorted(entries, key=lambda e: e.name):
            if entry.is_dir(follow_symlinks=False):
                if depth < MAX_DEPTH:
                    yield from _walk(Path(entry.path), depth + 1)
                else:
                    yield entry, "folder too deep"
            else:
                yield entry, _kind(entry)


def _kind(entry: os.DirEntry[str]) -> str:
    """What an entry is: a file, or why it is left out."""
    if entry.is_symlink():
        return "link"
    if not entry.is_file(follow_symlinks=False):
        return "special file"
    if entry.name.lower() in _INDEX_NAMES:
        return "file index"
    return "Mac leftover" if entry.name.startswith(_MAC_PREFIX) else "file"


def _skipped_findings(skipped: Counter[str]) -> list[Finding]:
    if not skipped:
        return []
    listed = ", ".join(f"{kind}: {count}" for kind, count in sorted(skipped.items()))
    severity = "info" if set(skipped) <= {"file index"} else "warning"
    return [Finding("EntriesSkipped", severity, f"Left out of the folder: {listed}.", dict(skipped))]
