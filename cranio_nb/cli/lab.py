"""The command `cranio-nb lab`: for students."""

from __future__ import annotations

from pathlib import Path

import click

from ..options import Option
from .options import PATH, debug, number

PORT = Option("Port to listen on.", 1024, 65535, whole=True)
"""Lower ones are the system's own."""


@click.command()
@click.argument("folder", required=False, type=PATH)
@click.option("--no-browser", is_flag=True, help="Print the address instead of opening a browser.")
@number("--port", PORT, "8888, or the next free one")
@click.option("--allow-root", is_flag=True, help="Open it also as root: notebooks then have all rights.")
@debug
def lab(folder: Path | None, no_browser: bool, port: int | None, allow_root: bool) -> None:
    """Open the lessons in JupyterLab, at the tour to be filled in.

    FOLDER holds the lessons; by default ./notebooks. `cranio-nb lessons copy lessons` makes such a folder. Nothing but
    JupyterLab is started; Ctrl+C ends it and its kernels.

    \b
    Examples:
      cranio-nb lab
      cranio-nb lab lessons --no-browser --port 9000
    """
    from ..teaching.lab.start import first_shown, lessons_folder, open_lab
    from ..teaching.shipped import EXERCISES_HOME

    home = lessons_folder(folder)
    if first_shown(home).startswith(EXERCISES_HOME):
        click.echo(f"To work in: {home / EXERCISES_HOME}. The same lessons, solved: {home}.")
    if code := open_lab(folder, browser=not no_browser, port=port, allow_root=allow_root):
        raise click.exceptions.Exit(code)
