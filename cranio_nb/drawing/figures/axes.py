"""Figures with one axis, and what every picture has: scale bar, letters, masks, colour scale.

The only importer of matplotlib, which it loads with the first figure; figures are made without any global state.
"""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..palette import BLACK, WHITE, rgb_shares, side_letter

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure
    from matplotlib.patheffects import AbstractPathEffect

DPI = 110


def __getattr__(name: str) -> Any:
    """The two types that callers name, loaded when they are asked for."""
    if name == "Axes":
        from matplotlib.axes import Axes

        return Axes
    if name == "Figure":
        from matplotlib.figure import Figure

        return Figure
    raise AttributeError(f"{__name__} has no {name}")


def new_figure(width_in: float, height_in: float) -> tuple[Figure, Axes]:
    """A figure that is one empty axis.

    Parameters
    ----------
    width_in, height_in : float
        Inches.

    Returns
    -------
    Figure
    Axes
        Without frame and ticks, over all of the figure.

    Examples
    --------
    >>> figure, ax = new_figure(3.0, 2.0)
    >>> ax.get_window_extent().size.tolist()
    [330.0, 220.0]
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width_in, height_in), dpi=DPI)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    return figure, axes


def laid_out_figure(width_in: float, height_in: float) -> Figure:
    """An empty figure that makes room for the labels of the axes that it gets.

    Parameters
    ----------
    width_in, height_in : float
        Inches.

    Returns
    -------
    Figure
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width_in, height_in), dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def png(figure: Figure) -> bytes:
    """A figure as PNG.

    Parameters
    ----------
    figure : Figure

    Returns
    -------
    bytes
        The same for equal figures.

    Examples
    --------
    >>> png(new_figure(1.0, 1.0)[0])[1:4]
    b'PNG'
    """
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=figure.dpi, metadata={"Software": None})
    return stream.getvalue()


def scale_bar(ax: Axes, length: float, label: str | None = None, *, colour: str = BLACK) -> None:
    """Draw a scale bar in the lower left corner, with a rim to be seen on any ground, once the axis has its limits.

    Parameters
    ----------
    ax : Axes
    length : float
        In units of the axis.
    label : str, optional
        Its length in words; by default `length` in mm.
    colour : str
    """
    # axes may run either way: the bar follows x
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    x, y = x0 + 0.03 * (x1 - x0), y0 + 0.03 * (y1 - y0)
    step = length * np.sign(x1 - x0)
    bar = ax.plot([x, x + step], [y, y], color=colour, lw=3, solid_capstyle="butt", zorder=6)[0]
    bar.set_path_effects(rim(colour, 6.0))
    text, style = f"{length:g} mm" if label is None else label, {"va": "bottom", "path_effects": rim(colour)}
    ax.text(x, y + 0.02 * (y1 - y0), text, style, color=colour, fontsize=8, ha="left", zorder=6)


def name_sides(ax: Axes, right_down: NDArray[np.float64], *, colour: str = BLACK) -> None:
    """Write the letters of the patient's sides at the four edges of a view, each with a rim to be read on any ground.

    Parameters
    ----------
    ax : Axes
    right_down : ndarray, shape (2 or more, 3)
        World directions (LPS) to the right and down in the picture.
    colour : str
    """
    right, down = right_down[:2]
    # each letter at its edge, turned inwards
    edges = ((0.985, 0.5, right), (0.015, 0.5, -right), (0.5, 0.985, -down), (0.5, 0.015, down))
    for x, y, direction in edges:
        across = "center" if x == 0.5 else "right" if x > 0.5 else "left"
        along = "center" if y == 0.5 else "top" if y > 0.5 else "bottom"
        style = {"ha": across, "va": along, "color": colour, "path_effects": rim(colour), "zorder": 6}
        ax.text(x, y, side_letter(direction), style, transform=ax.transAxes, fontsize=9, weight="bold")


def rim(colour: str, width: float = 2.5) -> list[AbstractPathEffect]:
    """An edge around lines and letters, to be seen on any ground.

    Parameters
    ----------
    colour : str
        Of the lines.
    width : float
        Of lines and edge together, points.

    Returns
    -------
    list of AbstractPathEffect
        Black around white lines, white around others.
    """
    from matplotlib.patheffects import withStroke

    return [withStroke(linewidth=width, foreground=BLACK if colour == WHITE else WHITE)]


def ring_place(ax: Axes, x: float, y: float) -> None:
    """Draw a ring around a place, dark with a light edge, so that it is seen on any ground.

    Parameters
    ----------
    ax : Axes
    x, y : float
        In units of the axis.
    """
    for colour, width in ((WHITE, 3.6), (BLACK, 1.6)):
        ax.plot([x], [y], ls="none", marker="o", ms=15, mfc="none", mec=colour, mew=width)


def fill_mask(
    ax: Axes, mask: NDArray[np.bool_], extent: tuple[float, float, float, float], colour: str, *, alpha: float = 1.0
) -> None:
    """Show a mask in one colour, clear elsewhere.

    Parameters
    ----------
    ax : Axes
    mask : ndarray of bool, shape (R, C)
    extent : tuple of float
        Left, right, bottom and top edge of the mask, in units of the axis.
    colour : str
        "#RRGGBB".
    alpha : float
        0 clear to 1 opaque.
    """
    # opacity 0 where the mask is false
    rgba = np.zeros((*mask.shape, 4))
    rgba[mask] = (*rgb_shares(colour), alpha)
    ax.imshow(rgba, extent=extent, interpolation="nearest")


def show_pixels(rgb: NDArray[np.floating] | NDArray[np.uint8]) -> tuple[Figure, Axes]:
    """Show pixels, one for one.

    Parameters
    ----------
    rgb : ndarray, shape (H, W, 3)
        0 to 1, or uint8.

    Returns
    -------
    Figure
    Axes
        In pixels: x to the right, y down.

    Examples
    --------
    >>> figure, _ = show_pixels(np.ones((55, 110, 3)))
    >>> figure.get_size_inches().tolist()
    [1.0, 0.5]
    """
    height, width = rgb.shape[:2]
    figure, ax = new_figure(width / DPI, height / DPI)
    ax.imshow(rgb, interpolation="nearest", aspect="auto")
    return figure, ax


def colour_scale(top: float) -> ScalarMappable:
    """The colours of numbers from 0 to `top`: cividis, which reads the same for the colour-blind.

    Parameters
    ----------
    top : float
        Number at the yellow end, e.g. a distance in mm.

    Returns
    -------
    ScalarMappable
        Its `to_rgba` turns numbers into red, green, blue and 1.

    Examples
    --------
    >>> colour_scale(2.0).to_rgba([0.0, 2.0, 9.0]).round(1).tolist()
    [[0.0, 0.1, 0.3, 1.0], [1.0, 0.9, 0.2, 1.0], [1.0, 0.9, 0.2, 1.0]]
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    return ScalarMappable(Normalize(0.0, top), "cividis")


def colour_bar_figure(top_mm: float, label: str) -> Figure:
    """The scale of distance maps.

    Parameters
    ----------
    top_mm : float
        Distance at its upper end.
    label : str
        What the colours mean, with the unit.

    Returns
    -------
    Figure
    """
    figure, axes = new_figure(3.6, 0.62)
    axes.set_axis_on()
    axes.set_position((0.05, 0.62, 0.9, 0.26))
    bar = figure.colorbar(colour_scale(top_mm), cax=axes, orientation="horizontal", extend="max")
    bar.ax.tick_params(labelsize=8)
    bar.set_label(label, fontsize=8)
    return figure
