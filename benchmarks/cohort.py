"""Many skulls, several methods -> one CSV row for each finished design; a run that was stopped goes on where it was.

Shared by the benchmarks. A row is taken as done if its case, contender, options and version are those asked for; the
version names the package's release and a digest of the source that the method and the measures load.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import inspect
import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from cranio_nb import __version__
from cranio_nb.errors import CranioError
from cranio_nb.methods.catalogue import check_options, default_options, find_method
from cranio_nb.methods.transfer import pack_methods, unpack_methods
from cranio_nb.pipeline.compare import MEASURES, Reference, measure
from cranio_nb.pipeline.trial import Attempt, Contender, attempt_apart, contenders
from cranio_nb.stages.segmentation import segment
from cranio_nb.vault.opening_search import find_openings
from cranio_nb.volume import Volume

KEY = ("case", "contender", "options", "version")
"""Columns that say what a row is of."""
FAILED = ("no patch", "broken")
"""Ends of a trial that count as failures; "refused" is a method that does not serve such a case."""
_CODE = """
import importlib, sys
for name in sys.argv[1:]: importlib.import_module(name)
print(*sorted(m.__file__ for n, m in sys.modules.items()
              if n.split(".")[0] in ("cranio_nb", "data_synth") and getattr(m, "__file__", None)), sep="\\n")
