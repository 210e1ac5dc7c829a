"""Designs -> figures: slices with their curves, outlines, shaded views, distance maps.

Every picture has a scale bar in mm; lines that cross differ in style as well as in colour. `axes` is the only importer
of matplotlib, and no figure touches any global state.
"""

from .axes import DPI, Axes, Figure, colour_bar_figure, colour_scale, new_figure, png, ring_place, scale_bar
from .cuts import CUTS, cut_figure
from .effects import Panel, effects_figure, pair_figure
from .outlines import line_style, outlines_figure
from .slices import draw_slice, slice_figure
from .views import distance_figure, view_figure, views_of

__all__ = [
    "CUTS",
    "DPI",
    "Axes",
    "Figure",
    "Panel",
    "colour_bar_figure",
    "colour_scale",
    "cut_figure",
    "distance_figure",
    "draw_slice",
    "effects_figure",
    "line_style",
    "new_figure",
    "outlines_figure",
    "pair_figure",
    "png",
    "ring_place",
    "scale_bar",
    "slice_figure",
    "view_figure",
    "views_of",
]
