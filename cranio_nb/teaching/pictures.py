"""Pictures of the lessons: slices, curves and meshes on matplotlib axes, and pictures that carry a description.

Frames: slices (row, col) px of one plane of the scan, drawn in mm; meshes in world mm (LPS). Pictures of a head have
the letters of the patient's sides and a scale bar; what is drawn by `show_mask` and `show_errors` is named by `key`.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..drawing import figures, paper_figures
from ..drawing.coarse_skull import skull_surface
from ..drawing.described import described
from ..drawing.palette import (
    BLACK,
    BLUE,
    BONE,
    GREEN,
    MIDDLE_GREY,
    ORANGE,
    PATCH,
    PURPLE,
    SKULL,
    TRUTH,
    VERMILLION,
    faded,
    rgb_shares,
)
from ..drawing.scene3d import show_meshes as show_scene
from ..drawing.shading import Solid
from ..mesh import Mesh
from ..volume import Volume

if TYPE_CHECKING:
    from ..drawing.figures import Axes, Figure

__all__ = [
    "BLACK",
    "BLUE",
    "BONE",
    "GREEN",
    "LINES",
    "MASKS",
    "MIDDLE_GREY",
    "SKULL",
    "axes",
    "key",
    "name_sides",
    "paper_figures",
    "picture",
    "plot_lines",
    "scene",
    "show_curve",
    "show_errors",
    "show_hu",
    "show_mask",
    "show_meshes",
    "show_points",
    "skull_surface",
    "slices",
]

LINES = ((BLUE, "-"), (VERMILLION, "--"), (GREEN, "-."), (PURPLE, ":"), (BLACK, "-"), (MIDDLE_GREY, "--"))
"""Colour and style of the first, second, ... curve of a picture: told apart without colour as well."""

MASKS = {
    "bone": (BONE, "bone"),
    "patch": (PATCH, "patch"),
    "between": (faded(PATCH), "between the curves"),
    "right": (PATCH, "patch on missing bone"),
    "missing": (TRUTH, "missing bone, no patch"),
    "extra": (BLUE, "patch, no missing bone"),
    "filled": (GREEN, "holes filled"),
    "dropped": (ORANGE, "dropped"),
}
"""Colour of a mask by what it means, and its name in the key."""

key = figures.key
"""Say below a figure what its colours and lines mean."""

name_sides = figures.name_sides
"""Write the letters of the patient's sides at the edges of a picture."""

scene = show_scene
"""Meshes to turn, each in a colour or coloured by numbers at its vertices; see `scene3d.show_meshes`."""

picture = described
"""A figure with its description and its line of numbers: the last line of a cell."""


def axes(n: int = 1, *, height: float = 3.4, width: float = 9.0) -> tuple[Figure, list[Axes]]:
    """A figure with axes side by side.

    Parameters
    ----------
    n : int
        Number of axes.
    height, width : float
        Of the whole figure, inches.

    Returns
    -------
    figure : Figure
    axes : list of Axes
        From left to right.

    Examples
    --------
    >>> figure, (left, right) = axes(2)
    >>> figure.get_size_inches().tolist()
    [9.0, 3.4]
    """
    # without pyplot: no global state, no window
    figure, _ = figures.new_figure(width, height)
    figure.clear()
    figure.set_layout_engine("constrained")
    return figure, list(figure.subplots(1, n, squeeze=False)[0])


def slices(
    n: int,
    scan: Volume,
    *,
    around: Iterable[ArrayLike] = (),
    margin_mm: float = 15.0,
    height: float = 3.4,
    width: float = 9.0,
) -> tuple[Figure, list[Axes]]:
    """A figure with axes side by side for slices of a head: in mm, with the patient's sides and a scale bar.

    Parameters
    ----------
    n : int
        Number of axes.
    scan : Volume
        What the slices are of: its geometry counts.
    around : iterable of array_like, shape (n, 2)
        (row, col) px: only what lies near them is shown; without them the whole slice.
    margin_mm : float
        Shown around them.
    height, width : float
        Of the whole figure, inches.

    Returns
    -------
    figure : Figure
    axes : list of Axes
        From left to right.

    Examples
    --------
    >>> figure, (ax,) = slices(1, Volume(np.zeros((4, 60, 40), bool), np.diag([3.0, 0.5, 0.5, 1.0])))
    >>> [round(float(limit), 2) for limit in ax.get_xlim()], [text.get_text() for text in ax.texts]
    ([-0.25, 19.75], ['S', 'I', 'A', 'P', '5 mm'])
    """
    figure, every = axes(n, height=height, width=width)
    seen = list(around)
    for ax in every:
        figures.slice_panel(ax, scan, around=seen, margin_mm=margin_mm)
    return figure, every


def show_hu(ax: Axes, hu: NDArray, *, px: float, centre: float = 300.0, width: float = 2000.0, title: str = "") -> None:
    """Draw a slice of HU in greys.

    Parameters
    ----------
    ax : Axes
        Of `slices`, or any in mm.
    hu : ndarray, shape (R, C)
    px : float
        Size of a pixel, mm.
    centre, width : float
        Grey window, HU: black below centre - width / 2, white above centre + width / 2.
    title : str
    """
    low, high = centre - width / 2, centre + width / 2
    ax.imshow(hu, cmap="gray", vmin=low, vmax=high, extent=_extent(hu.shape, px), interpolation="nearest")
    _label(ax, title)


