"""Every path that a command reads, and every path that it will write -> refused before any work where they meet.

Files are compared by what the system says they are, not by their names: links of both kinds, "..", relative paths and
names in another case are the same file where the system takes them for the same.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path

from ..errors import CannotWrite, InputRefused
from .manifest import MANIFEST, is_ours
from .part_folder import PREFIX, is_unfinished, sweep

Ident = tuple[int, int]  # device and inode
_ROOM_BYTES = 32_000_000  # of a design with its report, and some more
_MAX_ENTRIES = 200_000  # of a folder that is read: readers refuse far fewer
_OTHER = "Name another folder."


def check_reads(reads: Mapping[str, Path | None]) -> None:
    """Refuse paths that are not there, and outputs that a killed run left half replaced.

    Parameters
    ----------
    reads : mapping of str to Path or None
        What a path is called on the command line -> the path; None is left out.

    Raises
    ------
    InputRefused
        ``NotFound`` or ``UnfinishedOutput``, saying which path it is.

    Examples
    --------
    >>> check_reads({"--truth": Path("nowhere.nii.gz")})
    Traceback (most recent call last):
    cranio_nb.errors.InputRefused: There is no file or folder at the path given as --truth. Check the path.
    """
    for name, path in reads.items():
        if path is None:
            continue
        if not os.path.exists(path):
            message = f"There is no file or folder at the path given as {name}."
            raise InputRefused("NotFound", message, "Check the path.")
        if is_unfinished(Path(os.path.realpath(path)).parent):
            message = (
                f"The files beside {name} were being replaced by a run that was stopped: they may not be of one run."
            )
            raise InputRefused("UnfinishedOutput", message, "Run the command that writes them again.")


def check_writes(
    folder: Path,
    names: Collection[str],
    reads: Mapping[str, Path | None] | None = None,
    *,
    results: Collection[str] = (),
    own: Callable[[Path, str], bool] = is_ours,
    n_bytes: int = _ROOM_BYTES,
) -> None:
    """Refuse, before any work is done, to write on, into or over what is read, or over what is not the program's own.

    Parameters
    ----------
    folder : Path
        Where the files go; it and the folders above it may be missing.
    names : collection of str
        Files and folders in it that will be written or removed.
    reads : mapping of str to Path or None
        As for `check_reads`.
    results : collection of str
        Files that were made from what `names` replaces: they would lie beside data that is not theirs.
    own : callable
        Whether the file or folder of this name in `folder` may be replaced; by default what a run wrote, unchanged.
    n_bytes : int
        Room that is wanted on the disk.

    Raises
    ------
    InputRefused
        As `check_reads`.
    CannotWrite
        ``OverInput``, ``NotOurs``, ``OldResults``, ``NoRoom``, or ``CannotWrite`` where the system would refuse.

    Examples
    --------
    >>> check_writes(Path("out/deeper"), ("a.txt",))
    >>> _ = Path("a.txt").write_text("mine")
    >>> check_writes(Path(), ("a.txt",), {"INPUT": Path("a.txt")})
    Traceback (most recent call last):
    cranio_nb.errors.CannotWrite: The output a.txt would replace what is read as INPUT. Name another folder.
    """
    given = {name: path for name, path in (reads or {}).items() if path is not None}
    check_reads(given)
    _check_names(folder, names)
    _check_overlap(folder, (*names, MANIFEST), given)
    check_folder(folder, names)
    for place in (folder, folder.absolute().parent):
        sweep(place)
    _check_ours(folder, names, own)
    for name in results:
        if os.path.lexists(folder / name):
            message = f"The output folder holds {name}, made from data that would be replaced."
            raise CannotWrite("OldResults", message, _OTHER)
    _check_disk(folder, n_bytes)


def check_folder(folder: Path, names: Collection[str]) -> None:
    """Refuse a folder that cannot take the files; nothing is made.

    Parameters
    ----------
    folder : Path
        It and the folders above it may be missing.
    names : collection of str
        Of the files.

    Raises
    ------
    CannotWrite
        A file is in the way of the folder, a folder in the way of a file, or writing is not allowed.

    Examples
    --------
    >>> check_folder(Path("out/deeper"), ("a.txt",))
    """
    there = _nearest(folder)
    if not os.path.isdir(there):
        raise CannotWrite("CannotWrite", "A file is in the way of the output folder.", _OTHER)
    if not os.access(there, os.W_OK | os.X_OK):
        raise CannotWrite("CannotWrite", "Writing into the output folder is not allowed.", _OTHER)
    _check_names(folder, names)


def _check_names(folder: Path, names: Collection[str]) -> None:
    """Refuse a folder that has the name of a file."""
    blocked = [name for name in names if "." in name and os.path.isdir(folder / name)]
    if blocked:
        raise CannotWrite("CannotWrite", f"A folder named {blocked[0]} is in the way of the output file.", _OTHER)


def _nearest(folder: Path) -> Path:
    """The folder itself, or the nearest one above it that is there."""
    folder = folder.absolute()
    return next(p for p in (folder, *folder.parents) if os.path.lexists(p))


def _check_overlap(folder: Path, names: Collection[str], reads: Mapping[str, Path]) -> None:
    """Refuse outputs that are, replace or lie in what is read."""
    homes = {_ident(place) for place in (folder, *Path(os.path.realpath(folder)).parents)} - {None}
    written = {ident: name for name in names for ident in _idents(folder / name)}
    written |= {ident: "folder" for ident in [_ident(folder)] if ident and not folder.is_dir()}
    for label, path in reads.items():
        if path.is_dir() and _ident(path) in homes:
            message = f"The output folder is, or lies in, the folder that is read as {label}."
            raise CannotWrite("OverInput", message, "Nothing is ever written there. " + _OTHER)
        met = next((written[ident] for ident in _idents(path) if ident in written), None)
        if met is not None:
            message = f"The output {met} would replace what is read as {label}."
            raise CannotWrite("OverInput", message, _OTHER)


def _ident(path: Path) -> Ident | None:
    """What the system takes a path for; None where there is nothing."""
    try:
        about = os.stat(path)
    except OSError:
        return None
    return about.st_dev, about.st_ino


def _idents(path: Path) -> Iterator[Ident]:
    """A file, or a folder with all that is in it, as the system tells them apart."""
    seen: set[Ident] = set()
    heap = [path]
    while heap and len(seen) < _MAX_ENTRIES:
        place = heap.pop()
        ident = _ident(place)
        if ident is None or ident in seen:
            continue
        seen.add(ident)
        yield ident
        if place.is_dir():
            try:
                heap += place.iterdir()
            except OSError:
                continue  # what may not be listed is not read, and not written


def _check_ours(folder: Path, names: Collection[str], own: Callable[[Path, str], bool]) -> None:
    """Refuse to replace or remove what no run wrote, or what was changed since."""
    for name in names:
        path = folder / name
        if os.path.lexists(path) and not own(folder, name) and not _is_empty(path):
            message = f"The output folder holds {name}, which no run wrote there as it is now."
            raise CannotWrite("NotOurs", message, "Move it away, or name another folder.")


def _is_empty(path: Path) -> bool:
    """Whether it is a folder without anything in it."""
    return path.is_dir() and not path.is_symlink() and not any(path.iterdir())


def _check_disk(folder: Path, n_bytes: int) -> None:
    """Refuse a disk that is full, or that takes no files whatever the permissions say."""
    there = _nearest(folder)
    try:
        free = shutil.disk_usage(there).free
        with tempfile.TemporaryFile(prefix=PREFIX, dir=there):
            pass
    except OSError as error:
        reason = error.strerror or type(error).__name__
        message = f"The output folder takes no files: {reason}."
        raise CannotWrite("CannotWrite", message, _OTHER) from error
    if free < n_bytes:
        message = f"The disk of the output folder has {free / 1e6:.0f} MB free; {n_bytes / 1e6:.0f} MB are wanted."
        raise CannotWrite("NoRoom", message, "Make room, or name a folder on another disk.")
