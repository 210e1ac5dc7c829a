"""Writes docs/performance.md and its picture from what `benchmarks/speed.py --store` kept in docs/performance.json.

python docs/make_performance.py
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from textwrap import fill
from typing import Any

from matplotlib.figure import Figure

DOCS = Path(__file__).parent
sys.path.append(str(DOCS.parent / "benchmarks"))

from speed_process import column, ratios  # noqa: E402
from speed_table import RATIOS, curves, lines  # noqa: E402

STORE, PAGE, PICTURE = DOCS / "performance.json", DOCS / "performance.md", DOCS / "img" / "performance.png"
_COLOURS = {"slicewise": "#0072B2", "thin-plate": "#D55E00"}
_AXES = {"slices": "slices", "in-plane": "rows and columns", "width": "gap, mm", "snaxels": "snaxels"}
_TICKS = (1, 2, 5, 10, 20, 50)
_TOP = """# How long it takes

How long `cranio-nb design` takes beside the time in which SimpleITK reads the same series, takes a threshold, keeps the
largest component and fills its holes. Everything is a whole process, started anew each time; the rows ran in turn, so
that what slows the machine for a while slows all of them, and ratios are taken round by round. Medians and ranges of
{rounds} rounds; the load of the machine stands below. Peak memory is that of the largest process.

`python benchmarks/speed.py --rounds 7 --growth --store docs/performance.json` measures, on your own machine too;
`python docs/make_performance.py` makes this page of it.

{marked}

![{seen}](img/performance.png)

"""
_RATIOS_SEEN = "How many times as long as SimpleITK each process takes, and how many times are wanted at most."
_GROWTH_SEEN = " Below: how time and memory grow with slices, pixels, width of the gap and snaxels."


def page(found: Mapping[str, Any]) -> str:
    """The page as text."""
    seen = _RATIOS_SEEN + (_GROWTH_SEEN if found.get("growth") else "")
    top = _TOP.format(rounds=found["rounds"], marked=fill(_marked(found), 120), seen=seen)
    return top + "\n".join(lines(found)).rstrip() + "\n"


def _marked(found: Mapping[str, Any]) -> str:
    """What was measured, on what machine, when, with which versions."""
    machine = found["machine"]
    versions = ", ".join(f"{name} {number}" for name, number in machine["versions"].items())
    place = "Machine: {processor}, {cores} cores, {memory_gb} GB, {system}; load before the first round {load}."
    return (
        f"Series: {found['series']['name']}. {place.format(**machine)} Date: {machine['date']}. Versions: {versions}."
    )


def picture(found: Mapping[str, Any]) -> Figure:
    """Ratios as bars with their ranges, and a pair of axes for each thing that grows."""
    grown = curves(found.get("growth", ()))
    kinds = list(dict.fromkeys(what for what, _ in grown))
    figure = Figure(figsize=(11, 3.2 + 2.6 * bool(kinds)), layout="constrained")
    upper, *lower = figure.subfigures(1 + bool(kinds), 1, squeeze=False)[:, 0]
    _draw_ratios(upper.subplots(), found["rows"])
    if kinds:
        axes = lower[0].subplots(1, len(kinds), squeeze=False, sharey=True)[0]
        for ax, what in zip(axes, kinds, strict=True):
            _draw_growth(ax, what, {method: values for (kind, method), values in grown.items() if kind == what})
        axes[0].set_ylabel("seconds (dashed: 100 MB)")
    return figure


def _draw_ratios(ax: Any, rows: Mapping[str, Any]) -> None:
    """A bar for each ratio, a tick where it is wanted."""
    shown = [row for row in RATIOS if row[1] in rows and row[2] in rows]
    for y, (_, this, that, most) in enumerate(reversed(shown)):
        middle, low, high = ratios(column(rows[this], "wall_s"), column(rows[that], "wall_s"))
        ax.barh(y, middle, color="#56B4E9", xerr=[[middle - low], [high - middle]], ecolor="#333333")
        ax.plot([most, most], [y - 0.4, y + 0.4], color="#D55E00", linewidth=2)
    names = [f"{name} / {that}".replace("`", "") for name, _, that, _ in reversed(shown)]
    ax.set_yticks(range(len(shown)), names)
    ax.set_xlabel("times as long (orange: wanted at most)")


def _draw_growth(ax: Any, what: str, by_method: Mapping[str, list[tuple[float, float, float]]]) -> None:
    """Seconds and memory over what grows, both axes logarithmic."""
    for method, values in by_method.items():
        n, t, mb = zip(*values, strict=True)
        ax.loglog(n, t, "o-", color=_COLOURS[method], label=method, markersize=4)
        ax.loglog(n, [one / 100 for one in mb], "--", color=_COLOURS[method], linewidth=1)
    ax.set_xticks(n, [f"{one:g}" for one in n])
    ax.set_yticks(_TICKS, [f"{one:g}" for one in _TICKS])
    ax.minorticks_off()
    ax.set_xlabel(_AXES[what])
    ax.legend(fontsize=7)


def main() -> None:
    """Write page and picture."""
    found = json.loads(STORE.read_text())
    PAGE.write_text(page(found), encoding="utf-8")
    picture(found).savefig(PICTURE, dpi=100, metadata={"Software": None})


if __name__ == "__main__":
    main()
