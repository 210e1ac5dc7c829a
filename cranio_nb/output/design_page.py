"""A finished run -> one self-contained HTML page: no links, no scripts, pictures inside, words beside each of them.

The page holds no text of the input's headers and no path. Everything is escaped by the template engine.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.metadata import version
from typing import Any

from ..drawing import figures, palette
from ..evaluation.paper_tables import (
    PAPER_BALLOONS,
    PAPER_DISTANCES,
    STATUSES,
    balloon_ranges,
    count_crossed,
    count_statuses,
)
from ..implant.mass import weigh_implant
from ..pipeline.input_digest import case_label
from ..pipeline.run import RunResult, parameters_used
from ..prosthesis import DistanceStats
from ..vault.verdict import rule_rows
from .design_pictures import distance_shots
from .error_pictures import error_shots, largest_errors
from .pages import Shot, page_template

_NAMES = {"theta0": "θ₀ (degrees)", "theta1": "θ₁ (degrees)", "n_iter": "Steps of the balloon"}


def measure_shots(result: RunResult) -> dict[str, list[Shot]]:
    """The pictures that show measures.

    Parameters
    ----------
    result : RunResult

    Returns
    -------
    dict of str to list of Shot
        "distances" and "errors"; both are empty without a truth.
    """
    return {"distances": distance_shots(result), "errors": error_shots(result, largest_errors(result))}


def report_page(result: RunResult, shots: Mapping[str, Sequence[Shot]]) -> str:
    """The page of a run.

    Parameters
    ----------
    result : RunResult
    shots : dict of str to sequence of Shot
        What `design_pictures.patch_shots`, `surface_shots` and `measure_shots` drew of it.

    Returns
    -------
    str
        HTML that needs no other file.
    """
    # only slice methods record slices; without them their tables are left out
    made = result.prosthesis
    slices = made.record.get("slices", [])
    return page_template("design_page.html").render(
        version=version("cranio-nb"),
        label=case_label(result.case.digests["scan"]),
        result=result,
        made=made,
        parameters=parameters_used(result),
        slices=slices,
        counts=count_statuses(slices),
        n_crossed=count_crossed(slices),
        statuses=STATUSES,
        implant=weigh_implant(made.mesh),
        rule=rule_rows(),
        views=shots["views"],
        cuts=shots["cuts"],
        pictures=shots["slices"],
        balloons=balloon_tables(result),
        distances=shots["distances"],
        table3=distance_table(result),
        errors=largest_errors(result),
        error_pictures=shots["errors"],
        design_line=figures.line_style(0)[0],
        colours=palette,
        directions=_n_directions(result),
        unit="px" if made.parameters.get("axial") else "mm",
    )


def balloon_tables(result: RunResult) -> list[dict[str, Any]]:
    """Tables 1 and 2 of the run, with the paper's values beside them where its preset was used.

    Parameters
    ----------
    result : RunResult

    Returns
    -------
    list of dict
        For each table its "title", its "rows" (name, smallest, largest value, then the paper's), and whether it has
        the "paper"'s.
    """
    # the paper's values stand beside this run's only where its preset was used
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


def distance_table(result: RunResult) -> dict[str, DistanceStats]:
    """Table 3 of the run: in voxels as in the paper, and in mm.

    Parameters
    ----------
    result : RunResult

    Returns
    -------
    dict of str to DistanceStats
        Head of each column, with its unit -> its numbers; empty without a truth.
    """
    if result.truth is None:
        return {}
    # in voxels as the paper gives them, then in mm
    columns: dict[str, DistanceStats] = {}
    for side, stats in result.truth.table3.items():
        columns[f"{side.capitalize()} (voxels)"] = stats
    for side, d in result.truth.distances.items():
        columns[f"{side.capitalize()} (mm)"] = DistanceStats(d.min(), d.max(), d.mean(), d.std())
    if result.preset == "paper":
        columns |= {f"Paper: {name} (voxels)": stats for name, stats in PAPER_DISTANCES.items()}
    return columns


def _n_directions(result: RunResult) -> int:
    """In how many directions the largest opening was cut."""
    return sum(getattr(part, "opening", None) is result.case.openings[0] for part in result.prosthesis.working)
