"""What the benchmarks on many skulls share: a study with what they ask on the command line, and its tables in print.

A second run does what is missing (`cranio_nb.study`): a row is done if its case, contender, options and version are
those asked for. Each design runs in a process of its own, so that its peak memory is known.
"""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

from cranio_nb.methods.catalogue import check_options, default_options
from cranio_nb.pipeline.compare import MEASURES
from cranio_nb.pipeline.trial import Contender, attempt_apart, contenders
from cranio_nb.study.cases import Case
from cranio_nb.study.plan import Plan, Setting
from cranio_nb.study.run import Tally, rows_of, run_study
from cranio_nb.study.store import Columns
from cranio_nb.study.summaries import counts, summary, where


def run(cases: Sequence[Case], asked: argparse.Namespace) -> Columns:
    """Design what is not there yet, and return all rows asked for, in the order of the cases."""
    plan = Plan(tuple(cases), tuple(Setting(one) for one in contenders_of(asked)))
    with ProcessPoolExecutor(asked.processes, get_context("spawn")) as pool:
        run_study(plan, asked.out, pool, attempt=attempt_apart, progress=_print_tally)
    return rows_of(plan, asked.out)


def _print_tally(tally: Tally) -> None:
    left = f", {tally.seconds_left / 60:.0f} min left" if tally.done else ""
    print(f"   {tally.before + tally.done} of {tally.total} runs, {tally.failed} failed{left}", flush=True)


def names(columns: Columns) -> list[str]:
    """The contenders, in the order asked for."""
    return list(dict.fromkeys(columns["contender"]))


def print_summary(columns: Columns, keys: Sequence[str] = tuple(MEASURES)) -> None:
    """Mean, sd and worst of each contender, then the sentences of what went wrong."""
    for name in names(columns):
        own = where(columns, columns["contender"] == name)
        print(f"\n-- {name}: {counts(own)}\n   {'measure':22s} {'mean':>9s} {'sd':>9s} {'worst':>9s}  unit")
        for key, found in summary(own).items():
            if key in keys:
                numbers = " ".join(f"{v:9.{MEASURES[key].digits}f}" for v in found)
                print(f"   {MEASURES[key].label:22s} {numbers}  {MEASURES[key].unit}")
    print_faults(columns)


def print_faults(columns: Columns) -> None:
    """A line for each design that was refused or failed."""
    said = (columns[name] for name in ("case", "contender", "status", "code", "message"))
    for case, contender, status, code, message in zip(*said, strict=True):
        if status != "done":
            print(f"   {case}, {contender}: {status} ({code}): {message}")


def add_arguments(parser: argparse.ArgumentParser, out: str) -> None:
    """What the benchmarks ask alike."""
    parser.add_argument("folder", type=Path, nargs="?", help="default: its place in the folder of CRANIO_NB_DATA")
    parser.add_argument("--methods", nargs="+", metavar="NAME", default=[], help="e.g. slicewise slicewise:paper")
    parser.add_argument("--options", type=json.loads, default={}, metavar="JSON", help="{name: value} for all of them")
    parser.add_argument("--prior", metavar="FILE", help="for the methods that have an option of this name")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--out", type=Path, default=Path(out), help=f"folder of the study (default: {out})")


def contenders_of(asked: argparse.Namespace) -> list[Contender]:
    """The contenders asked for; each gets those of the options that it has, and one that nobody has is refused."""
    rivals = contenders(asked.methods)
    known = {one.method: default_options(one.method) for one in rivals}
    strangers = set(asked.options) - {option for options in known.values() for option in options}
    if strangers:
        raise SystemExit(f"None of these methods has an option {', '.join(sorted(strangers))}.")
    found = []
    for one in rivals:
        options = {k: v for k, v in asked.options.items() if k in known[one.method]}
        check_options(one.method, options)
        if asked.prior and "prior" in known[one.method]:
            options["prior"] = asked.prior
        found.append(replace(one, options=options))
    return found


def folder_of(asked: argparse.Namespace, inside: str) -> Path:
    """The folder named, or its usual place."""
    home = os.environ.get("CRANIO_NB_DATA")
    if asked.folder is None and not home:
        raise SystemExit("Name the folder, or set CRANIO_NB_DATA to the folder of real scans.")
    return asked.folder or Path(home or "") / inside
