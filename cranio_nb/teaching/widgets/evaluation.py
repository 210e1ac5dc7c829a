"""The comparison with the truth under sliders: maps of distances.

Frame: world mm (LPS).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...drawing.canvas import Canvas
from ...drawing.canvas_axes import Chart
from ...drawing.palette import BLACK, COUNTS, WHITE
from ...drawing.shading import Solid, render
from ...errors import InputRefused
from ...evaluation import mesh_distances
from ...evaluation.against_truth import SIDES
from ...prosthesis import Prosthesis
from .controls import Choice, Slider, View
from .panel import Panel
from .parts import HEIGHT, LEFT, RIGHT, WIDTH, coloured, draw_colour_scale, pixel_to_fit, put_view

_VIEW = 340  # px: longer side of a map


def distances(prosthesis: Prosthesis, truth: Prosthesis) -> Panel:
    """Map the distances of a prosthesis from the true one.

    Parameters
    ----------
    prosthesis, truth : Prosthesis
        With outer and inner side; `against_truth.check_truth` makes the true one from a mask (``.prosthesis``).

    Returns
    -------
    Panel
        Controls ``side``, ``top_mm`` and ``limit_mm``.
    """
    maps = {name: map_distances(prosthesis, truth, side) for name, side in SIDES.items()}
    top = max(0.2, round(float(np.percentile(maps["outer"].distances, 99)), 1))
    controls = (
        Choice("side", "side of the prosthesis", tuple(SIDES), "outer"),
        Slider("top_mm", "upper end of the scale", 0.1, 5.0, top, 0.1, unit="mm"),
        Slider("limit_mm", "distance asked about", 0.0, 5.0, 0.5, 0.1, unit="mm"),
    )
    alt = "One side of the prosthesis coloured by its distance from the true surface, and a histogram of distances."
    return Panel(controls, lambda side, **values: _view(maps[side], side, **values), alt=alt)


@dataclass(frozen=True, eq=False)
class DistanceMap:
    """Distances of one side of a prosthesis.

    Parameters
    ----------
    distances : ndarray, shape (V,)
        mm at the nodes.
    picture : ndarray, shape (H, W)
        mm at each pixel of the view; nan beside the surface.
    px : float
        mm per pixel.
    towards : ndarray, shape (3,)
        From the surface to the viewer, LPS.
    """

    distances: NDArray[np.float64]
    picture: NDArray[np.float32]
    px: float
    towards: NDArray[np.float64]


def map_distances(prosthesis: Prosthesis, truth: Prosthesis, side: int) -> DistanceMap:
    """Distances of one side from the same side of the truth, in a view from that side.

    Parameters
    ----------
    prosthesis, truth : Prosthesis
    side : int
        `OUTER` or `INNER`.

    Returns
    -------
    DistanceMap

    Raises
    ------
    InputRefused
        ``EmptyMesh`` where one of the two has no such side.
    """
    own, other = prosthesis.surface(side), truth.surface(side)
    if not len(own.faces) or not len(other.faces):
        raise InputRefused("EmptyMesh", "The prosthesis or the truth lacks its outer or inner side.")
    # drawn once with mm in place of colours: the scale can then change without a new rendering
    off = mesh_distances.surface_distance(own.vertices, other)
    towards = own.area_vectors.sum(axis=0)
    px = pixel_to_fit(own, towards, _VIEW)
    values = np.repeat(off[:, None], 3, axis=1)  # mm in place of colours
    drawn = render([Solid(own, values)], towards, px_mm=px, shaded=False)
    return DistanceMap(off, np.where(np.isfinite(drawn.depth), drawn.rgb[..., 0], np.nan), px, towards)


def draw_distances(canvas: Canvas, known: DistanceMap, top_mm: float, box: tuple[float, float, float, float]) -> None:
    """Draw a map of distances in colours, the largest one marked.

    Parameters
    ----------
    canvas : Canvas
    known : DistanceMap
    top_mm : float
        Upper end of the scale.
    box : tuple of float
        x, y, width and height, px.
    """
    corner = put_view(canvas, coloured(known.picture, top_mm), known.px, known.towards, box)
    row, col = np.unravel_index(np.nanargmax(known.picture), known.picture.shape)
    canvas.dots([(corner[0] + col + 0.5, corner[1] + row + 0.5)], WHITE, radius=4, edge=BLACK)


def _view(known: DistanceMap, side: str, top_mm: float, limit_mm: float) -> View:
    """A map of distances with its scale, and their histogram."""
    canvas = Canvas(WIDTH, HEIGHT)
    draw_distances(canvas, known, top_mm, (0, 0, LEFT, HEIGHT))

    # distances above the scale are counted in its last bar
    high = max(top_mm, 0.2)
    counts, edges = np.histogram(np.minimum(known.distances, high), 60, (0, high))
    chart = Chart((RIGHT[0], 20, RIGHT[2], 340), (0, high), (0, 1.1 * counts.max()))
    more = f"; last bar: {high:g} or more" if known.distances.max() > high else ""
    chart.frame(canvas, "nodes", f"distance (mm){more}")
    chart.bars(canvas, edges, counts, COUNTS)
    legend = [(WHITE, "dot", "largest distance seen")]
    if limit_mm <= high:
        chart.upright(canvas, limit_mm, BLACK, dash=(6, 4))
        legend.append((BLACK, "dash", f"asked about: {limit_mm:g} mm"))
    # the scale below the histogram, as wide as its axis
    x, _, width, _ = chart.area
    draw_colour_scale(canvas, (x, 420), round(width), top_mm)
    canvas.legend(x - 8, 470, legend)

    d = known.distances
    line = f"{side.capitalize()} side: mean {d.mean():.2f} mm, std {d.std():.2f} mm, max {d.max():.2f} mm; "
    return View(canvas.array(), line + f"{100 * (d <= limit_mm).mean():.0f} % of the nodes lie within {limit_mm:g} mm.")
