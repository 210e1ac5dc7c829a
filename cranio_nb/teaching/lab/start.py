"""Lessons on disk -> JupyterLab open at the tour, set up so that widgets and scenes work.

The settings in ``settings/overrides.json`` keep widget callbacks on the kernel's main thread: from JupyterLab 4.4
on they run on threads of their own, where VTK loses its drawing context. They also keep the lab from asking for news.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ...errors import InputRefused
from ..shipped import EXERCISES_HOME, TOUR, install_command

SETTINGS = Path(__file__).parent / "settings"
"""Folder of JupyterLab's settings."""
_HERE_ONLY = ("--ServerApp.ip=127.0.0.1", "--ServerApp.allow_remote_access=False")
_PATIENCE_S = 10  # for a lab to end its kernels


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
    # beside the working folder first, then in the checkout the package lies in
    near = (Path("notebooks"), Path(), Path(__file__).parents[3] / "notebooks")
    places = near if folder is None else (folder, folder / "notebooks")
    for place in places:
        if (place / TOUR).is_file():
            return place.resolve()
    where = "here" if folder is None else f"in {folder}"
    advice = "Name the folder of the lessons; `cranio-nb lessons copy lessons` makes one."
    raise InputRefused("NoLessons", f"There is no {TOUR} {where}.", advice)


def first_shown(folder: Path) -> str:
    """The notebook that is opened: the tour to be filled in, where there is one.

    Parameters
    ----------
    folder : Path
        As `lessons_folder` finds it.

    Returns
    -------
    str
        Path within the folder.

    Examples
    --------
    >>> first_shown(Path("nowhere"))
    '00_tour.ipynb'
    """
    students = f"{EXERCISES_HOME}/{TOUR}"
    return students if (folder / students).is_file() else TOUR


def lab_command(folder: Path, *, browser: bool = True, port: int | None = None, allow_root: bool = False) -> list[str]:
    """The command that opens the lessons.

    Parameters
    ----------
    folder : Path
        As `lessons_folder` finds it; the lab shows nothing above it.
    browser : bool
        Whether to open a browser window.
    port : int, optional
        8888 or the next free one when not given.
    allow_root : bool
        Whether the lab may run with the rights of the system's administrator.

    Returns
    -------
    list of str

    Examples
    --------
    >>> lab_command(Path("notebooks"), port=9000)[-1]
    '--ServerApp.port=9000'
    """
    # the same Python, the package's settings, nothing above the lessons' folder
    command = [sys.executable, "-m", "jupyterlab", f"--LabApp.app_settings_dir={SETTINGS}"]
    command += [f"--ServerApp.root_dir={folder}", f"--LabApp.default_url=/lab/tree/{first_shown(folder)}"]
    command += [] if browser else ["--no-browser"]
    command += ["--allow-root"] if allow_root else []
    return command if port is None else [*command, f"--ServerApp.port={port}"]


def open_lab(
    folder: Path | None = None, *, browser: bool = True, port: int | None = None, allow_root: bool = False
) -> int:
    """Open JupyterLab at the students' tour, for this machine only, and wait until it is closed.

    Parameters
    ----------
    folder : Path, optional
        As for `lessons_folder`.
    browser, port, allow_root
        As for `lab_command`.

    Returns
    -------
    int
        The lab's exit code; 0 where a signal ended it.

    Raises
    ------
    InputRefused
        ``NoLab`` when JupyterLab is not installed, ``NoLessons`` without lessons, ``RootLab`` for root unless allowed.
    """
    if find_spec("jupyterlab") is None:
        raise InputRefused("NoLab", "JupyterLab is not installed.", f"Run: {install_command('lab,view')}.")
    if not allow_root and hasattr(os, "geteuid") and os.geteuid() == 0:
        message = "You are root, and whatever a notebook runs would have all rights on this machine."
        raise InputRefused("RootLab", message, "Log in as another user, or add --allow-root.")
    command = lab_command(lessons_folder(folder), browser=browser, port=port, allow_root=allow_root)
    return _run_until_signal([*command, *_HERE_ONLY])


def lab_environment() -> dict[str, str]:
    """The environment of the lab and its kernels: VTK looks for no display.

    Returns
    -------
    dict of str to str
    """
    return {"VTK_DEFAULT_OPENGL_WINDOW": "vtkOSOpenGLRenderWindow"} | dict(os.environ)


def _run_until_signal(command: list[str]) -> int:
    """Run the lab until it ends, or until a signal does; nothing of it outlives this process."""
    started: list[subprocess.Popen[bytes]] = []
    with _signals_interrupt():
        try:
            # a session of its own: Ctrl+C comes here only, and the lab does not ask whether it is meant
            started.append(subprocess.Popen(command, env=lab_environment(), start_new_session=True))
            return started[0].wait()
        except KeyboardInterrupt:  # the usual way to close a lab
            return 0
        finally:
            for lab in started:
                _end(lab)


def _end(lab: subprocess.Popen[bytes]) -> None:
    """Ask the lab to end its kernels and itself; insist after a while."""
    if lab.poll() is not None:
        return
    lab.terminate()
    try:
        lab.wait(_PATIENCE_S)
    except subprocess.TimeoutExpired:
        lab.kill()
        lab.wait()


@contextmanager
def _signals_interrupt() -> Iterator[None]:
    """Within it the signals that end a program do so as Ctrl+C does: by KeyboardInterrupt, and only once."""
    if threading.current_thread() is not threading.main_thread():  # only the main thread may set handlers
        yield
        return
    ending = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]

    def interrupt(*_: Any) -> None:
        for each in ending:
            signal.signal(each, signal.SIG_IGN)
        raise KeyboardInterrupt

    before = {each: signal.signal(each, interrupt) for each in ending}
    try:
        yield
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)
