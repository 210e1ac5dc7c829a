"""A finished run -> the pictures of its page, each with words beside it."""

from __future__ import annotations

import numpy as np

from ..drawing import figures
from ..drawing.coarse_skull import skull_surface
from ..evaluation.against_truth import TruthCheck
from ..evaluation.paper_tables import pick_slices
from ..mesh import INNER, OUTER
from ..methods.slicewise.slices import SlicedDesign, SliceResult
from ..pipeline.run import RunResult
from .pages import Shot, lowest_shown, shot

N_SLICES = 6
"""Slices shown."""


def view_shots(result: RunResult) -> list[Shot]:
    """Skull and prosthesis from three sides.

    Parameters
    ----------
    result : RunResult

    Returns
    -------
    list of Shot
    """
    # one coarse skull for all views, cut off above the face
    skull = skull_surface(result.case.bone, lowest_shown(result.case.sizes, result.case.openings[0]))
    where = "; ".join(one.place for one in result.case.sizes)
    shots = []
    for name, towards in figures.views_of([one.direction for one in result.case.sizes]).items():
        alt = (
            f"Shaded view {name}: the vault of the skull in ivory and the prosthesis in blue, which closes the opening "
            f"({where}). Letters at the edges name the patient's sides; the scale bar is 50 mm."
        )
        figure = figures.view_figure(skull, result.prosthesis.mesh, towards)
        shots.append(shot(figure, alt=alt, caption=_capital(name)))
    return shots


def slice_shots(result: RunResult) -> list[Shot]:
    """A few slices of each opening, in the first direction it was cut along, with all that was done in them.

    Parameters
    ----------
    result : RunResult

    Returns
    -------
    list of Shot
        `N_SLICES` in all, two of each opening at least; empty for a method without slices.
    """
    made = result.prosthesis
    # the first direction of each opening shows how the method works; the others look alike
    skeleton = bool(made.parameters.get("axial", False))
    sliced = [part for part in made.working if isinstance(part, SlicedDesign)]
    first = [next((part for part in sliced if part.opening is one), None) for one in result.case.openings]
    shots = []
    for number_of, part in enumerate(first, 1):
        if part is None:
            continue
        at = f"opening {number_of}, slice" if len(first) > 1 else "slice"
        # spread over the slices, with one of each status
        for i in pick_slices([s.status for s in part.slices], max(2, N_SLICES // len(first))):
            s, title = part.slices[i], f"{at} {i + 1} of {len(part.slices)}"
            figure = figures.slice_figure(part, s, result.case.bone, made.patch, skeleton=skeleton)
            shots.append(shot(figure, alt=_slice_alt(title, s), caption=_slice_caption(title, s)))
    return shots


def distance_shots(result: RunResult) -> list[Shot]:
    """Distance maps of the outer and the inner side with one colour scale, and that scale.

    Parameters
    ----------
    result : RunResult

    Returns
    -------
    list of Shot
        The scale last; empty without a truth.
    """
    truth, made = result.truth, result.prosthesis
    if truth is None or not truth.distances:
        return []
    # one scale for both sides, the inner one seen from inside the head
    top_mm, towards = _top_of_scale(truth), np.array(result.case.sizes[0].direction)
    shots = []
    for side, label, sign in (("outer", OUTER, 1.0), ("inner", INNER, -1.0)):
        if side not in truth.distances:
            continue
        d = truth.distances[side]
        figure = figures.distance_figure(made.mesh, made.surface(label), d, sign * towards, top_mm=top_mm)
        alt = (
            f"Distance map of the {side} side: dark blue 0 mm, yellow {top_mm:g} mm or more from the true surface; "
            f"mean {d.mean():.2f} mm, largest {d.max():.2f} mm; scale bar 20 mm."
        )
        seen = "from outside" if sign > 0 else "from inside the head"
        shots.append(shot(figure, alt=alt, caption=f"{side.capitalize()} side, seen {seen}"))
    bar = figures.colour_bar_figure(top_mm, "Distance from the true surface (mm)")
    alt = f"Colour scale of both maps: distance from the true surface, dark blue 0 mm to yellow {top_mm:g} mm."
    return [*shots, shot(bar, alt=alt, caption="Colour scale of both maps")]


def _slice_caption(title: str, s: SliceResult) -> str:
    """Angles and steps of a slice, outer and inner; for a slice without its own curves, why it has none."""
    inflation = s.inflation
    if inflation is None:
        return f"{_capital(title)}: {s.status} ({s.reason.rstrip('.')})."
    # both balloons with their end angles and steps
    angles = "; ".join(
        f"{side}: θ₀ {inflation.theta0_deg[i]:.0f}°, θ₁ {inflation.theta1_deg[i]:.0f}°, {_steps(inflation.n_iter[i])}"
        + ("" if inflation.converged[i] else ", not at rest")
        for i, side in enumerate(("outer", "inner"))
    )
    return f"{_capital(title)}: {angles}."


def _slice_alt(title: str, s: SliceResult) -> str:
    """What the picture of a slice shows."""
    what = {
        "balloon": "the gap in the bone is bridged by an outer (blue) and an inner (vermillion) curve from end to end",
        "hull": "the bone is a closed ring; its dent is filled up to the convex hull",
        "carried": "the curves across the gap are taken from the neighbouring slices",
        "skipped": "the gap is left open",
    }[s.status]
    return f"Cut through the skull, {title}: {what}; the patch is light blue, the bone grey; scale bar 20 mm."


def _steps(n: int) -> str:
    """A number of steps in words."""
    return f"{n} step" if n == 1 else f"{n} steps"


def _capital(text: str) -> str:
    """Text with a capital at its start; the rest as it is."""
    return text[0].upper() + text[1:]


def _top_of_scale(truth: TruthCheck) -> float:
    """Upper end of the colour scale, mm: a round number above 99 % of the distances."""
    high = max(float(np.percentile(d, 99)) for d in truth.distances.values())
    return max(0.5, float(np.ceil(high * 2) / 2))
