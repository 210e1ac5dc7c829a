"""A design -> the pictures of its page, each with words beside it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..drawing import figures
from ..drawing.coarse_skull import skull_surface
from ..evaluation.against_truth import TruthCheck
from ..evaluation.paper_tables import pick_slices
from ..mesh import INNER, OUTER, Mesh
from ..methods.slicewise.slices import SlicedDesign, SliceResult
from ..pipeline.preparation import Prepared
from ..pipeline.run import RunResult
from ..prosthesis import Prosthesis
from ..volume import Volume
from .pages import Shot, lowest_shown, shot

N_SLICES = 6
"""Slices shown."""
_SEEN = {"axial": "from the feet", "coronal": "from the front", "sagittal": "from the left"}
_MARGIN_MM = 14.0  # around the bone, room for the letters
_BELOW_MM = 100.0  # shown of the scan below the head's centre
_CROSSED = "the curves cross: do not trust the shape here"


Views = dict[str, figures.SkullView]


def skull_views(case: Prepared) -> Views:
    """The skull from three sides, coarse, and cut off above the face: what there is to draw before a prosthesis.

    Parameters
    ----------
    case : Prepared

    Returns
    -------
    dict of str to SkullView
        By the names of the views.
    """
    vault = skull_surface(case.bone, lowest_shown(case.sizes, case.openings[0]))
    sides = figures.views_of([one.direction for one in case.sizes])
    return {name: figures.skull_view(vault, towards) for name, towards in sides.items()}


def patch_shots(case: Prepared, made: Prosthesis) -> dict[str, list[Shot]]:
    """All pictures that need neither a surface nor measures.

    Parameters
    ----------
    case : Prepared
    made : Prosthesis
        Designed for it; its mesh may still be missing.

    Returns
    -------
    dict of str to list of Shot
        "cuts" and "slices".
    """
    made = made.cropped()  # no picture looks beyond its box
    return {"cuts": cut_shots(case, made), "slices": slice_shots(case, made)}


def surface_shots(case: Prepared, views: Views, made: Prosthesis) -> dict[str, list[Shot]]:
    """All pictures that need the surface, and no measures.

    Parameters
    ----------
    case : Prepared
    views : dict of str to SkullView
        Its `skull_views`.
    made : Prosthesis
        Designed for it.

    Returns
    -------
    dict of str to list of Shot
        "views".
    """
    return {"views": view_shots(case, views, made.mesh)}


def view_shots(case: Prepared, views: Views, prosthesis: Mesh) -> list[Shot]:
    """Skull and prosthesis from three sides.

    Parameters
    ----------
    case : Prepared
    views : dict of str to SkullView
        Its `skull_views`.
    prosthesis : Mesh
        World mm.

    Returns
    -------
    list of Shot
    """
    where = "; ".join(one.place for one in case.sizes)
    shots = []
    for name, view in views.items():
        alt = (
            f"Shaded view {name}: the vault of the skull in ivory and the prosthesis in blue, which closes the opening "
            f"({where}). Letters at the edges name the patient's sides; the scale bar is 50 mm."
        )
        shots.append(shot(figures.view_figure(view, prosthesis), alt=alt, caption=_capital(name)))
    return shots


def cut_shots(case: Prepared, made: Prosthesis) -> list[Shot]:
    """The scan with the patch in an axial, a coronal and a sagittal cut through each opening.

    Parameters
    ----------
    case : Prepared
    made : Prosthesis

    Returns
    -------
    list of Shot
        Three of each opening that is closed, the largest first.
    """
    patch, corners, what = made.patch, _shown_corners(case), "CT" if case.load.kind == "ct" else "bone mask"
    shots = []
    for one in case.closed:
        place = _place_in(one.opening.sheet if patch is None else patch, one.opening.centre)
        for name in figures.CUTS:
            figure = figures.cut_figure(case.scan, patch, name, place, corners)
            at = f"{name} cut, {_position(case, name, place)}"
            alt = (
                f"{what}, {at}, seen {_SEEN[name]}, through opening {one.number} ({one.size.place}): bone is bright,"
                " the patch blue; yellow lines show where the two other cuts lie; letters at the edges name the"
                " patient's sides; the scale bar is 50 mm."
            )
            shots.append(shot(figure, alt=_capital(alt), caption=f"{_capital(at)}, seen {_SEEN[name]}"))
    return shots


def _shown_corners(case: Prepared) -> NDArray[np.float64]:
    """Lowest and highest x, y, z of the bone with a margin, without what lies far below the head's centre."""
    box = case.bone.box()
    ends = np.array([[one.start, one.stop - 1] for one in box])
    corners = case.bone.to_world(np.stack(np.meshgrid(*ends), axis=-1).reshape(-1, 3))
    low, high = corners.min(axis=0) - _MARGIN_MM, corners.max(axis=0) + _MARGIN_MM
    low[2] = max(low[2], case.openings[0].head_centre[2] - _BELOW_MM)
    return np.stack([low, high])


