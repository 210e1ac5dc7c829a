"""A comparison -> one self-contained HTML page, and the table as CSV and JSON.

Every method is shown in the same view and scale, and all distance maps share one colour scale. The page holds no text
of the input's headers and no path.
"""

from __future__ import annotations

import csv
import io
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..drawing import figures
from ..drawing.shading import skull_surface, view_axes
from ..evaluation.against_truth import SIDES
from ..evaluation.opening_size import OpeningSize, measure_opening
from ..mesh import Mesh
from ..pipeline.compare import MEASURES, Comparison, records
from . import files
from .design_folder import load_record, versions
from .design_page import Shot, floor, page_template, shot

FILES = ("comparison.csv", "comparison.json", "comparison.html")
"""What a comparison leaves in its folder."""
_AROUND = 18.0  # mm of a cut shown beside the patches
_VIEWS = 2
_VIEW_PX, _MAP_PX = 0.8, 0.3  # mm per pixel of a view, of a distance map
_SEEN = {"outer": ("Outer side, seen from outside", 1.0), "inner": ("Inner side, seen from inside the head", -1.0)}


def write_comparison(comparison: Comparison, folder: Path) -> None:
    """Write the `FILES` into a folder that is there, usually the one from `outputs.staged`; raises `CannotWrite`."""
    files.write_text(folder / "comparison.csv", comparison_csv(comparison))
    files.write_json(folder / "comparison.json", comparison_record(comparison))
    files.write_text(folder / "comparison.html", comparison_page(comparison))


def comparison_csv(comparison: Comparison) -> str:
    """The table with a line for each contender; an empty cell where there is no value."""
    rows = [{k: v for k, v in row.items() if k != "parameters"} for row in records(comparison)]
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def comparison_record(comparison: Comparison) -> dict[str, Any]:
    """What `comparison.json` says; JSON-able after `export.jsonable`."""
    return {
        "cranio_nb": version("cranio-nb"),
        "not_for_clinical_use": True,
        "load": load_record(comparison.case.load),
        "bone_threshold_hu": comparison.case.threshold,
        "openings": [measure_opening(one) for one in comparison.case.openings],
        "units": {key: what.unit for key, what in MEASURES.items()},
        "reference": comparison.reference,
        "methods": records(comparison),
        "pairs": [{"methods": pair, "dice": d, "assd": a} for pair, (d, a) in comparison.pairs.items()],
        "colour_scale_mm": [0.0, comparison.top],
        "versions": versions(),
    }


def comparison_page(comparison: Comparison) -> str:
    """The page as text."""
    openings = [measure_opening(one) for one in comparison.case.openings]
    return page_template("comparison.html").render(
        version=version("cranio-nb"),
        comparison=comparison,
        openings=openings,
        lines=dict(zip(comparison.made, _lines(len(comparison.made)), strict=True)),
        sky=figures.SKY,
        bone=figures.BONE,
        tables=tables(comparison),
        measures=MEASURES,
        views=view_shots(comparison, openings) if comparison.made else {},
        cuts=cut_shots(comparison) if comparison.made else [],
        maps=distance_shots(comparison),
        bar=_bar(comparison) if comparison.distances else None,
        against=_against(comparison),
    )


def tables(comparison: Comparison) -> list[dict[str, Any]]:
    """Accuracy (where a truth is known), and the implants with their cost: title, columns, rows, best values.

    The best value of a column is the one nearest to the end that is better, where contenders differ as printed.
    """
    parts = {"The implants, and what they cost": [k for k, m in MEASURES.items() if not m.needs_truth]}
    if comparison.case.truth is not None:
        parts = {"Against the truth": [k for k, m in MEASURES.items() if m.needs_truth]} | parts
    return [
        {"title": title, "keys": keys, "best": {key: _best(comparison, key) for key in keys}}
        for title, keys in parts.items()
    ]


def _best(comparison: Comparison, key: str) -> float | None:
    """The best value of a column as it is printed; None where no end is better or all are alike."""
    what = MEASURES[key]
    shown = {round(float(row[key]), what.digits) for row in comparison.rows if np.isfinite(row[key])}
    if not what.best or len(shown) < 2:
        return None
    return max(shown) if what.best == "high" else min(shown)


