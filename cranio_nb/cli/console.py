"""Results -> the terminal: tables and JSON on stdout, progress on stderr."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from ..output.files import json_text
from ..readers import Finding, LoadReport, warnings_of

if TYPE_CHECKING:
    from ..pipeline.run import RunResult
    from ..vault.opening_choice import JudgedOpening

_PIPED_WIDTH = 110  # columns of a table that no terminal shows


@contextmanager
def progress_bar() -> Iterator[Callable[[str, float], None]]:
    """A bar on stderr, gone when done; nothing where stderr is no terminal.

    Returns
    -------
    context manager of callable
        ``progress(step, fraction)``, with the name of the step and the done fraction of the whole, 0 to 1.

    Examples
    --------
    >>> with progress_bar() as progress:
    ...     progress("reading", 0.5)
    """
    console = Console(stderr=True)
    columns = (TextColumn("{task.description:14}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("starting", total=1.0)
        yield lambda step, done: bar.update(task, description=step, completed=done)


def print_json(data: Any) -> None:
    """Print strict JSON on stdout.

    Parameters
    ----------
    data : Any
        As for `output.files.jsonable`.

    Examples
    --------
    >>> print_json({"dice": 0.9})
    {
      "dice": 0.9
    }
    """
    click.echo(json_text(data))


def print_table(title: str, head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table on stdout; plain text, never markup.

    Parameters
    ----------
    title : str
        Empty for none.
    head : sequence of str
        Name of each column; no head where all are empty.
    rows : sequence of sequence of str
    """
    table = Table(title=title or None, title_justify="left", title_style="bold", box=SIMPLE_HEAD, show_header=any(head))
    for name in head:
        table.add_column(name, overflow="fold")
    for row in rows:
        table.add_row(*row)
    console = Console(markup=False, highlight=False)
    if not console.is_terminal:
        console.width = _PIPED_WIDTH
    console.print(table)


def print_load(load: LoadReport) -> None:
    """Print a load report as tables.

    Parameters
    ----------
    load : LoadReport
    """
    rows = [
        ("Input", f"{load.source}, {'CT in HU' if load.kind == 'ct' else 'bone mask'}"),
        ("Planes x rows x columns", " x ".join(map(str, load.shape))),
        ("Spacing", " x ".join(f"{s:.3f}" for s in load.spacing) + " mm"),
        ("Corner error", f"{load.corner_error:.3f} mm"),
    ]
    print_table("What was read", ("", ""), rows)
    if load.findings:
        found = [(f.severity, f.code, f.message) for f in load.findings]
        print_table("Chosen, skipped and corrected", ("Kind", "Name", "What was seen"), found)


def print_openings(openings: Sequence[JudgedOpening]) -> None:
    """Print openings as a table; nothing where there are none.

    Parameters
    ----------
    openings : sequence of JudgedOpening
    """
    rows = [
        (
            str(one.number),
            f"{one.verdict.kind} ({one.verdict.confidence:.2f})",
            f"{one.size.planes[0]}:{one.size.planes[1]}",
            f"{one.size.length:.0f} x {one.size.width:.0f}",
            one.size.place,
            ", ".join(f"{c:.1f}" for c in one.size.centre),
            f"{one.verdict.reason} {one.edge}".rstrip(),
        )
        for one in openings
    ]
    if rows:
        head = ("", "Verdict", "Planes", "Size (mm)", "Place", "Centre, LPS (mm)", "Reason")
        print_table("Openings of the skull, and the confidence in each verdict", head, rows)


def print_findings(findings: Sequence[Finding], *, err: bool = False) -> None:
    """Print findings, a line each.

    Parameters
    ----------
    findings : sequence of Finding
    err : bool
        Whether to print them beside the results, on the error stream, so that these can be read by a program.
    """
    for finding in findings:
        click.echo(f"{finding.severity}: {finding.message}", err=err)


def print_result(result: RunResult, out: Path) -> None:
    """Print what a run found, in a few lines, and where its report is.

    Parameters
    ----------
    result : RunResult
    out : Path
        Folder of the report.
    """
    for one in result.case.closed:
        click.echo(f"closed: {one}")
    click.echo(f"volume: {result.mesh.volume / 1000:.2f} cm3")
    if result.truth:
        s = result.truth.score
        click.echo(f"truth: Dice {s.dice:.3f}, border Dice {s.border_dice:.3f}, HD95 {s.hd95:.2f} mm")
    # what the scan itself warns of is said at the door, and not in the report only
    print_findings(warnings_of(result.case.load.findings))
    print_findings(result.findings)
    click.echo(f"report: {out / 'report.html'}")
