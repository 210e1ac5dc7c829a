"""Results -> the terminal: tables and JSON on stdout, progress on stderr."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from ..output.files import jsonable
from ..readers import LoadReport

if TYPE_CHECKING:
    from ..evaluation.opening_size import OpeningSize
    from ..pipeline.run import RunResult

_PIPED_WIDTH = 110  # columns of a table that no terminal shows


@contextmanager
def progress_bar() -> Iterator[Callable[[str, float], None]]:
    """A bar on stderr, gone when done; yields ``tell(step, fraction)``. Nothing where stderr is no terminal."""
    console = Console(stderr=True)
    columns = (TextColumn("{task.description:14}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("starting", total=1.0)
        yield lambda step, done: bar.update(task, description=step, completed=done)


def print_json(data: Any) -> None:
    """Strict JSON on stdout."""
    click.echo(json.dumps(jsonable(data), indent=2, ensure_ascii=False, allow_nan=False))


def print_table(title: str, head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """A table on stdout; plain text, never markup."""
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
    """A load report as tables."""
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


def print_openings(openings: Sequence[OpeningSize]) -> None:
    """Openings as a table, nothing where there are none."""
    rows = [
        (
            str(i),
            f"{o.planes[0]}:{o.planes[1]}",
            f"{o.length:.0f} x {o.width:.0f}",
            o.place,
            ", ".join(f"{c:.1f}" for c in o.centre),
        )
        for i, o in enumerate(openings, 1)
    ]
    if rows:
        print_table("Openings of the vault", ("", "Planes", "Size (mm)", "Place", "Centre, LPS (mm)"), rows)


def print_result(result: RunResult, out: Path) -> None:
    """What a run found, in a few lines, and where to look."""
    for o in result.sizes:
        click.echo(f"opening: {o.place}, {o.length:.0f} x {o.width:.0f} mm, planes {o.planes[0]}:{o.planes[1]}")
    click.echo(f"volume: {result.mesh.volume / 1000:.2f} cm3")
    if result.truth:
        s = result.truth.score
        click.echo(f"truth: Dice {s.dice:.3f}, border Dice {s.border_dice:.3f}, HD95 {s.hd95:.2f} mm")
    for finding in result.findings:
        click.echo(f"{finding.severity}: {finding.message}")
    click.echo(f"report: {out / 'report.html'}")