def _place_in(mask: Volume, point: NDArray[np.float64]) -> NDArray[np.float64]:
    """The voxel of a mask that is nearest to a point, world mm."""
    places = mask.to_world(np.argwhere(mask.voxels))
    return places[np.argmin(((places - point) ** 2).sum(axis=1))]


def _position(case: Prepared, name: str, place: NDArray[np.float64]) -> str:
    """Where a cut lies: the axial one by its plane of the scan, the others in mm."""
    if name == "axial":
        return f"plane {round(float(case.bone.to_voxel(place)[0]))}"
    axis = {"coronal": 1, "sagittal": 0}[name]
    return f"{'xyz'[axis]} {place[axis]:.0f} mm"


def slice_shots(case: Prepared, made: Prosthesis) -> list[Shot]:
    """A few slices of each opening, in the first direction it was cut along, with all that was done in them.

    Parameters
    ----------
    case : Prepared
    made : Prosthesis

    Returns
    -------
    list of Shot
        `N_SLICES` in all, two of each opening at least, and one more where curves cross in other directions only;
        empty for a method without slices.
    """
    skeleton = bool(made.parameters.get("axial", False))
    sliced = [part for part in made.working if isinstance(part, SlicedDesign)]
    by_opening = [[part for part in sliced if part.opening is one] for one in case.openings]
    shots = []
    for number, parts in enumerate(by_opening, 1):
        of = f"opening {number}, " if len(by_opening) > 1 else ""
        for direction, i in _picked(parts, max(2, N_SLICES // len(by_opening))):
            part, s = parts[direction], parts[direction].slices[i]
            turned = f"direction {direction + 1}, " if direction else ""
            title = f"{of}{turned}slice {i + 1} of {len(part.slices)}"
            figure = figures.slice_figure(part, s, case.bone, made.patch, skeleton=skeleton)
            shots.append(shot(figure, alt=_slice_alt(title, s), caption=_slice_caption(title, s)))
    return shots


def _picked(parts: list[SlicedDesign], n: int) -> list[tuple[int, int]]:
    """Slices of one opening to show, as (direction, slice)."""
    if not parts:
        return []
    # the first direction shows how the method works; the others look alike, unless curves cross in them
    kinds = [["crossed" if len(s.crossings) else s.status for s in part.slices] for part in parts]
    shown = [(0, i) for i in pick_slices(kinds[0], n)]
    crossed = [(k, i) for k, row in enumerate(kinds) for i, kind in enumerate(row) if kind == "crossed"]
    return shown if set(shown) & set(crossed) else shown + crossed[len(crossed) // 2 :][:1]


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
            f"mean {d.mean():.2f} mm, largest {d.max():.2f} mm, ringed; scale bar 20 mm."
        )
        seen = "from outside" if sign > 0 else "from inside the head"
        shots.append(shot(figure, alt=alt, caption=f"{side.capitalize()} side, seen {seen}: ring at {d.max():.2f} mm"))
    bar = figures.colour_bar_figure(top_mm, "Distance from the true surface (mm)")
    alt = f"Colour scale of both maps: distance from the true surface, dark blue 0 mm to yellow {top_mm:g} mm."
    return [*shots, shot(bar, alt=alt, caption="Colour scale of both maps")]


def _slice_caption(title: str, s: SliceResult) -> str:
    """Angles and steps of a slice, outer and inner; for a slice without its own curves, why it has none."""
    inflation, warning = s.inflation, f"; {_CROSSED}" if len(s.crossings) else ""
    if inflation is None:
        return f"{_capital(title)}: {s.status} ({s.reason.rstrip('.')}){warning}."
    # both balloons with their end angles and steps
    angles = "; ".join(
        f"{side}: θ₀ {inflation.theta0_deg[i]:.0f}°, θ₁ {inflation.theta1_deg[i]:.0f}°, {_steps(inflation.n_iter[i])}"
        + ("" if inflation.converged[i] else ", not at rest")
        for i, side in enumerate(("outer", "inner"))
    )
    return f"{_capital(title)}: {angles}{warning}."


def _slice_alt(title: str, s: SliceResult) -> str:
    """What the picture of a slice shows."""
    what = {
        "balloon": "the gap in the bone is bridged by an outer (blue) and an inner (vermillion) curve from end to end",
        "hull": "the bone is a closed ring; its dent is filled up to the convex hull",
        "carried": "the curves across the gap are taken from the neighbouring slices",
        "skipped": "the gap is left open",
    }[s.status]
    crossed = "; crosses mark where the two curves cross each other" if len(s.crossings) else ""
    return (
        f"Cut through the skull, {title}: {what}{crossed}; the patch is light blue, the bone grey; letters name the"
        " sides; scale bar 20 mm."
    )


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
