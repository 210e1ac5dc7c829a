"""What `speed.py` measured -> tables in Markdown, ratios first."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import prod
from statistics import median
from typing import Any

from speed_growth import at_the_end, exponent
from speed_process import column, ratios, spread

# what is compared, with what, by which figure, and the most it is meant to be
RATIOS = (
    ("`design`, slicewise, all files", "design slicewise", "SimpleITK", 3.0),
    ("`design`, thin-plate, all files", "design thin-plate", "SimpleITK", 3.5),
    ("files to a checked STL, slicewise", "checked STL slicewise", "SimpleITK", 1.5),
    ("files to a checked STL, thin-plate", "checked STL thin-plate", "SimpleITK", 1.5),
    ("reader alone", "reader", "SimpleITK reader", 1.0),
    ("reader, one slice with another slope", "reader slope", "reader", 1.3),
    ("`design`, one slice with another slope", "design slope", "design slicewise", 1.3),
)
SECONDS = (
    ("SkullFix case, thin-plate", "skull thin-plate", 4.0),
    ("SkullFix case, slicewise", "skull slicewise", 3.0),
    ("`cranio-nb --help`", "help", 0.25),
    ("`import cranio_nb`", "import", 0.15),
)
_UNITS = {"slices": "slices", "in-plane": "px in plane", "width": "mm of gap", "snaxels": "snaxels"}


def lines(found: Mapping[str, Any]) -> Iterator[str]:
    """All tables; what was not measured is left out."""
    rows = found["rows"]
    yield from _ratio_table(rows)
    yield from _process_table(rows)
    yield from _memory_line(rows, found["series"]["shape"])
    yield from _stage_table(rows)
    yield from _inside_tables(rows)
    if "growth_date" in found:
        yield f"The growth curves are of {found['growth_date']}, an earlier run; their seconds are not those above."
        yield ""
    yield from _growth_table(found.get("growth", ()))


def table(head: Sequence[str], body: Sequence[Sequence[str]]) -> list[str]:
    """A table in Markdown, figures to the right; nothing where there are no rows.

    >>> table(("row", "s"), [("a", "1.0")])
    ['| row | s |', '|---|--:|', '| a | 1.0 |', '']
    """
    if not body:
        return []
    rule = "|---|" + "--:|" * (len(head) - 1)
    return [f"| {' | '.join(head)} |", rule, *(f"| {' | '.join(row)} |" for row in body), ""]


def _ratio_table(rows: Mapping[str, Any]) -> list[str]:
    """How many times as long as something else, round by round."""
    body = []
    for name, this, that, most in RATIOS:
        if this in rows and that in rows:
            middle, low, high = ratios(column(rows[this], "wall_s"), column(rows[that], "wall_s"))
            body.append((f"{name} / {that}", f"{middle:.2f}", f"{low:.2f} to {high:.2f}", f"{most:g}"))
    if "balloons" in rows:
        slow, fast = (column(rows["balloons"], f"inside.{name}") for name in ("active_contour", "ours"))
        middle, low, high = ratios(slow, fast)
        body.append(("`active_contour` / our balloons", f"{middle:.0f}", f"{low:.0f} to {high:.0f}", "at least 20"))
    return table(("ratio", "median", "range", "wanted"), body)


def _process_table(rows: Mapping[str, Any]) -> list[str]:
    """Wall time, processor time and peak memory of each whole process."""
    wanted = {row: f"{most:g}" for _, row, most in SECONDS}
    body = []
    for name, runs in rows.items():
        middle, low, high = spread(column(runs, "wall_s"))
        cpu_s, peak_mb = median(column(runs, "cpu_s")), median(column(runs, "peak_mb"))
        spent = (f"{middle:.2f}", f"{low:.2f} to {high:.2f}", f"{cpu_s:.2f}", f"{peak_mb:.0f}")
        body.append((name, *spent, wanted.get(name, "")))
    return table(("whole process", "s", "range", "processor s", "peak MB", "s wanted"), body)


def _memory_line(rows: Mapping[str, Any], shape: Sequence[int]) -> list[str]:
    """What the design may take: three times the int16 volume and 250 MB."""
    volume_mb = 2 * prod(shape) / 1e6
    grid = " x ".join(map(str, shape[::-1]))
    return [f"The volume has {grid} voxels, {volume_mb:.0f} MB; wanted is a peak of {3 * volume_mb + 250:.0f} MB.", ""]


def _stage_table(rows: Mapping[str, Any]) -> list[str]:
    """Seconds of each stage, both methods side by side."""
    found = {name.removeprefix("stages "): runs for name, runs in rows.items() if name.startswith("stages ")}
    if not found:
        return []
    steps = list(next(iter(found.values()))[0]["inside"])
    body = [(step, *(f"{median(column(runs, f'inside.{step}')):.2f}" for runs in found.values())) for step in steps]
    return table(("stage, seconds", *found), body)


def _inside_tables(rows: Mapping[str, Any]) -> Iterator[str]:
    """What a task measured inside its process, in ms."""
    for name, head in (("balloons", "46 balloons of 200 steps"), ("surfaces", "surface"), ("raw", "the files' bytes")):
        if name in rows:
            keys = [key for key in rows[name][0]["inside"] if not key.endswith("_px")]
            yield from table((f"{head}, ms", "median", "range"), [_in_ms(rows[name], key) for key in keys])
    if "balloons" in rows:
        apart = max(column(rows["balloons"], "inside.from_dense_px"))
        yield from (f"The balloons lie within {apart:.1g} px of the same scheme solved with full matrices.", "")


def _in_ms(runs: Sequence[Mapping[str, Any]], key: str) -> tuple[str, str, str]:
    middle, low, high = (1000 * value for value in spread(column(runs, f"inside.{key}")))
    return key, f"{middle:.1f}", f"{low:.1f} to {high:.1f}"


def curves(growth: Sequence[Mapping[str, Any]]) -> dict[tuple[str, str], list[tuple[float, float, float]]]:
    """(what, method) -> (n, median seconds, median peak MB), n rising."""
    out: dict[tuple[str, str], list[tuple[float, float, float]]] = {}
    for point in growth:
        values = (point["n"], median(point["wall_s"]), median(point["peak_mb"]))
        out.setdefault((point["what"], point["method"]), []).append(values)
    return {name: sorted(values) for name, values in out.items()}


def _growth_table(growth: Sequence[Mapping[str, Any]]) -> list[str]:
    """Seconds and memory at both ends of each curve, and the powers they grow with."""
    body = []
    for (what, method), values in curves(growth).items():
        n, t, mb = zip(*values, strict=True)
        powers = (f"{exponent(n, t):.2f}", f"{at_the_end(n, t):.2f}", f"{exponent(n, mb):.2f}")
        ends = (f"{n[0]:g} to {n[-1]:g} {_UNITS[what]}", f"{t[0]:.1f} to {t[-1]:.1f}", f"{mb[0]:.0f} to {mb[-1]:.0f}")
        body.append((f"{method}, {ends[0]}", *ends[1:], *powers))
    head = ("`design`", "s", "peak MB", "power of time", "between the last two", "power of memory")
    return table(head, body)
