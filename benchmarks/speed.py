"""How long a prosthesis takes beside what others need to read the scan: whole processes in turn, ratios first.

    python benchmarks/speed.py [--rounds 7] [--growth] [--only NAME ...] [--store docs/performance.json]

Each round runs every row once, after one round that is not counted: `cranio-nb design` with all it writes, the same
stage by stage, files to a checked STL, and the reader; beside them SimpleITK (threshold, largest component, fill, and
its reader alone), `active_contour`, surfaces of skimage and VTK, and the bare reading of the files. A ratio is taken
round by round. The series is a real one with a hole cut into it where CRANIO_NB_DATA names the folder of real scans,
else a phantom. --growth adds how time and memory grow, in three rounds. What was measured is stored as JSON;
`python docs/make_performance.py` makes the page docs/performance.md of it.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from speed_cases import patch_mask, series, skull, slope_case
from speed_growth import METHODS, points, record
from speed_machine import machine, two_cores
from speed_process import Spent, run_whole
from speed_table import lines

TASKS = Path(__file__).with_name("speed_tasks.py")
STORE = Path(__file__).parents[1] / "docs" / "performance.json"
_GROWTH_ROUNDS = 3
_ROUNDS = 7

Rows = dict[str, list[str]]


def rows_of(ct: Path, slope: Path, patch: Path, mask: Path | None, out: Path) -> Rows:
    """The command of each row, by its name."""
    rows: Rows = {}
    for method in METHODS:
        rows[f"design {method}"] = design([str(ct), "--method", method], out)
        rows[f"stages {method}"] = task("stages", ct, method, out)
        rows[f"checked STL {method}"] = task("checked_stl", ct, method, out)
    rows |= {
        "reader": task("read_ours", ct),
        "reader slope": task("read_ours", slope),
        "design slope": design([str(slope), "--method", "slicewise"], out),
        "raw": task("read_raw", ct),
        "balloons": task("balloons"),
        "surfaces": task("surfaces", patch),
        "help": [sys.executable, "-m", "cranio_nb", "--help"],
        "import": [sys.executable, "-c", "import cranio_nb"],
        "python": [sys.executable, "-c", "pass"],
    }
    if find_spec("SimpleITK"):
        rows |= {"SimpleITK": task("segment_sitk", ct), "SimpleITK reader": task("read_sitk", ct)}
    if mask is not None:
        rows |= {f"skull {method}": design([str(mask), "--mask", "--method", method], out) for method in METHODS}
    return rows


def design(arguments: Sequence[str], out: Path) -> list[str]:
    """`cranio-nb design` as a process of its own."""
    return [sys.executable, "-m", "cranio_nb", "design", *arguments, "--out", str(out / "design")]


def task(name: str, *arguments: object) -> list[str]:
    """A task of speed_tasks.py as a process of its own."""
    return [sys.executable, str(TASKS), name, *map(str, arguments)]


def in_turn(rows: Mapping[str, list[str]], n_rounds: int) -> dict[str, list[dict[str, Any]]]:
    """Every row once in each round, each round begun by another row; one more round before is not counted."""
    names = list(rows)
    found: dict[str, list[dict[str, Any]]] = {name: [] for name in names}
    for number in range(n_rounds + 1):
        first = number * len(names) // (n_rounds + 1)
        for name in names[first:] + names[:first]:
            spent = run_whole(rows[name])
            if number:
                found[name].append(entry(spent))
        print(f"round {number} of {n_rounds}", file=sys.stderr, flush=True)
    return found


def entry(spent: Spent) -> dict[str, Any]:
    """A run as it is stored; a task's own figures stand under "inside"."""
    inside = json.loads(spent.said) if spent.said.startswith("{") else {}
    return {"wall_s": spent.wall_s, "cpu_s": spent.cpu_s, "peak_mb": spent.peak_mb, "inside": inside}


def growth(folder: Path, out: Path) -> list[dict[str, object]]:
    """Every point of the growth curves, three times; what no design comes out of is said and left out."""
    found = []
    for point in points(folder):
        try:
            runs = [run_whole(design(point.arguments(folder), out)) for _ in range(_GROWTH_ROUNDS)]
        except SystemExit as refusal:
            print(f"{point.what} {point.n:g} {point.method} left out: {refusal}", file=sys.stderr, flush=True)
            continue
        found.append(record(point, [run.wall_s for run in runs], [run.peak_mb for run in runs]))
        print(f"{point.what} {point.n:g} {point.method}", file=sys.stderr, flush=True)
    return found


def measure(asked: argparse.Namespace, folder: Path) -> dict[str, Any]:
    """All that was asked for, as it is stored."""
    ct, name, shape = series(folder)
    rows = rows_of(ct, slope_case(folder, ct), patch_mask(folder), skull(), folder)
    if asked.only:
        rows = {row: command for row, command in rows.items() if any(word in row for word in asked.only)}
    found: dict[str, Any] = {"machine": machine(), "series": {"name": name, "shape": shape}}
    found |= {"rounds": asked.rounds, "rows": in_turn(rows, asked.rounds)}
    if asked.growth:
        found["growth"] = growth(folder, folder)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=_ROUNDS)
    parser.add_argument("--growth", action="store_true", help="with the growth curves")
    parser.add_argument("--only", nargs="+", metavar="NAME", default=[], help="rows whose name holds one of these")
    parser.add_argument("--store", type=Path, metavar="JSON", help=f"where to keep the figures, e.g. {STORE.name}")
    asked = parser.parse_args()
    two_cores()
    with tempfile.TemporaryDirectory() as folder:
        found = measure(asked, Path(folder))
    if asked.store:
        # growth curves of an earlier run stay beside new rows, with their own date
        before = json.loads(asked.store.read_text()) if asked.store.exists() else {}
        if "growth" in before and "growth" not in found:
            date = before.get("growth_date", before["machine"]["date"])
            found |= {"growth": before["growth"], "growth_date": date}
        asked.store.write_text(json.dumps(found, indent=1) + "\n")
    print("\n".join(lines(found)))


if __name__ == "__main__":
    main()