def show_mask(ax: Axes, mask: NDArray[np.bool_], *, px: float, meaning: str = "bone", title: str = "") -> None:
    """Draw a mask in the colour of its meaning over what is there.

    Parameters
    ----------
    ax : Axes
        Of `slices`, or any in mm.
    mask : ndarray of bool, shape (R, C)
    px : float
        Size of a pixel, mm.
    meaning : str
        A key of `MASKS`.
    title : str
    """
    colour, name = MASKS[meaning]
    figures.fill_mask(ax, mask, _extent(mask.shape, px), colour)
    ax.fill([], [], color=colour, label=name)
    _label(ax, title)


def show_errors(
    ax: Axes, patch: NDArray[np.bool_], missing: NDArray[np.bool_], bone: NDArray[np.bool_], *, px: float, title: str
) -> None:
    """Draw a patch over the bone that is missing: what is right, what is left open, what is too much.

    Parameters
    ----------
    ax : Axes
        Of `slices`.
    patch, missing, bone : ndarray of bool, shape (R, C)
    px : float
        Size of a pixel, mm.
    title : str
    """
    parts = {"bone": bone, "right": patch & missing, "missing": missing & ~patch, "extra": patch & ~missing}
    for meaning, mask in parts.items():
        show_mask(ax, mask, px=px, meaning=meaning, title=title)


def show_points(ax: Axes, points: ArrayLike, *, px: float, colour: str, marker: str = ".", label: str = "") -> None:
    """Draw points on a slice.

    Parameters
    ----------
    ax : Axes
    points : array_like, shape (n, 2)
        (row, col) px.
    px : float
        Size of a pixel, mm.
    colour : str
        "#RRGGBB".
    marker : str
        As in matplotlib.
    label : str
        Name in the legend.
    """
    row, col = np.asarray(points, float).reshape(-1, 2).T * px
    ax.plot(col, row, ls="none", marker=marker, ms=3 if marker == "." else 6, color=colour)
    if label:  # large enough to be seen in the key
        ax.plot([], [], ls="none", marker=marker, ms=9 if marker == "." else 6, color=colour, label=label)


def show_curve(ax: Axes, points: ArrayLike, *, px: float, line: int = 0, label: str = "") -> None:
    """Draw a curve on a slice.

    Parameters
    ----------
    ax, points, px, label
        As for `show_points`.
    line : int
        Index into `LINES`, for colour and style.
    """
    row, col = np.asarray(points, float).reshape(-1, 2).T * px
    colour, style = LINES[line]
    ax.plot(col, row, ls=style, lw=1.8, color=colour, label=label or None)


def plot_lines(ax: Axes, x: ArrayLike, ys: dict[str, ArrayLike], *, xlabel: str, ylabel: str, title: str = "") -> None:
    """Draw named curves over the same x, with a legend, in colours and styles that all can tell apart.

    Parameters
    ----------
    ax : Axes
    x : array_like, shape (n,)
    ys : dict of str to array_like, shape (n,)
        Curves by name; at most as many as there are `LINES`.
    xlabel, ylabel, title : str
    """
    for (name, y), (colour, style) in zip(ys.items(), LINES, strict=False):
        ax.plot(x, y, color=colour, ls=style, label=name)
    ax.set(xlabel=xlabel, ylabel=ylabel, title=title)
    ax.grid(alpha=0.3)
    ax.legend(fontsize=8)


def show_meshes(
    ax: Axes,
    parts: Iterable[tuple[Mesh, str | NDArray[np.float64]]],
    towards: ArrayLike,
    *,
    title: str,
    px: float = 1.0,
    shaded: bool = True,
) -> None:
    """Draw meshes, seen from a direction, with the patient's sides and a scale bar.

    Parameters
    ----------
    ax : Axes
    parts : iterable of (Mesh, colour)
        The colour is "#RRGGBB", or RGB from 0 to 1 for each vertex, shape (V, 3).
    towards : array_like, shape (3,)
        From the meshes to the viewer, LPS.
    title : str
    px : float
        Size of a pixel of the picture, mm.
    shaded : bool
        Whether light falls on them; False for colours that mean numbers.
    """
    solids = [Solid(mesh, rgb_shares(colour) if isinstance(colour, str) else colour) for mesh, colour in parts]
    figures.view_panel(ax, solids, towards, px_mm=px, shaded=shaded, title=title)
    figures.one_scale([ax])


def _extent(shape: tuple[int, ...], px: float) -> tuple[float, float, float, float]:
    """Left, right, bottom and top of a slice in mm, pixel (0, 0) centred at 0."""
    rows, cols = shape
    return (-0.5 * px, (cols - 0.5) * px, (rows - 0.5) * px, -0.5 * px)


def _label(ax: Axes, title: str) -> None:
    if title:
        figures.name_panel(ax, title)
