"""Lessons on disk -> JupyterLab open at the tour, set up so that widgets and scenes work.

The settings in ``settings/overrides.json`` keep widget callbacks on the kernel's main thread: from JupyterLab 4.4
on they run on threads of their own, where VTK loses its drawing context. They also keep the lab from asking for news.
"""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

from ...errors import InputRefused

SETTINGS = Path(__file__).parent / "settings"
TOUR = "00_tour.ipynb"


def lessons_folder(folder: Path | None = None) -> Path:
    """The folder that holds the lessons: the one asked for, or the nearest ``notebooks``.

    Parameters
    ----------
    folder : Path, optional

    Returns
    -------
    Path
        Absolute.

    Raises
    ------
    InputRefused
        ``NoLessons`` when the tour is not there.
    """
    near = (Path("notebooks"), Path(), Path(__file__).parents[3] / "notebooks")
    places = near if folder is None else (folder, folder / "notebooks")
    for place in places:
        if (place / TOUR).is_file():
            return place.resolve()
    where = "here" if folder is None else f"in {folder}"
    raise InputRefused("NoLessons", f"There is no {TOUR} {where}.", "Name the folder of the lessons.")


def lab_command(folder: Path, *, browser: bool = True, port: int | None = None) -> list[str]:
    """The command that opens the lessons.

    Parameters
    ----------
    folder : Path
        As `lessons_folder` finds it; the lab shows nothing above it.
    browser : bool
        Whether to open a browser window.
    port : int, optional
        8888 or the next free one when not given.

    Returns
    -------
    list of str
    """
    command = [sys.executable, "-m", "jupyterlab", f"--LabApp.app_settings_dir={SETTINGS}"]
    command += [f"--ServerApp.root_dir={folder}", f"--LabApp.default_url=/lab/tree/{TOUR}"]
    command += [] if browser else ["--no-browser"]
    return command if port is None else [*command, f"--ServerApp.port={port}"]


def open_lab(folder: Path | None = None, *, browser: bool = True, port: int | None = None) -> int:
    """Open JupyterLab at the tour and wait until it is closed.

    Parameters
    ----------
    folder : Path, optional
        As for `lessons_folder`.
    browser, port
        As for `lab_command`.

    Returns
    -------
    int
        Its exit code.

    Raises
    ------
    InputRefused
        ``NoLab`` when JupyterLab is not installed, ``NoLessons`` without lessons.
    """
    if find_spec("jupyterlab") is None:
        raise InputRefused("NoLab", "JupyterLab is not installed.", 'Run: pip install -e ".[lab,view]".')
    command = lab_command(lessons_folder(folder), browser=browser, port=port)
    try:
        return subprocess.run(command, env=lab_environment(), check=False).returncode
    except KeyboardInterrupt:  # the usual way to close a lab
        return 0


def lab_environment() -> dict[str, str]:
    """The environment of the lab and its kernels: VTK looks for no display.

    Returns
    -------
    dict of str to str
    """
    return {"VTK_DEFAULT_OPENGL_WINDOW": "vtkOSOpenGLRenderWindow"} | dict(os.environ)
