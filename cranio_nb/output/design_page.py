"""A finished run -> one self-contained HTML page: no links, no scripts, pictures inside, words beside each of them.

The page holds no text of the input's headers and no path. Everything is escaped by the template engine.
"""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.metadata import version
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined, Template

from ..drawing import figures
from ..drawing.shading import skull_surface
from ..evaluation.paper_tables import (
    PAPER_BALLOONS,
    PAPER_DISTANCES,
    STATUSES,
    OpeningSize,
    balloon_ranges,
    count_statuses,
    telling_slices,
)
from ..implant.workshop import implant_data
from ..methods.slicewise.slices import SlicedDesign, SliceResult
from ..opening import Opening
from ..pipeline.run import RunResult, TruthCheck, parameters_used
from ..prosthesis import INNER, OUTER, DistanceStats

N_SLICES = 6
"""Slices shown."""
_NAMES = {"theta0": "θ₀ (degrees)", "theta1": "θ₁ (degrees)", "n_iter": "Steps of the balloon"}


@dataclass(frozen=True)
class Shot:
    """A picture of the page.

    Parameters
    ----------
    data : str
        PNG in base64.
    alt : str
        What it shows, for those who do not see it.
    caption : str
        Line below it.
    width : int
        Width in px, so that pictures of one row keep one scale.
    """

    data: str
    alt: str
    caption: str
    width: int


def report_page(result: RunResult) -> str:
    """The page of a run, as text."""
    made = result.prosthesis
    slices = made.record.get("slices", [])
    return page_template("report.html").render(
        version=version("cranio-nb"),
        result=result,
        made=made,
        parameters=parameters_used(result),
        slices=slices,
        counts=count_statuses(slices),
        statuses=STATUSES,
        implant=implant_data(made.mesh),
        views=view_shots(result),
        pictures=slice_shots(result),
        balloons=balloon_tables(result),
        distances=distance_shots(result),
        table3=distance_table(result),
        colours=figures,
        directions=_directions(result),
        unit="px" if made.parameters.get("axial") else "mm",
    )


