"""Designs -> figures: slices with their curves, outlines, shaded views, distance maps.

Every picture has a scale bar in mm; lines that cross differ in style as well as in colour. `axes` is the only importer
of matplotlib, which the first figure loads, and no figure touches any global state.
"""

from typing import TYPE_CHECKING, Any

from . import axes
from .axes import (
    DPI,
    colour_bar_figure,
    colour_scale,
    fill_mask,
    laid_out_figure,
    name_sides,
    new_figure,
    png,
    ring_place,
    scale_bar,
)
from .cuts import CUTS, cut_figure
from .effects import Panel, effects_figure, pair_figure
from .outlines import line_style, outlines_figure
from .panels import (
    key,
    mark_zoom,
    name_panel,
    one_scale,
    outline,
    paint,
    panel_figure,
    plot_points,
    show_ct,
    slice_panel,
    view_panel,
)
from .slices import draw_curves, draw_slice, show_areas, show_frame, slice_figure
from .views import SkullView, distance_figure, skull_view, view_figure, views_of

if TYPE_CHECKING:
    from .axes import Axes, Figure

__all__ = [
    "CUTS",
    "DPI",
    "Axes",
    "Figure",
    "Panel",
    "SkullView",
    "colour_bar_figure",
    "colour_scale",
    "cut_figure",
    "distance_figure",
    "draw_curves",
    "draw_slice",
    "effects_figure",
    "fill_mask",
    "key",
    "laid_out_figure",
    "line_style",
    "mark_zoom",
    "name_panel",
    "name_sides",
    "new_figure",
    "one_scale",
    "outline",
    "outlines_figure",
    "paint",
    "pair_figure",
    "panel_figure",
    "plot_points",
    "png",
    "ring_place",
    "scale_bar",
    "show_areas",
    "show_ct",
    "show_frame",
    "skull_view",
    "slice_figure",
    "slice_panel",
    "view_figure",
    "view_panel",
    "views_of",
]


def __getattr__(name: str) -> Any:
    """The two types, which load matplotlib when they are asked for."""
    return getattr(axes, name)