def view_shots(comparison: Comparison, openings: list[OpeningSize]) -> dict[str, list[Shot]]:
    """Name of a view -> a picture of each prosthesis, and of the truth where it is known, all seen alike."""
    case = comparison.case
    skull = skull_surface(case.bone, floor(openings, case.openings[0]))
    shown = {name: made.mesh for name, made in comparison.made.items()}
    if comparison.true is not None:
        shown = {"truth": comparison.true.mesh} | shown
    towards = list(figures.views_of([one.direction for one in openings]).items())[:_VIEWS]
    return {view: [_view(name, mesh, skull, view, side) for name, mesh in shown.items()] for view, side in towards}


def _view(name: str, mesh: Mesh, skull: Mesh, view: str, side: NDArray[np.float64]) -> Shot:
    what = "the bone that is missing" if name == "truth" else f"the prosthesis of {name}"
    alt = f"Shaded view {view}: the vault of the skull in ivory and {what} in blue; the scale bar is 50 mm."
    return shot(figures.view_figure(skull, mesh, side, px=_VIEW_PX), alt, name)


def cut_shots(comparison: Comparison) -> list[Shot]:
    """Two cuts at right angles through the middle of the largest opening, with the outlines of all patches."""
    case, made = comparison.case, comparison.made
    patches = [p.patch for p in made.values() if p.patch is not None]
    largest = case.openings[0]
    right, down, towards = view_axes(largest.direction)
    shots = []
    for along in (right, down):
        points = largest.sheet.to_world(np.argwhere(largest.sheet.voxels)) - largest.centre
        reach = float(np.abs(points @ along).max()) + _AROUND
        figure = figures.outlines_figure(case.bone, case.truth, patches, largest.centre, (along, -towards), reach)
        truth = ", the missing bone light blue" if case.truth is not None else ""
        letters = _ends(along)
        alt = (
            f"Cut through the middle of the largest opening from {letters}, outside up: bone grey{truth}, and the "
            f"outlines of the patches of {', '.join(made)} as lines; scale bar 20 mm."
        )
        shots.append(shot(figure, alt, f"From {letters}, outside up"))
    return shots


def _ends(along: NDArray[np.float64]) -> str:
    """Words for the two ends of a line, e.g. "front to back", by its main direction (LPS)."""
    names = (("the right", "the left"), ("the front", "the back"), ("the base", "the top"))
    axis = int(np.argmax(np.abs(along)))
    first, last = names[axis] if along[axis] > 0 else names[axis][::-1]
    return f"{first} to {last}"


def distance_shots(comparison: Comparison) -> dict[str, list[Shot]]:
    """Side, in words -> a map for each contender but the reference, all on one colour scale and from one side."""
    towards = np.array(comparison.case.openings[0].direction)
    shots = {}
    for side, (words, sign) in _SEEN.items():
        maps = {name: sides[side] for name, sides in comparison.distances.items() if side in sides}
        shots[words] = [_map(comparison, name, side, d, sign * towards) for name, d in maps.items()]
    return shots


def _map(comparison: Comparison, name: str, side: str, d: NDArray[np.float64], towards: NDArray[np.float64]) -> Shot:
    made = comparison.made[name]
    figure = figures.distance_figure(made.mesh, made.surface(SIDES[side]), d, towards, comparison.top, px=_MAP_PX)
    alt = (
        f"Distance map of the {side} side of {name}: dark blue 0 mm, yellow {comparison.top:g} mm or more from "
        f"{_against(comparison)}; mean {d.mean():.2f} mm, largest {d.max():.2f} mm; scale bar 20 mm."
    )
    return shot(figure, alt, f"{name}: mean {d.mean():.2f} mm")


def _bar(comparison: Comparison) -> Shot:
    words = f"Distance from {_against(comparison)} (mm)"
    alt = f"Colour scale of all maps: dark blue 0 mm to yellow {comparison.top:g} mm, distance from the reference."
    return shot(figures.colour_bar_figure(comparison.top, words), alt, "One colour scale for all maps")


def _against(comparison: Comparison) -> str:
    return "the true surface" if comparison.reference == "truth" else f"the surface of {comparison.reference}"


def _lines(n: int) -> list[tuple[str, str]]:
    """Colour and SVG dashes of the outlines in the order they are drawn."""
    styles = map(figures.line_style, range(n))
    return [(colour, " ".join(f"{2.5 * d:g}" for d in dashes)) for colour, dashes in styles]
