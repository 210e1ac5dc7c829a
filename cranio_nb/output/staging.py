"""Files that belong together are written together: into a hidden folder first, then moved, all or none."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import CannotWrite


def check_folder(folder: Path, names: tuple[str, ...]) -> None:
    """Refuse, before any work is done, a folder that cannot take the files; nothing is made.

    Parameters
    ----------
    folder : Path
        It and the folders above it may be missing.
    names : tuple of str
        Names of the files.

    Raises
    ------
    CannotWrite
        A file is in the way of the folder, a folder in the way of a file, or writing is not allowed.

    Examples
    --------
    >>> check_folder(Path("out/deeper"), ("a.txt",))
    """
    folder = folder.absolute()
    there = next(p for p in (folder, *folder.parents) if os.path.lexists(p))
    if not os.path.isdir(there):
        raise CannotWrite("CannotWrite", "A file is in the way of the output folder.", "Name another folder.")
    if not os.access(there, os.W_OK | os.X_OK):
        raise CannotWrite("CannotWrite", "Writing into the output folder is not allowed.", "Name another folder.")
    blocked = [name for name in names if os.path.isdir(folder / name)]
    if blocked:
        message = f"A folder named {blocked[0]} is in the way of the output file."
        raise CannotWrite("CannotWrite", message, "Name another folder.")


@contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """A hidden folder to write into; its contents are moved to `folder` only if all goes well.

    Parameters
    ----------
    folder : Path
        Made if missing. Files of the same names are replaced, each at once; subfolders of the same names as a whole;
        all else stays.

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
    >>> [path.name for path in Path("out").iterdir()]
    ['a.txt']
    """
    # the hidden folder is on the same disk as its goal, so that moving is renaming
    folder = folder.absolute()
    made: list[Path] = []
    try:
        if not folder.exists():
            made = [p for p in folder.parents if not p.exists()]
            folder.parent.mkdir(parents=True, exist_ok=True)
        home = folder if folder.exists() else folder.parent
        with tempfile.TemporaryDirectory(prefix=".part-", dir=home) as temporary:
            part = Path(temporary) / "files"
            part.mkdir()
            yield part
            _publish(part, folder)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise CannotWrite("CannotWrite", f"The output could not be written: {reason}.") from error
    finally:
        for parent in made:
            if parent.exists() and not any(parent.iterdir()):
                parent.rmdir()


def _publish(part: Path, folder: Path) -> None:
    """Move what was written to where it belongs, in the order of writing."""
    if not folder.exists():
        part.replace(folder)
        return
    for item in sorted(part.iterdir(), key=lambda p: p.stat().st_mtime_ns):
        goal = folder / item.name
        if goal.is_dir() and not goal.is_symlink():
            goal.replace(part.parent / f"old-{item.name}")
        item.replace(goal)
