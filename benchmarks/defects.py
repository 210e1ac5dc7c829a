"""Every method on many holes of known truth, cut into complete skulls: accuracy against size and place.

    python benchmarks/defects.py [FOLDER] [--methods slicewise ...] [--processes 2] [--out defects] [--plot PNG]

FOLDER holds complete skulls as masks (`*.nrrd`); by default skullfix/complete in the folder of CRANIO_NB_DATA.
SkullFix (Kodym et al. 2021, doi 10.1016/j.dib.2021.106902) is non-commercial; nothing of it is part of this project.

The cuts follow one rule (`cuts`), whatever the skulls: each of the `PLACES` with each of the `SIZES` in two rounds,
then each of the other `KINDS` in the sizes that are its own, in two rounds. Cut number n is made in skull n (counted
round and round) with seed n, which chooses side, exact place, outline and rim.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cohort
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from cranio_nb.drawing.palette import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION
from cranio_nb.pipeline.compare import MEASURES
from cranio_nb.study.cases import Case, cut_case
from cranio_nb.study.store import Columns
from cranio_nb.study.summaries import counts, summary, values, where

PLACES = ("frontal", "temporal", "parietal", "occipital", "vertex")
SIZES = (20, 40, 60, 80, 100, 120)
"""Mean diameter asked for, mm. A cut that is too wide for its skull is made as wide as fits, in steps of 5 mm."""
KINDS = ("burr_hole", "unilateral", "elliptic", "ragged", "bilateral", "multiple", "near_base", "large")
"""Defects of `data_synth` with sizes of their own; "partial" is no hole and has no place here."""
_ROUNDS = 2
_SHOWN = ("dice", "border_dice", "hd95", "assd", "thickness_rmse", "cpu")
_MARKS = list(zip("os^Dv*X", (BLUE, VERMILLION, GREEN, ORANGE, PURPLE, BLACK, SKY), strict=True))


def cuts(skulls: Sequence[Path]) -> list[Case]:
    """The list of cuts: 5 places x 6 sizes x 2 and 8 kinds x 2, so 76."""
    wanted = [(place, size) for _ in range(_ROUNDS) for size in SIZES for place in PLACES]
    wanted += [(kind, None) for _ in range(_ROUNDS) for kind in KINDS]
    found = []
    for n, (kind, size) in enumerate(wanted):
        skull = skulls[n % len(skulls)]
        found.append(cut_case(skull.name, kind, n, diameter_mm=size, mask=True, folder=skull.parent))
    return found


def table(columns: Columns, by: str, order: Sequence[Any]) -> None:
    """Means of each contender by the value of a column."""
    for name in cohort.names(columns):
        heads = " ".join(f"{MEASURES[key].label:>14s}" for key in _SHOWN)
        print(f"\n-- {name}, mean by {by}\n   {'':12s} {heads}")
        for value in order:
            own = where(columns, (columns["contender"] == name) & (columns[by] == value))
            means = summary(own)
            numbers = " ".join(f"{means[key].mean:14.{MEASURES[key].digits}f}" for key in _SHOWN)
            print(f"   {value!s:12s} {numbers}   {counts(own)}")


def figure(columns: Columns) -> Figure:
    """DSC, ASSD and HD95 against the size asked for (left) and against the place (right), a mark for each contender.

    Small marks are single cuts, lines and large marks are means. On the left only the cuts of a given size are shown;
    a design that failed has a DSC of 0 and no distance.
    """
    names = cohort.names(columns)
    drawing = Figure(figsize=(12.5, 10.5), dpi=110, layout="constrained")
    FigureCanvasAgg(drawing)
    axes = drawing.subplots(3, 2, width_ratios=(1, 1.5), sharey="row")
    places = [*PLACES, *KINDS]
    for (left, right), key in zip(axes, ("dice", "assd", "hd95"), strict=True):
        label = MEASURES[key].label + (f" ({MEASURES[key].unit})" if MEASURES[key].unit else "")
        for i, name in enumerate(names):
            own = where(columns, (columns["contender"] == name) & (columns["status"] != "refused"))
            shift = (i - (len(names) - 1) / 2) * 0.8 / len(names)
            _draw(left, where(own, np.isfinite(own["asked_mm"])), key, "asked_mm", SIZES, i, shift, "-")
            _draw(right, own, key, "defect", places, i, shift, "none")
        left.set(xticks=range(len(SIZES)), xticklabels=SIZES, ylabel=label, xlabel="Mean diameter of the hole (mm)")
        right.set(xticks=range(len(places)), xlabel="Place and kind of the hole")
        right.set_xticklabels([p.replace("_", " ") for p in places], rotation=30, ha="right")
        for ax in (left, right):
            ax.grid(axis="y", color="#DDDDDD", lw=0.6)
            ax.spines[["top", "right"]].set_visible(False)
    handles = [axes[0, 0].lines[2 * i + 1] for i in range(len(names))]
    drawing.legend(handles, names, loc="outside upper center", ncols=min(len(names), 7), frameon=False)
    return drawing


def _draw(ax: Any, own: Columns, key: str, by: str, order: Sequence[Any], i: int, shift: float, line: str) -> None:
    """Single values and means of one contender along an axis of classes."""
    mark, colour = _MARKS[i % len(_MARKS)]
    at = [order.index(value) + shift for value in own[by]]
    ax.plot(at, values(own, key), ls="none", marker=mark, ms=3.5, color=colour, alpha=0.45, mew=0)
    means = [summary(where(own, own[by] == value))[key].mean for value in order]
    ax.plot(np.arange(len(order)) + shift, means, ls=line, marker=mark, ms=8, color=colour, lw=1.6)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    cohort.add_arguments(parser, "defects")
    parser.add_argument("--plot", type=Path, metavar="PNG", help="default: the folder's name with .png")
    asked = parser.parse_args()
    skulls = sorted(cohort.folder_of(asked, "skullfix/complete").glob("*.nrrd"))
    found = cuts(skulls)
    columns = cohort.run(found, asked)
    print(f"\n== {len(found)} cuts in {len(skulls)} skulls")
    cohort.print_summary(columns, _SHOWN)
    table(columns, "defect", [*PLACES, *KINDS])
    table(columns, "asked_mm", SIZES)
    figure(columns).savefig(asked.plot or asked.out.with_suffix(".png"))


if __name__ == "__main__":
    main()