"""


@dataclass(frozen=True)
class Case:
    """A skull with a known missing part.

    Parameters
    ----------
    name : str
        Unique in its cohort.
    load : callable
        ``load(*arguments) -> (bone, truth)``, two masks on one grid as `Volume`; a function of a module, so that
        another process can call it. Its ValueError is the case's own fault, and written down for each method.
    arguments : tuple
        Plain values.
    facts : dict
        Further columns, e.g. the place of the hole.
    """

    name: str
    load: Callable[..., tuple[Volume, Volume]]
    arguments: tuple[Any, ...]
    facts: dict[str, Any]


def run_cohort(
    cases: Sequence[Case],
    asked: Sequence[Contender],
    path: Path,
    *,
    processes: int = 1,
    attempt: Attempt = attempt_apart,
) -> list[dict[str, Any]]:
    """Design what is not yet in the file, and return all rows asked for, in the order of the cases.

    Parameters
    ----------
    cases : sequence of Case
    asked : sequence of Contender
    path : Path
        CSV; rows are appended, each as soon as it is finished.
    processes : int
        Cases worked on at the same time.
    attempt : callable
        How a trial is run.
    """
    head = [*KEY, *dict.fromkeys(k for case in cases for k in case.facts), *_OUTCOME]
    _start(path, head)
    done = {key_of(row) for row in read_rows(path)}
    todo = [(case, [c for c in asked if (case.name, *_identity(c)) not in done]) for case in cases]
    todo = [(case, left) for case, left in todo if left]
    # in the order of the cases, so that a run stopped early has covered each place and size
    if processes == 1:
        for case, left in todo:
            _work(case, left, path, head, attempt)
    else:
        with ProcessPoolExecutor(
            processes, get_context("spawn"), initializer=unpack_methods, initargs=(pack_methods(),)
        ) as pool:
            for job in [pool.submit(_work, case, left, path, head, attempt) for case, left in todo]:
                job.result()
    found = {key_of(row): row for row in read_rows(path)}
    return [found[(case.name, *_identity(c))] for case in cases for c in asked]


_OUTCOME = ("status", "code", "message", *MEASURES)


def _work(case: Case, left: Sequence[Contender], path: Path, head: Sequence[str], attempt: Attempt) -> None:
    """Every contender on one case, which is read once."""
    try:
        bone, truth = case.load(*case.arguments)
        bone = segment(bone)
        openings = find_openings(bone)
        reference = Reference.of(truth, bone, openings[0])
    except ValueError as error:
        code = error.code if isinstance(error, CranioError) else "NoCase"
        for contender in left:
            _append(path, head, case, contender, {"status": "no patch", "code": code, "message": str(error)})
        return
    for contender in left:
        trial = attempt(bone, openings, contender)
        outcome = {"status": trial.status, "code": trial.code, "message": trial.message}
        _append(path, head, case, contender, outcome | measure(trial, bone, reference))


def _append(path: Path, head: Sequence[str], case: Case, contender: Contender, outcome: dict[str, Any]) -> None:
    """Add a line in one write, so that the lines of several processes do not mix."""
    row = dict(zip(KEY, (case.name, *_identity(contender)), strict=True)) | case.facts | outcome
    with path.open("a", newline="", encoding="utf-8") as file:
        csv.DictWriter(file, head, restval="").writerow(row)
    values = "  ".join(f"{k} {row[k]:.3g}" for k in ("dice", "assd", "seconds") if k in row)
    print(f"   {case.name:28s} {contender.name:18s} {row['status']:9s} {values} {row['message']}", flush=True)


def _identity(contender: Contender) -> tuple[str, str, str]:
    return contender.name, json.dumps(contender.options, sort_keys=True), version_of(contender.method)


@cache
def version_of(method: str) -> str:
    """The release, and a digest of the source that a method and the measures load."""
    pieces = find_method(method).pieces
    modules = ["cranio_nb.methods.design", "cranio_nb.pipeline.compare", "data_synth"]
    modules += [pieces.__module__] if pieces.__module__.startswith("cranio_nb.") else []
    loaded = subprocess.run([sys.executable, "-c", _CODE, *modules], capture_output=True, text=True, check=True)
    digest = hashlib.sha256(inspect.getsource(pieces).encode())
    for path in loaded.stdout.split("\n"):
        digest.update(Path(path).read_bytes() if path else b"")
    return f"{__version__}+{digest.hexdigest()[:8]}"


def _start(path: Path, head: Sequence[str]) -> None:
    """Write the head of a new file; refuse a file with another one."""
    if path.exists():
        with path.open(newline="", encoding="utf-8") as file:
            if next(csv.reader(file), None) != list(head):
                raise SystemExit(f"{path.name} holds other columns; name another file with --out.")
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("x", newline="", encoding="utf-8") as file:
        csv.writer(file).writerow(head)


def read_rows(path: Path) -> list[dict[str, Any]]:
    """Rows of a file; measures as numbers, nan where there is none."""
    with path.open(newline="", encoding="utf-8") as file:
        return [row | {k: float(row[k] or "nan") for k in MEASURES} for row in csv.DictReader(file)]


def key_of(row: dict[str, Any]) -> tuple[str, ...]:
    """What a row is of."""
    return tuple(row[name] for name in KEY)


def summary(rows: Iterable[dict[str, Any]]) -> dict[str, tuple[float, float, float]]:
    """Mean, standard deviation (of the population) and worst value of each measure; nan where nothing is known.

    A design that failed has a DSC and a border DSC of 0; other measures do not know it. One that was refused is left
    out.
    """
    rows = [row for row in rows if row["status"] != "refused"]
    found = {}
    for key, what in MEASURES.items():
        lost = 0.0 if key in ("dice", "border_dice") else np.nan
        values = np.array([lost if row["status"] in FAILED else row[key] for row in rows], float)
        values = values[np.isfinite(values)]
        if not len(values):
            found[key] = (float("nan"),) * 3
            continue
        off = {"high": -values, "low": values, "": np.abs(values - 1)}[what.best]
        found[key] = float(values.mean()), float(values.std()), float(values[np.argmax(off)])
    return found


def counts(rows: Iterable[dict[str, Any]]) -> str:
    """How many designs there are, and how many failed or were refused."""
    states = [row["status"] for row in rows]
    failed = sum(state in FAILED for state in states)
    return f"{states.count('done')} done, {failed} failed, {states.count('refused')} refused"


def print_summary(rows: Sequence[dict[str, Any]], keys: Sequence[str] = tuple(MEASURES)) -> None:
    """Mean, sd and worst of each contender, then the sentences of what went wrong."""
    for name in dict.fromkeys(row["contender"] for row in rows):
        own = [row for row in rows if row["contender"] == name]
        print(f"\n-- {name}: {counts(own)}\n   {'measure':22s} {'mean':>9s} {'sd':>9s} {'worst':>9s}  unit")
        for key, values in summary(own).items():
            if key in keys:
                numbers = " ".join(f"{v:9.{MEASURES[key].digits}f}" for v in values)
                print(f"   {MEASURES[key].label:22s} {numbers}  {MEASURES[key].unit}")
    print_faults(rows)


def print_faults(rows: Sequence[dict[str, Any]]) -> None:
    """A line for each design that was refused or failed."""
    for row in rows:
        if row["status"] != "done":
            print(f"   {row['case']}, {row['contender']}: {row['status']} ({row['code']}): {row['message']}")


def add_arguments(parser: argparse.ArgumentParser, out: str) -> None:
    """What the benchmarks ask alike."""
    parser.add_argument("folder", type=Path, nargs="?", help="default: its place in the folder of CRANIO_NB_DATA")
    parser.add_argument("--methods", nargs="+", metavar="NAME", default=[], help="e.g. slicewise slicewise:paper")
    parser.add_argument("--options", type=json.loads, default={}, metavar="JSON", help="{name: value} for all of them")
    parser.add_argument("--prior", metavar="FILE", help="for the methods that have an option of this name")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--out", type=Path, default=Path(out), help=f"CSV to append to (default: {out})")


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
