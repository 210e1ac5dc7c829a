"""A comparison -> one self-contained HTML page.

Every method is shown in the same view and scale, and all distance maps share one colour scale. The page holds no text
of the input's headers and no path.
"""

from __future__ import annotations

from importlib.metadata import version

import numpy as np
from numpy.typing import NDArray

from ..drawing import figures, palette
from ..drawing.coarse_skull import skull_surface
from ..drawing.shading import view_axes
from ..evaluation.against_truth import SIDES
from ..grid import true_indices
from ..mesh import Mesh
from ..pipeline.compare import MEASURES, Comparison
from ..vault.verdict import rule_rows
from .comparison_tables import tables
from .pages import Shot, lowest_shown, page_template, shot

_AROUND_MM = 18.0  # of a cut shown beside the patches
_N_VIEWS = 2
_VIEW_PX_MM, _MAP_PX_MM = 0.8, 0.3  # size of a pixel of a view, of a distance map
_SEEN = {"outer": ("Outer side, seen from outside", 1.0), "inner": ("Inner side, seen from inside the head", -1.0)}


def comparison_page(comparison: Comparison) -> str:
    """The page of a comparison.

    Parameters
    ----------
    comparison : Comparison

    Returns
    -------
    str
        HTML that needs no other file.
    """
    # pictures need a prosthesis, maps need a reference; without them the template leaves their part out
    case = comparison.case
    return page_template("comparison_page.html").render(
        version=version("cranio-nb"),
        comparison=comparison,
        findings=case.remarks,
        rule=rule_rows(),
        lines=dict(zip(comparison.made, _line_styles(len(comparison.made)), strict=True)),
        colours=palette,
        tables=tables(comparison),
        measures=MEASURES,
        views=view_shots(comparison) if comparison.made else {},
        cuts=cut_shots(comparison) if comparison.made else [],
        maps=distance_shots(comparison),
        bar=_bar_shot(comparison) if comparison.distances else None,
        against=_reference_words(comparison),
    )


def view_shots(comparison: Comparison) -> dict[str, list[Shot]]:
    """Shaded views of each prosthesis, and of the truth where it is known, all from the same sides.

    Parameters
    ----------
    comparison : Comparison
        With one prosthesis at least.

    Returns
    -------
    dict of str to list of Shot
        Name of the view -> its pictures, the truth first.
    """
    # one skull and two views for all contenders, so that only the prostheses differ
    case = comparison.case
    skull = skull_surface(case.bone, lowest_shown(case.sizes, case.openings[0]))
    shown = {name: made.mesh for name, made in comparison.made.items()}
    if comparison.true is not None:
        shown = {"truth": comparison.true.mesh} | shown
    towards = list(figures.views_of([one.direction for one in case.sizes]).items())[:_N_VIEWS]
    drawn = {name: figures.skull_view(skull, side, px_mm=_VIEW_PX_MM) for name, side in towards}
    return {side: [_view_shot(name, mesh, side, view) for name, mesh in shown.items()] for side, view in drawn.items()}


def _view_shot(name: str, mesh: Mesh, side: str, view: figures.SkullView) -> Shot:
    """One prosthesis from one side."""
    what = "the bone that is missing" if name == "truth" else f"the prosthesis of {name}"
    alt = f"Shaded view {side}: the vault of the skull in ivory and {what} in blue; the scale bar is 50 mm."
    return shot(figures.view_figure(view, mesh), alt=alt, caption=name)


def cut_shots(comparison: Comparison) -> list[Shot]:
    """Two cuts at right angles through the middle of the largest opening, with the outlines of all patches.

    Parameters
    ----------
    comparison : Comparison
        With one prosthesis at least.

    Returns
    -------
    list of Shot
    """
    case, made = comparison.case, comparison.made
    patches = [p.patch for p in made.values() if p.patch is not None]
    # cuts along the picture's axes as seen from outside, through the middle of the opening
    largest = case.openings[0]
    right, down, towards = view_axes(largest.direction)
    points = largest.sheet.to_world(true_indices(largest.sheet.voxels)) - largest.centre
    shots = []
    for along in (right, down):
        # wide enough for the opening's extent along this cut
        figure = figures.outlines_figure(
            case.bone,
            case.truth,
            patches,
            centre=largest.centre,
            axes=(along, -towards),
            reach_mm=float(np.abs(points @ along).max()) + _AROUND_MM,
        )
        # what is to be seen, for those who cannot see it
        truth = ", the missing bone pale purple" if case.truth is not None else ""
        ends = _ends(along)
        alt = (
            f"Cut through the middle of the largest opening from {ends}, outside up: bone grey{truth}, and the "
            f"outlines of the patches of {', '.join(made)} as lines; scale bar 20 mm."
        )
        shots.append(shot(figure, alt=alt, caption=f"From {ends}, outside up"))
    return shots


def _ends(along: NDArray[np.float64]) -> str:
    """Words for the two ends of a line, e.g. "the front to the back", by its main direction (LPS)."""
    return f"the {palette.side_word(-along)} to the {palette.side_word(along)}"


def distance_shots(comparison: Comparison) -> dict[str, list[Shot]]:
    """Distance maps of each contender but the reference, all on one colour scale and from one side.

    Parameters
    ----------
    comparison : Comparison

    Returns
    -------
    dict of str to list of Shot
        The side, in words -> its maps.
    """
    towards = np.array(comparison.case.openings[0].direction)
    shots = {}
    for side, (words, sign) in _SEEN.items():
        maps = {name: sides[side] for name, sides in comparison.distances.items() if side in sides}
        shots[words] = [_distance_shot(comparison, name, side, d, sign * towards) for name, d in maps.items()]
    return shots


def _distance_shot(
    comparison: Comparison, name: str, side: str, d: NDArray[np.float64], towards: NDArray[np.float64]
) -> Shot:
    """Distance map of one side of one contender."""
    # one scale for all maps: colours of two methods can be compared
    made, top_mm = comparison.made[name], comparison.top
    surface = made.surface(SIDES[side])
    figure = figures.distance_figure(made.mesh, surface, d, towards, top_mm=top_mm, px_mm=_MAP_PX_MM)
    alt = (
        f"Distance map of the {side} side of {name}: dark blue 0 mm, yellow {top_mm:g} mm or more from "
        f"{_reference_words(comparison)}; mean {d.mean():.2f} mm, largest {d.max():.2f} mm, ringed; scale bar 20 mm."
    )
    return shot(figure, alt=alt, caption=f"{name}: mean {d.mean():.2f} mm")


def _bar_shot(comparison: Comparison) -> Shot:
    """The colour scale of all maps."""
    words = f"Distance from {_reference_words(comparison)} (mm)"
    alt = f"Colour scale of all maps: dark blue 0 mm to yellow {comparison.top:g} mm, distance from the reference."
    bar = figures.colour_bar_figure(comparison.top, words)
    return shot(bar, alt=alt, caption="One colour scale for all maps")


def _reference_words(comparison: Comparison) -> str:
    """What distances are measured from."""
    return "the true surface" if comparison.reference == "truth" else f"the surface of {comparison.reference}"


def _line_styles(n: int) -> list[tuple[str, str]]:
    """Colour and SVG dashes of the outlines in the order they are drawn."""
    styles = map(figures.line_style, range(n))
    return [(colour, " ".join(f"{2.5 * d:g}" for d in dashes)) for colour, dashes in styles]
