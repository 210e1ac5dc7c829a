"""The command `cranio-nb study`: many cases, methods and parameters, on this machine or a cluster."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import CranioError, InputRefused
from ..options import Option
from .method_name import MethodName
from .options import PATH, check_writes, debug, number

if TYPE_CHECKING:
    from ..study.plan import Plan
    from ..study.run import Tally

WORKERS = Option("Workers on this machine, each with one thread.", 1, 1024, whole=True)
MEMORY_GB = Option("What a worker of this machine may hold before it is started anew.", 0.2, 4096, "GB")


@click.group()
def study() -> None:
    """Cases x methods x parameters: run what is missing, and sum it up.

    \b
    Examples:
      cranio-nb study new plan.json --method slicewise
      cranio-nb study run plan.json --out mystudy
      cranio-nb study run plan.json --out mystudy --scheduler tcp://127.0.0.1:8786
      cranio-nb study report mystudy
    """


@study.command()
@click.argument("plan", type=PATH)
@click.option("--method", "methods", type=MethodName(), multiple=True, default=("slicewise",), show_default=True)
@debug
def new(plan: Path, methods: tuple[str, ...]) -> None:
    """Write a plan to begin with: a few phantoms, and every number of the methods over the part worth a look.

    \b
    Examples:
      cranio-nb study new plan.json --method slicewise --method thin-plate
    """
    from ..output.files import write_json

    with _extra():
        from ..study.plan_file import example
    if plan.exists():
        raise click.BadParameter(f"{plan.name} is there already; name another file.", param_hint="PLAN")
    write_json(plan, example(methods))
    click.echo(f"{plan}")


@study.command()
@click.argument("plan", type=PATH)
@click.option("--out", type=PATH, required=True, help="Folder of the study; made if missing, gone on with if not.")
@click.option("--scheduler", metavar="ADDRESS", help="Of a Dask cluster that is there, e.g. tcp://127.0.0.1:8786.")
@number("--workers", WORKERS, "one for each processor")
@number("--memory-gb", MEMORY_GB, "its share of all memory")
@click.option("--part", metavar="I/N", help="Do share I of N of the cases only; shares may run side by side.")
@debug
def run(
    plan: Path, out: Path, scheduler: str | None, workers: int | None, memory_gb: float | None, part: str | None
) -> None:
    """Do what a study lacks. The same command, given again, goes on where it was stopped or killed.

    PLAN is a JSON file, see `cranio-nb study new`. Rows are written to OUT/rows as they finish. A case or a method that
    fails is a row with its reason.

    \b
    Examples:
      cranio-nb study run plan.json --out mystudy --workers 4
      cranio-nb study run plan.json --out mystudy --scheduler tcp://127.0.0.1:8786
    """
    if scheduler is not None and (workers or memory_gb):
        raise click.UsageError("--workers and --memory-gb are for workers of this machine, not for --scheduler.")
    share = _share(part)
    with _extra():
        from ..study.cluster import dask_workers
        from ..study.run import run_study
        from ..study.store import PLAN, ROWS, Store, is_study
    asked, words = _read(plan)
    check_writes(out, (PLAN, ROWS), {"plan": plan}, own=is_study)
    _check_beside(out, asked)
    Store(out).keep_plan(words)
    with dask_workers(scheduler, n_workers=workers, memory_gb=memory_gb) as there, _progress() as progress:
        click.echo(f"dashboard: {there.dashboard}", err=True)
        tally = run_study(asked, out, there.executor, part=share, progress=progress)
    click.echo(
        f"{tally.before + tally.done} of {tally.total} runs done, {tally.done} of them now, {tally.failed} failed"
    )
    click.echo(f"rows: {out / 'rows'}")


@study.command()
@click.argument("folder", type=PATH, metavar="OUT")
@debug
def report(folder: Path) -> None:
    """Sum up a study: OUT/report/study.html, the rows as CSV, and the best options of each method for `design`.

    \b
    Examples:
      cranio-nb study report mystudy
      cranio-nb design scans/head_ct --params mystudy/report/best-slicewise.json --out out
    """
    from ..output.staging import staged

    with _extra():
        from ..study.report import files_of, read_study, write_report
    found = read_study(folder)
    goal = folder / "report"
    check_writes(goal, files_of(found), {})
    with staged(goal, files_of(found)) as part:
        write_report(found, part)
    for name in files_of(found):
        click.echo(f"{goal / name}")


def _read(path: Path) -> tuple[Plan, dict[str, Any]]:
    """The plan, or a sentence about the argument that names it."""
    from ..study.plan_file import read_plan

    try:
        return read_plan(path)
    except InputRefused as error:
        raise click.BadParameter(str(error), param_hint="PLAN") from None


def _check_beside(out: Path, plan: Plan) -> None:
    """Refuse a study that would lie in one of its own scans."""
    home = Path(os.path.realpath(out))
    for case in plan.cases:
        if "path" in case.source and home.is_relative_to(os.path.realpath(Path(case.folder) / case.source["path"])):
            message = f"it is, or lies in, the scan {case.name}; name another folder."
            raise click.BadParameter(message, param_hint="--out")


def _share(text: str | None) -> tuple[int, int]:
    """The numbers of ``I/N``."""
    try:
        share, of = (int(part) for part in (text or "1/1").split("/"))
    except ValueError:
        share = of = 0
    if not 1 <= share <= of <= 1_000_000:
        raise click.BadParameter("two whole numbers I/N are wanted, I from 1 to N.", param_hint="--part")
    return share, of


@contextmanager
def _extra() -> Iterator[None]:
    """Say what to install where the extra for studies is not there."""
    try:
        yield
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0] not in ("distributed", "pyarrow"):
            raise
        from ..teaching.shipped import install_command

        message = "Studies need packages that are not installed here."
        raise CranioError("NoExtra", message, f"Install them: {install_command('study')}") from None


@contextmanager
def _progress() -> Iterator[Callable[[Tally], None]]:
    """The bar of all commands on a terminal; elsewhere a line on stderr for each tenth that is done."""
    from .console import progress_bar

    tenth = -1
    with progress_bar() as bar:

        def show(tally: Tally) -> None:
            nonlocal tenth
            share = (tally.before + tally.done) / max(tally.total, 1)
            bar(_words(tally), share)
            if not sys.stderr.isatty() and int(10 * share) > tenth:
                tenth = int(10 * share)
                click.echo(_words(tally), err=True)

        yield show


def _words(tally: Tally) -> str:
    """How far a study is, in words."""
    done = f"{tally.before + tally.done} of {tally.total} runs, {tally.failed} failed"
    left = tally.seconds_left
    return f"{done}, {_duration(left)} left" if left == left else done


def _duration(seconds: float) -> str:
    """A time as two whole numbers."""
    minutes, hours = int(seconds // 60), int(seconds // 3600)
    if hours >= 48:
        return f"{hours // 24} d {hours % 24} h"
    return f"{hours} h {minutes % 60} min" if hours else f"{minutes} min {int(seconds % 60)} s"
