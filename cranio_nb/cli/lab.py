"""The command `cranio-nb lab`: for students."""

from __future__ import annotations

from pathlib import Path

import click

from .options import PATH, debug


@click.command()
@click.argument("folder", required=False, type=PATH)
@click.option("--no-browser", is_flag=True, help="Print the address instead of opening a browser.")
@click.option("--port", type=int, help="Port to listen on.  [default: 8888, or the next free one]")
@debug
def lab(folder: Path | None, no_browser: bool, port: int | None) -> None:
    """Open the lessons in JupyterLab, at the tour.

    FOLDER holds the lessons; by default ./notebooks. Nothing but JupyterLab is started; Ctrl+C ends it.

    \b
    Examples:
      cranio-nb lab
      cranio-nb lab notebooks --no-browser --port 9000
    """
    from ..teaching.lab.start import open_lab

    if code := open_lab(folder, browser=not no_browser, port=port):
        raise click.exceptions.Exit(code)
