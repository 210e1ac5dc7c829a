"""The comparison with the truth under sliders: maps of distances.

Frame: world mm (LPS).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...drawing.canvas import SKY, VERMILLION, Canvas
from ...drawing.canvas_axes import Chart
from ...drawing.shading import Solid, render
from ...errors import InputRefused
from ...evaluation import scores
from ...evaluation.against_truth import SIDES
from ...prosthesis import Prosthesis
from .controls import Choice, Slider, View
from .panel import Panel
from .parts import VIEW, colour_ramp, coloured, pixel, put_view

_CHART = 350  # px


def distances(prosthesis: Prosthesis, truth: Prosthesis) -> Panel:
    """Map the distances of a prosthesis from the true one.

    Parameters
    ----------
    prosthesis, truth : Prosthesis
        With outer and inner side; `run.check_truth` makes the true one from a mask (``.prosthesis``).
    """
    maps = {name: distance_map(prosthesis, truth, side) for name, side in SIDES.items()}
    top = max(0.2, round(float(np.percentile(maps["outer"].distances, 99)), 1))
    controls = (
        Choice("side", "side of the prosthesis", tuple(SIDES), "outer"),
        Slider("top", "upper end of the scale (mm)", 0.1, 5.0, top, 0.1),
        Slider("limit", "distance asked about (mm)", 0.0, 5.0, 0.5, 0.1),
    )
    alt = "One side of the prosthesis coloured by its distance from the true surface, and a histogram of distances."
    return Panel(controls, lambda side, **values: distance_view(maps[side], side, **values), alt=alt)


@dataclass(frozen=True, eq=False)
class DistanceMap:
    """Distances of one side of a prosthesis.

    Parameters
    ----------
    distances : ndarray, shape (V,)
        mm at the nodes.
    seen : ndarray, shape (H, W)
        mm at each pixel of the view; nan beside the surface.
    px : float
        mm per pixel.
    """

    distances: NDArray[np.float64]
    seen: NDArray[np.float32]
    px: float


def distance_map(prosthesis: Prosthesis, truth: Prosthesis, side: int) -> DistanceMap:
    """Distances of one side from the same side of the truth, looked at from that side."""
    own, other = prosthesis.surface(side), truth.surface(side)
    if not len(own.faces) or not len(other.faces):
        raise InputRefused("EmptyMesh", "The prosthesis or the truth lacks its outer or inner side.")
    distances = scores.surface_distance(own.vertices, other)
    towards = own.area_vectors.sum(axis=0)
    px = pixel(own, towards, VIEW - 60)
    values = np.repeat(distances[:, None], 3, axis=1)
    drawn = render([Solid(own, values)], towards, px=px, shaded=False)
    return DistanceMap(distances, np.where(np.isfinite(drawn.depth), drawn.rgb[..., 0], np.nan), px)


def distance_view(known: DistanceMap, side: str, top: float, limit: float) -> View:
    """A map of distances with its scale, and their histogram."""
    canvas = Canvas(VIEW + _CHART, VIEW)
    put_view(canvas, coloured(known.seen, top), known.px)
    high = max(top, 0.2)
    counts, edges = np.histogram(np.minimum(known.distances, high), 60, (0, high))
    chart = Chart((VIEW, 20, _CHART, 300), (0, high), (0, 1.1 * counts.max()))
    chart.frame(canvas, "nodes", "distance (mm)")
    chart.bars(canvas, edges, counts, SKY)
    if limit <= high:
        chart.upright(canvas, limit, VERMILLION, dash=(6, 4))
    x, _, width, _ = chart.area
    colour_ramp(canvas, x, 360, round(width), top)
    d = known.distances
    line = f"{side.capitalize()} side: mean {d.mean():.2f} mm, std {d.std():.2f} mm, max {d.max():.2f} mm; "
    return View(canvas.array(), line + f"{100 * (d <= limit).mean():.0f} % of the nodes lie within {limit:g} mm.")
