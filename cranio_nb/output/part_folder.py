"""A hidden folder to write into, locked while its process lives; what killed processes left is finished or removed.

A folder ``.part-*`` holds ``lock``, ``files`` while they are written, and ``commit`` from the moment they are whole.
The system frees a lock when its process ends, however it ends: a part folder without a held lock is left over.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from .manifest import MANIFEST, is_ours

PREFIX = ".part-"
"""Start of the names of hidden folders and files."""
_NAME = re.compile(r"\.part-([a-z0-9_]{8}|\d+-.+)")  # as `tempfile` and `files.write_whole` make them
_OLD_S = 3600.0  # where locks are unknown, a part of this age is taken for left over


@contextmanager
def part_folder(place: Path) -> Iterator[Path]:
    """A hidden folder of this process, removed at the end.

    Parameters
    ----------
    place : Path
        Folder to make it in.

    Returns
    -------
    context manager of Path
        The hidden folder; holds an empty folder ``files``.

    Examples
    --------
    >>> with part_folder(Path()) as part:
    ...     [item.name for item in sorted(part.iterdir())]
    ['files', 'lock']
    >>> part.exists()
    False
    """
    part, lock = _new_part(place)
    try:
        (part / "files").mkdir()
        yield part
    finally:
        # what is whole but could not be moved stays for the next run to end
        pending = (part / "commit").exists()
        with suppress(OSError):
            if not pending:
                _clear(part)
        with suppress(OSError):
            _unlock(lock)
        lock.close()
        with suppress(OSError):
            if not pending:
                _remove(part)


@contextmanager
def held_lock(path: Path) -> Iterator[bool]:
    """Hold a file's lock, which the system frees when the process ends, however it ends.

    Parameters
    ----------
    path : Path
        Made if missing; it stays.

    Returns
    -------
    context manager of bool
        Whether this process holds it; False where another one does.

    Examples
    --------
    >>> with held_lock(Path("lock")) as first, held_lock(Path("lock")) as second:
    ...     print(first, second)
    True False
    """
    with open(path, "ab") as lock:
        alone = _hold(lock)
        try:
            yield alone
        finally:
            if alone:
                with suppress(OSError):
                    _unlock(lock)


def commit(part: Path, stale: list[str]) -> None:
    """Declare the files of a part folder whole, and move them into the folder that it lies in.

    From here on a kill cannot undo the replacement: the next run ends it (`sweep`).

    Parameters
    ----------
    part : Path
        From `part_folder`; its ``files`` are moved.
    stale : list of str
        Names in the folder that go.
    """
    (part / "stale.json").write_text(json.dumps(stale), encoding="utf-8")
    (part / "files").rename(part / "commit")
    _finish(part)


def sweep(place: Path) -> None:
    """Finish or remove what killed runs of this user left in a folder; nothing else is touched.

    Parameters
    ----------
    place : Path
        May be missing.
    """
    for part in _parts(place):
        with suppress(OSError, ValueError, TypeError):
            _sweep_one(part)


def is_unfinished(place: Path) -> bool:
    """Whether a replacement of files in a folder was begun and has not ended.

    Parameters
    ----------
    place : Path
        May be missing.

    Returns
    -------
    bool
    """
    return any((part / "commit").is_dir() for part in _parts(place))


def _parts(place: Path) -> list[Path]:
    """Hidden folders and files of ours in a folder."""
    try:
        return [path for path in place.iterdir() if _NAME.fullmatch(path.name)]
    except OSError:
        return []


def _sweep_one(part: Path) -> None:
    """Finish or remove one part, if it is ours and its process has ended."""
    about = part.lstat()
    if hasattr(os, "getuid") and about.st_uid != os.getuid():
        return
    old = time.time() - about.st_mtime > _OLD_S
    if part.is_file() and not part.is_symlink():
        # of `files.write_whole`, named after its process and its goal
        if old:
            part.unlink()
    elif not (part / "lock").is_file():
        part.rmdir()  # fails, as it should, on a folder that holds anything
    else:
        _sweep_locked(part, old)


def _sweep_locked(part: Path, old: bool) -> None:
    """Finish or remove a part folder, unless its lock is held."""
    with open(part / "lock", "rb+") as lock:
        try:
            free = _lock(lock)
        except OSError:
            free = old
        if free:
            if (part / "commit").is_dir():
                _check_plan(part)
                _finish(part)
            _clear(part)
    if free:
        _remove(part)


def _clear(part: Path) -> None:
    """Empty a part folder but for its lock, so that a removal that is killed can be ended by the next one."""
    for item in part.iterdir():
        if item.name != "lock":
            shutil.rmtree(item) if item.is_dir() and not item.is_symlink() else item.unlink()


def _remove(part: Path) -> None:
    """Remove an emptied part folder with its lock, which some systems do only after the lock is closed."""
    (part / "lock").unlink(missing_ok=True)
    part.rmdir()


def _check_plan(part: Path) -> None:
    """Refuse to end a replacement that would touch what no run wrote: a folder from elsewhere may hold such a part."""
    stale = json.loads((part / "stale.json").read_text(encoding="utf-8"))
    names = [*(item.name for item in (part / "commit").iterdir()), *stale]
    if any(Path(name).name != name for name in names):
        raise ValueError("a name leads out of the folder")
    for name in names:
        if os.path.lexists(part.parent / name) and not is_ours(part.parent, name):
            raise ValueError("a file is not of a run")


def _finish(part: Path) -> None:
    """Move whole files to where they belong; may be called again after a kill at any point of it."""
    stale = json.loads((part / "stale.json").read_text(encoding="utf-8"))
    goal, new, old = part.parent, part / "commit", part / "old"
    old.mkdir(exist_ok=True)
    # the manifest goes last: as long as it is the old one, the files do not agree with it
    for item in [item for item in new.iterdir() if item.name != MANIFEST]:
        _move(item, goal / item.name, old / item.name)
    for name in stale:
        if os.path.lexists(goal / name):
            (goal / name).rename(old / name)
    if (new / MANIFEST).exists():
        _move(new / MANIFEST, goal / MANIFEST, old / MANIFEST)
    new.rmdir()


def _move(new: Path, goal: Path, old: Path) -> None:
    """Give a file or folder its place; a folder that has the place is put aside."""
    if os.path.lexists(goal) and ((goal.is_dir() and not goal.is_symlink()) or new.is_dir()):
        goal.rename(old)
    new.replace(goal)


def _new_part(place: Path) -> tuple[Path, IO[bytes]]:
    """A new hidden folder and its lock, held."""
    while True:
        part = Path(tempfile.mkdtemp(prefix=PREFIX, dir=place))
        try:
            lock = open(part / "lock", "wb")
        except FileNotFoundError:  # swept between the two lines
            continue
        if _hold(lock) and (part / "lock").exists():
            return part, lock
        lock.close()


def _hold(lock: IO[bytes]) -> bool:
    """Lock a new file; False where a sweep was faster. Where the system has no locks, age tells what is left over."""
    try:
        return _lock(lock)
    except OSError:
        return True


try:
    import fcntl

    def _lock(file: IO[bytes]) -> bool:
        """Lock a file for this process; False where another one holds it."""
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        return True

    def _unlock(file: IO[bytes]) -> None:
        """Free a file, also for children that hold it open."""
        fcntl.flock(file, fcntl.LOCK_UN)

except ImportError:  # Windows
    import msvcrt

    def _lock(file: IO[bytes]) -> bool:
        """Lock a file for this process; False where another one holds it."""
        try:
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined]
        except PermissionError:
            return False
        return True

    def _unlock(file: IO[bytes]) -> None:
        """Free a file."""
        msvcrt.locking(file.fileno(), msvcrt.LK_UNLCK, 1)  # type: ignore[attr-defined]
