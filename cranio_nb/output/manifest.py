"""What a folder of outputs holds: the name and the SHA-256 digest of every file that was written there.

``manifest.json`` is written last. While the files and their digests agree, they are of one run, and as it wrote them;
what does not agree is not the program's own, and is never replaced or removed.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Collection
from importlib.metadata import version
from pathlib import Path, PurePosixPath

from .files import write_json

MANIFEST = "manifest.json"
"""Name of the file."""


def read_manifest(folder: Path) -> dict[str, str]:
    """Digests by the files' names.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    dict of str to str
        Name within the folder, with "/" -> SHA-256 in hex; empty where there is no manifest.

    Examples
    --------
    >>> read_manifest(Path("nowhere"))
    {}
    """
    try:
        found = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))["files"]
        return {str(name): str(digest) for name, digest in found.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}


def write_manifest(new: Path, folder: Path, owned: Collection[str] = ()) -> list[str]:
    """Write the manifest of files that will come to a folder.

    Parameters
    ----------
    new : Path
        Folder that holds the new files; gets the manifest.
    folder : Path
        Where they will go; entries of its manifest that are not replaced are kept.
    owned : collection of str
        Names that the new files replace as a whole: those that are not among them go.

    Returns
    -------
    list of str
        Names in `folder` that were written before and are not among the new ones.
    """
    names, before = {path.name for path in new.iterdir()}, read_manifest(folder)
    gone = set(owned) - names
    kept = {name: digest for name, digest in before.items() if name.split("/")[0] not in names | gone}
    stale = [name for name in sorted(gone) if os.path.lexists(folder / name) and is_ours(folder, name)]
    record = {"cranio_nb": version("cranio-nb"), "digest": "SHA-256", "files": kept | _digests(new)}
    write_json(new / MANIFEST, record)
    return stale


def is_ours(folder: Path, name: str) -> bool:
    """Whether a file, or a folder with all that is in it, is as a run wrote it.

    Parameters
    ----------
    folder : Path
    name : str
        Of a file or a folder in it.

    Returns
    -------
    bool
        False also where the name is that of a link.

    Examples
    --------
    >>> _ = Path("notes.txt").write_text("mine")
    >>> is_ours(Path(), "notes.txt")
    False
    """
    written, path = read_manifest(folder), folder / name
    if path.is_symlink():
        return False
    if name == MANIFEST:
        return bool(written)
    found = _digests(path, name)
    return bool(found) and all(written.get(inner) == digest for inner, digest in found.items())


def _digests(path: Path, name: str = "") -> dict[str, str]:
    """Digest of a file by its name, or of each file below a folder; a link or a special file has an empty one."""
    files = {name: path} if path.is_file() else {}
    for home, _, names in os.walk(path):  # nothing for a file
        inner = [Path(home) / one for one in names]
        files |= {PurePosixPath(name, one.relative_to(path).as_posix()).as_posix(): one for one in inner}
    found = dict.fromkeys(sorted(files), "")
    for one in found:
        if files[one].is_file() and not files[one].is_symlink():
            with files[one].open("rb") as file:
                found[one] = hashlib.file_digest(file, "sha256").hexdigest()
    return found
