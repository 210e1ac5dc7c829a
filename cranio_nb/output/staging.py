"""Files that belong together are written together: into a hidden folder first, then given their places, all or none.

Where a folder holds nothing else, the new one takes its place in one step of the system. Elsewhere the files are moved
one by one, and what a kill interrupts is ended by the next run; until then the manifest does not agree with the files.
"""

from __future__ import annotations

import ctypes
import os
import shutil
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import CannotWrite
from .files import write_whole
from .manifest import MANIFEST, read_manifest, write_manifest
from .part_folder import commit, part_folder, sweep

_SWAP = 2  # RENAME_EXCHANGE of Linux, RENAME_SWAP of macOS
_HERE = -100  # AT_FDCWD


@contextmanager
def staged(folder: Path, owned: Collection[str] = ()) -> Iterator[Path]:
    """A hidden folder to write into; its contents are moved to `folder` only if all goes well.

    Parameters
    ----------
    folder : Path
        Made if missing. What has the names of the new files is replaced, folders as a whole; all else stays.
    owned : collection of str
        Names that belong together: where an earlier run wrote one that the new files lack, it goes.

    Returns
    -------
    context manager of Path
        The hidden folder.

    Raises
    ------
    CannotWrite
        If the system refuses.

    Examples
    --------
    >>> with staged(Path("out")) as part:
    ...     _ = (part / "a.txt").write_text("words")
    >>> sorted(path.name for path in Path("out").iterdir())
    ['a.txt', 'manifest.json']
    """
    folder = Path(os.path.realpath(folder))
    made: list[Path] = []
    try:
        made = [p for p in folder.parents if not p.exists()]
        folder.parent.mkdir(parents=True, exist_ok=True)
        sweep(folder.parent)
        sweep(folder)
        # the hidden folder is on the same disk as its goal, so that moving is renaming
        with part_folder(folder.parent if _can_swap(folder, owned) else folder) as part:
            yield part / "files"
            stale = write_manifest(part / "files", folder, owned)
            _publish(part, folder, owned, stale)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise CannotWrite("CannotWrite", f"The output could not be written: {reason}.") from error
    finally:
        for parent in made:
            if parent.exists() and not any(parent.iterdir()):
                parent.rmdir()


def replace_file(path: Path, data: bytes) -> None:
    """Write a file that belongs to no others, whole or not at all; what a killed run left beside it goes.

    Parameters
    ----------
    path : Path
        Folders above it are made where they are missing.
    data : bytes

    Raises
    ------
    CannotWrite
        If the system refuses; what was there before is still there.

    Examples
    --------
    >>> replace_file(Path("notes/a.txt"), b"words")
    >>> [item.name for item in Path("notes").iterdir()]
    ['a.txt']
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        sweep(path.parent)
        with part_folder(path.parent) as part:
            write_whole(part / "files" / path.name, data)
            (part / "files" / path.name).replace(path)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise CannotWrite("CannotWrite", f"{path.name} could not be written: {reason}.") from error


def _publish(part: Path, folder: Path, owned: Collection[str], stale: list[str]) -> None:
    """Move what was written to where it belongs."""
    new = part / "files"
    if not folder.exists():
        new.rename(folder)
        return
    if part.parent == folder:
        commit(part, stale)
        return
    known = {*owned, *(path.name for path in new.iterdir())}
    shutil.copystat(folder, new)
    if not _others(folder, known) and _swap(new, folder):
        # the old folder, now in the hidden one, goes with it; but for what came in the last moment
        for name in _others(new, known):
            (new / name).rename(folder / name)
        return
    with part_folder(folder) as inner:
        (inner / "files").rmdir()
        new.rename(inner / "files")
        commit(inner, stale)


def _can_swap(folder: Path, owned: Collection[str]) -> bool:
    """Whether a new folder may take the place of this one: it holds nothing else, and nobody's work starts from it."""
    if not folder.exists():
        return True
    here, parent = Path(os.path.realpath(os.curdir)), folder.parent
    return (
        not here.is_relative_to(folder)
        and not os.path.ismount(folder)
        and os.access(parent, os.W_OK | os.X_OK)
        and folder.stat().st_dev == parent.stat().st_dev
        and not _others(folder, {*owned, *(name.split("/")[0] for name in read_manifest(folder))})
    )


def _others(folder: Path, names: Collection[str]) -> list[str]:
    """What a folder holds beside the named files and the manifest."""
    return sorted({path.name for path in folder.iterdir()} - {MANIFEST, *names})


def _swap(a: Path, b: Path) -> bool:
    """Exchange the names of two folders in one step; False where the system cannot."""
    try:
        system = ctypes.CDLL(None, use_errno=True)
    except (OSError, TypeError):
        return False
    first, second = os.fsencode(a), os.fsencode(b)
    if hasattr(system, "renameat2"):
        return system.renameat2(_HERE, first, _HERE, second, _SWAP) == 0
    if hasattr(system, "renamex_np"):
        return system.renamex_np(first, second, _SWAP) == 0
    return False
