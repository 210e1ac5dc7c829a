"""The command `cranio-nb doctor`: what this machine lacks."""

from __future__ import annotations

import click

from .options import debug


@click.command()
@debug
def doctor() -> None:
    """Check this machine: versions, packages, memory, drawing.

    One line for each, with its remedy. The exit code is 1 if something needed is missing.

    \b
    Example:
      cranio-nb doctor
    """
    from .examination import examine

    bad = False
    for check in examine():
        bad = bad or check.state == "missing"
        line = f"{check.state:8} {check.name}: {check.found}"
        click.echo(f"{line}. {check.remedy}" if check.remedy else line)
    if bad:
        raise click.exceptions.Exit(1)
