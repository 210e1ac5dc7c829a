"""The lessons that come with the package: where they are, and copies of them to work in.

A checkout has them in its folder ``notebooks``; an installed package holds them among its own files.
"""

from __future__ import annotations

from pathlib import Path

from ..errors import InputRefused
from ..output.files import write_whole
from ..output.staging import staged

TOUR = "00_tour.ipynb"
"""The lesson that is shown first."""
EXERCISES_HOME = "exercises"
"""Folder of the copies that students fill in, beside the solved ones."""
_PACKAGE = Path(__file__).parents[1]
_HOMES = (_PACKAGE / "teaching" / "notebooks", _PACKAGE.parent / "notebooks")


def shipped_lessons() -> Path:
    """The folder of the lessons that came with the package; to be read, not to be worked in.

    Returns
    -------
    Path
        Holds ``NN_topic.ipynb`` and ``exercises/NN_topic.ipynb``.

    Raises
    ------
    InputRefused
        ``NoLessons`` where the installation has lost them.

    Examples
    --------
    >>> (shipped_lessons() / "exercises" / TOUR).is_file()
    True
    """
    found = next((home for home in _HOMES if (home / TOUR).is_file()), None)
    if found is None:
        raise InputRefused("NoLessons", "This installation holds no lessons.", f"Run: {install_command('lab,view')}.")
    return found


def lesson_names() -> list[str]:
    """The notebooks that come with the package.

    Returns
    -------
    list of str
        Solved lessons and students' copies, as paths within the folder.

    Examples
    --------
    >>> lesson_names()[0], len(lesson_names())
    ('00_tour.ipynb', 24)
    """
    home = shipped_lessons()
    found = (*home.glob("*.ipynb"), *home.glob(f"{EXERCISES_HOME}/*.ipynb"))
    return sorted(path.relative_to(home).as_posix() for path in found)


def copy_lessons(out: Path) -> list[Path]:
    """Copy the lessons to a folder to work in.

    Parameters
    ----------
    out : path
        Made where it is missing.

    Returns
    -------
    list of Path
        The copies: solved lessons, and below ``exercises`` those to be filled in.

    Raises
    ------
    InputRefused
        ``NoLessons``.
    CannotWrite
        If the system refuses.
    """
    home, names = shipped_lessons(), lesson_names()
    with staged(out) as part:
        (part / EXERCISES_HOME).mkdir()
        for name in names:
            write_whole(part / name, (home / name).read_bytes())
    return [out / name for name in names]


def install_command(extra: str) -> str:
    """What installs an extra of the package, in a checkout or from an index.

    Parameters
    ----------
    extra : str

    Returns
    -------
    str
    """
    source = "-e '.[{}]'" if (_PACKAGE.parent / "pyproject.toml").is_file() else "'cranio-nb[{}]'"
    return f"pip install {source.format(extra)}"
