"""The command `cranio-nb compare`: several methods on one case."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import InputRefused, NoOpening
from ..methods.catalogue import METHODS
from .options import PATH, check_reads, check_writes, debug, opening, opening_checked, reading, truth

if TYPE_CHECKING:
    from ..pipeline.compare import Comparison, Measure
    from ..pipeline.trial import Contender


@click.command()
@click.argument("scan", type=PATH, metavar="INPUT")
@truth
@click.option("--out", type=PATH, help="Folder for comparison.html, .csv and .json; made if missing.")
@click.option(
    "--method",
    "methods",
    multiple=True,
    metavar="NAME",
    help=f"One of {', '.join(METHODS)}, also NAME:paper; may be repeated; see `cranio-nb methods`.  [default: all]",
)
@opening
@reading
@debug
def compare(
    scan: Path,
    truth: Path | None,
    out: Path | None,
    methods: tuple[str, ...],
    opening: tuple[int, ...],
    **how_read: Any,
) -> None:
    """Let several methods close the same hole, and set them side by side.

    The scan is read and segmented once; each method runs in a process of its own. A method that refuses is a row with
    its reason; where none makes anything the exit code is 4. Without --out the table is printed and nothing is written.

    \b
    Examples:
      cranio-nb compare case1/ct --truth case1/truth.nii.gz --out compared
      cranio-nb compare skull.nii.gz --mask --method slicewise --method slicewise:paper
    """
    from ..output.comparison_folder import FILES, write_comparison
    from ..output.staging import staged
    from ..pipeline.compare import compare as run_all
    from ..pipeline.preparation import prepare
    from .console import progress_bar

    asked = _asked(methods)
    check_reads(scan=scan, truth=truth)
    if out is not None:
        check_writes(out, FILES, {"scan": scan, "truth": truth})
    with progress_bar() as progress, opening_checked():
        case = prepare(scan, opening=opening, truth=truth, progress=progress, **how_read)
        found = run_all(case, asked, progress=lambda name, done: progress(name, 0.4 + 0.5 * done))
        if out is not None:
            progress("report", 0.92)
            with staged(out, FILES) as part:
                write_comparison(found, part)
    _print(found, out)
    if not found.made:
        raise click.exceptions.Exit(NoOpening.exit_code)


def _asked(methods: tuple[str, ...]) -> tuple[Contender, ...]:
    """The methods by name, or a sentence about the option that names them."""
    from ..pipeline.trial import contenders

    try:
        return contenders(methods)
    except InputRefused as error:
        raise click.BadParameter(str(error), param_hint="--method") from None


def _print(found: Comparison, out: Path | None) -> None:
    """Print the tables, the sentences of those that refused, and where the page is."""
    from ..output.comparison_tables import tables
    from ..pipeline.compare import MEASURES
    from .console import print_findings, print_table

    for part in tables(found):
        columns = {key: MEASURES[key] for key in part["keys"]}
        rows = [
            [trial.contender.name, *(_cell(row[key], what.digits) for key, what in columns.items())]
            for trial, row in zip(found.trials, found.rows, strict=True)
        ]
        print_table(part["title"], ("", *(what.short for what in columns.values())), rows)
        click.echo(click.wrap_text("; ".join(filter(None, map(_meaning, columns.values()))), 78, "  ", "  ") + "\n")
    print_findings(found.case.remarks)
    for trial in found.trials:
        if trial.status != "done":
            click.echo(f"{trial.contender.name}: {trial.status}: {trial.message}")
    if out is not None:
        click.echo(f"page: {out / 'comparison.html'}")


def _cell(value: float, digits: int) -> str:
    """A number of the table; a dash for none (NaN)."""
    return "-" if value != value else f"{value:.{digits}f}"


def _meaning(what: Measure) -> str:
    """What a short head stands for; empty where it says all."""
    unit = f" ({what.unit})" if what.unit else ""
    if what.short == what.label:
        return what.short + unit if unit else ""
    return f"{what.short}: {what.label}{unit}"