@lru_cache
def page_template(name: str) -> Template:
    """A template of the package, with the filter `num` (see `number`)."""
    environment = Environment(
        loader=PackageLoader("cranio_nb.output"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["num"] = number
    return environment.get_template(name)


def number(value: Any, digits: int = 2) -> str:
    """A number for reading: whole numbers plain, others with a fixed number of digits, a dash for none."""
    if value is None:
        return "-"
    if isinstance(value, bool | np.bool_ | str):
        return str(value)
    return str(int(value)) if isinstance(value, int | np.integer) else f"{float(value):.{digits}f}"


def view_shots(result: RunResult) -> list[Shot]:
    """Skull and prosthesis from three sides."""
    skull = skull_surface(result.case.bone, floor(result.sizes, result.case.openings[0]))
    where = "; ".join(one.place for one in result.sizes)
    shots = []
    for name, towards in figures.views_of([one.direction for one in result.sizes]).items():
        alt = (
            f"Shaded view {name}: the vault of the skull in ivory and the prosthesis in blue, which closes the opening "
            f"({where}). Letters at the edges name the patient's sides; the scale bar is 50 mm."
        )
        figure = figures.view_figure(skull, result.prosthesis.mesh, towards)
        shots.append(shot(figure, alt, name[0].upper() + name[1:]))
    return shots


def floor(openings: Sequence[OpeningSize], largest: Opening) -> float:
    """World z in mm down to which views show the skull: below the openings, and above the face if they allow it."""
    lowest = min(one.lowest for one in openings)
    return min(float(largest.head_centre[2]) - 10.0, lowest - 15.0)


def slice_shots(result: RunResult) -> list[Shot]:
    """A few slices of each opening, in the first direction it was cut along, with all that was done in them."""
    made = result.prosthesis
    sliced = [part for part in made.working if isinstance(part, SlicedDesign)]
    first = [next((part for part in sliced if part.opening is one), None) for one in result.case.openings]
    shots = []
    for number_of, part in enumerate(first, 1):
        if part is None:
            continue
        at = f"opening {number_of}, slice" if len(first) > 1 else "slice"
        for i in telling_slices([s.status for s in part.slices], max(2, N_SLICES // len(first))):
            s, title = part.slices[i], f"{at} {i + 1} of {len(part.slices)}"
            skeleton = bool(made.parameters.get("axial", False))
            figure = figures.slice_figure(part, s, result.case.bone, made.patch, skeleton=skeleton)
            shots.append(shot(figure, _slice_alt(title, s), _slice_caption(title, s)))
    return shots


def _directions(result: RunResult) -> int:
    """In how many directions the largest opening was cut."""
    return sum(getattr(part, "opening", None) is result.case.openings[0] for part in result.prosthesis.working)


def _slice_caption(title: str, s: SliceResult) -> str:
    head = title[0].upper() + title[1:]
    inflation = s.inflation
    if inflation is None:
        return f"{head}: {s.status} ({s.reason.rstrip('.')})."
    angles = "; ".join(
        f"{side}: θ₀ {inflation.theta0_deg[i]:.0f}°, θ₁ {inflation.theta1_deg[i]:.0f}°, {_steps(inflation.n_iter[i])}"
        + ("" if inflation.converged[i] else ", not at rest")
        for i, side in enumerate(("outer", "inner"))
    )
    return f"{head}: {angles}."


def _steps(n: int) -> str:
    return f"{n} step" if n == 1 else f"{n} steps"


def _slice_alt(title: str, s: SliceResult) -> str:
    what = {
        "balloon": "the gap in the bone is bridged by an outer (blue) and an inner (vermillion) curve from end to end",
        "hull": "the bone is a closed ring; its dent is filled up to the convex hull",
        "carried": "the curves across the gap are taken from the neighbouring slices",
        "skipped": "the gap is left open",
    }[s.status]
    return f"Cut through the skull, {title}: {what}; the patch is light blue, the bone grey; scale bar 20 mm."


def balloon_tables(result: RunResult) -> list[dict[str, Any]]:
    """Tables 1 and 2 of the run, with the paper's values beside them where its preset was used."""
    ranges = balloon_ranges(result.prosthesis.record.get("slices", []))
    beside = PAPER_BALLOONS if result.preset == "paper" else {}
    return [
        {
            "title": f"Table {n}: {side} balloon",
            "rows": [(_NAMES[key], *found, *beside.get(side, {}).get(key, ())) for key, found in rows.items()],
            "paper": bool(beside),
        }
        for n, (side, rows) in enumerate(ranges.items(), 1)
    ]


def distance_table(result: RunResult) -> dict[str, Any]:
    """Table 3 of the run: in voxels as in the paper, and in mm."""
    if result.truth is None:
        return {}
    columns: dict[str, DistanceStats] = {}
    for side, stats in result.truth.table3.items():
        columns[f"{side.capitalize()} (voxels)"] = stats
    for side, d in result.truth.distances.items():
        columns[f"{side.capitalize()} (mm)"] = DistanceStats(d.min(), d.max(), d.mean(), d.std())
    if result.preset == "paper":
        columns |= {f"Paper: {name} (voxels)": stats for name, stats in PAPER_DISTANCES.items()}
    return columns


def distance_shots(result: RunResult) -> list[Shot]:
    """Distance maps of the outer and the inner side with one colour scale, and that scale."""
    truth = result.truth
    if truth is None or not truth.distances:
        return []
    top = _scale_top(truth)
    shots = []
    for side, label, sign in (("outer", OUTER, 1.0), ("inner", INNER, -1.0)):
        if side not in truth.distances:
            continue
        d = truth.distances[side]
        surface = result.prosthesis.surface(label)
        figure = figures.distance_figure(
            result.prosthesis.mesh, surface, d, sign * np.array(result.sizes[0].direction), top
        )
        alt = (
            f"Distance map of the {side} side: dark blue 0 mm, yellow {top:g} mm or more from the true surface; "
            f"mean {d.mean():.2f} mm, largest {d.max():.2f} mm; scale bar 20 mm."
        )
        seen = "from outside" if sign > 0 else "from inside the head"
        shots.append(shot(figure, alt, f"{side.capitalize()} side, seen {seen}"))
    bar = figures.colour_bar_figure(top, "Distance from the true surface (mm)")
    alt = f"Colour scale of both maps: distance from the true surface, dark blue 0 mm to yellow {top:g} mm."
    return [*shots, shot(bar, alt, "Colour scale of both maps")]


def _scale_top(truth: TruthCheck) -> float:
    """Upper end of the colour scale: a round number above 99 % of the distances."""
    high = max(float(np.percentile(d, 99)) for d in truth.distances.values())
    return max(0.5, float(np.ceil(high * 2) / 2))


def shot(figure: figures.Figure, alt: str, caption: str) -> Shot:
    """A figure as a picture of a page."""
    data = base64.b64encode(figures.png(figure)).decode("ascii")
    return Shot(data, alt, caption, round(float(figure.get_figwidth() * figure.dpi)))
