"""Several pictures of one head in a figure: sides and scale of a slice, letters (a), (b), ..., zooms, one key for all.

Frames: slices of a scan in mm along columns (x) and rows (y, down) with voxel (row 0, column 0) at 0; surfaces in mm
along the view's axes to the right and down.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...volume import Volume
from ..canvas import round_length
from ..palette import BLACK, MIDDLE_GREY
from ..shading import Picture, Solid, render, view_axes
from .axes import fill_mask, laid_out_figure, name_sides, rim, scale_bar

if TYPE_CHECKING:
    from .axes import Axes, Figure

_SMALL_PT = 9.0
_BAR_SHARE = 0.3  # most of a picture's width that a scale bar takes
_RIM_SHARE = 0.12  # left free around a surface, of its larger extent
ZOOM_FRAME = "frame of a zoom"
"""Group of the lines that `mark_zoom` draws around what a zoom shows."""
_GREY_HU = (-700.0, 1300.0)  # black and white of a slice of CT


def panel_figure(
    layout: Sequence[Sequence[str]], width_in: float, height_in: float, *, widths: Sequence[float] | None = None
) -> tuple[Figure, dict[str, Axes]]:
    """A figure with panels.

    Parameters
    ----------
    layout : sequence of sequences of str
        Rows of names; a name that comes twice is one larger panel.
    width_in, height_in : float
        Inches.
    widths : sequence of float, optional
        Of the columns, relative to each other.

    Returns
    -------
    Figure
    dict of str to Axes
        Panels by name, without ticks.

    Examples
    --------
    >>> figure, panels = panel_figure([["a", "b"], ["a", "c"]], 8.0, 4.0)
    >>> list(panels)
    ['a', 'b', 'c']
    """
    figure = laid_out_figure(width_in, height_in)
    panels = figure.subplot_mosaic([list(row) for row in layout], width_ratios=widths)
    for ax in panels.values():
        ax.set(xticks=[], yticks=[])
        ax.spines[:].set_color(MIDDLE_GREY)
    return figure, panels


def name_panel(ax: Axes, title: str) -> None:
    """Write a title above the left edge of a panel.

    Parameters
    ----------
    ax : Axes
    title : str
        E.g. "(a) bone".
    """
    ax.set_title(title, loc="left", fontsize=_SMALL_PT)
    # at the top of its place: room for a title is measured there, also where a picture is lower than its place
    ax.set_anchor("N")


def slice_panel(
    ax: Axes, scan: Volume, *, around: Iterable[ArrayLike] = (), margin_mm: float = 15.0, title: str = ""
) -> None:
    """Make a panel show a slice of a scan: its limits in mm, the letters of the patient's sides, a scale bar.

    Parameters
    ----------
    ax : Axes
    scan : Volume
        Its geometry counts.
    around : iterable of array_like, shape (n, 2)
        (row, col) px: only what lies near them is shown; without them the whole slice.
    margin_mm : float
        Shown around them.
    title : str
    """
    # rows run down: the lower limit of y is the larger one
    step = scan.spacing[1:]
    points = [np.asarray(one, float).reshape(-1, 2) for one in around if np.size(one)]
    whole = np.array([[-0.5, -0.5], np.array(scan.shape[1:]) - 0.5]) * step
    seen = np.concatenate(points) * step if points else whole
    margin = margin_mm if points else 0.0
    (top, left), (bottom, right) = seen.min(axis=0) - margin, seen.max(axis=0) + margin
    ax.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", xticks=[], yticks=[])
    name_sides(ax, scan.edges[[2, 1]])
    scale_bar(ax, round_length(_BAR_SHARE * (right - left)))
    name_panel(ax, title)


def slice_extent(scan: Volume) -> tuple[float, float, float, float]:
    """Edges of a slice in a `slice_panel`.

    Parameters
    ----------
    scan : Volume

    Returns
    -------
    tuple of float
        Left, right, bottom and top, mm.

    Examples
    --------
    >>> slice_extent(Volume(np.zeros((2, 10, 20), bool), np.diag([3, 0.5, 0.5, 1])))
    (-0.25, 9.75, 4.75, -0.25)
    """
    (_, rows, cols), (_, row_mm, col_mm) = scan.shape, scan.spacing.tolist()
    return -0.5 * col_mm, (cols - 0.5) * col_mm, (rows - 0.5) * row_mm, -0.5 * row_mm


def paint(
    ax: Axes, mask: NDArray[np.bool_], scan: Volume, colour: str, *, label: str | None = None, alpha: float = 1.0
) -> None:
    """Paint a mask of one slice.

    Parameters
    ----------
    ax : Axes
        A `slice_panel`.
    mask : ndarray of bool, shape (R, C)
    scan : Volume
        Its geometry counts.
    colour : str
        "#RRGGBB".
    label : str, optional
        Name in the key.
    alpha : float
        0 clear to 1 opaque.
    """
    fill_mask(ax, mask, slice_extent(scan), colour, alpha=alpha)
    if label:
        ax.fill([], [], color=colour, alpha=alpha, label=label)


def outline(ax: Axes, mask: NDArray[np.bool_], scan: Volume, colour: str, *, label: str | None = None) -> None:
    """Draw the outline of a mask of one slice.

    Parameters
    ----------
    ax, mask, scan, colour, label
        As for `paint`.
    """
    if mask.any():
        rows, cols = (np.arange(n) * step for n, step in zip(mask.shape, scan.spacing[1:], strict=True))
        ax.contour(cols, rows, mask, levels=[0.5], colors=[colour], linewidths=1.6)
    if label:
        ax.plot([], [], color=colour, lw=1.6, label=label)


def plot_points(ax: Axes, points: NDArray[np.floating], scan: Volume, **style: Any) -> None:
    """Plot points of a slice.

    Parameters
    ----------
    ax : Axes
        A `slice_panel`.
    points : ndarray, shape (n, 2)
        (row, col) px.
    scan : Volume
        Its geometry counts.
    **style
        As for matplotlib's ``plot``.
    """
    ax.plot(*(points * scan.spacing[1:]).T[::-1], **style)


def show_ct(ax: Axes, ct: Volume, plane: int) -> None:
    """Show a slice of CT in greys.

    Parameters
    ----------
    ax : Axes
        A `slice_panel`.
    ct : Volume
        HU.
    plane : int
    """
    black, white = _GREY_HU
    ax.imshow(ct.voxels[plane], cmap="gray", vmin=black, vmax=white, extent=slice_extent(ct), interpolation="nearest")


def view_panel(
    ax: Axes, solids: Sequence[Solid], towards: ArrayLike, *, px_mm: float, shaded: bool = True, title: str = ""
) -> Picture:
    """Show surfaces in a panel, with the letters of the patient's sides.

    Parameters
    ----------
    ax : Axes
    solids : sequence of Solid
    towards : array_like, shape (3,)
        From the head to the viewer, LPS.
    px_mm : float
        Size of a pixel.
    shaded : bool
        Whether light falls on them; False for colours that mean numbers.
    title : str

    Returns
    -------
    Picture
    """
    picture = render(solids, towards, px_mm=px_mm, shaded=shaded)
    rows, cols = picture.depth.shape
    left, top = picture.frame.corner
    right, bottom = left + cols * px_mm, top + rows * px_mm
    free = _RIM_SHARE * max(right - left, bottom - top)
    ax.imshow(picture.rgb, extent=(left, right, bottom, top))
    ax.set(xlim=(left - free, right + free), ylim=(bottom + free, top - free))
    ax.set_axis_off()
    name_sides(ax, view_axes(towards))
    name_panel(ax, title)
    return picture


def one_scale(panels: Sequence[Axes]) -> None:
    """Give panels with surfaces the same mm across and down, and each its scale bar.

    Parameters
    ----------
    panels : sequence of Axes
        Each a `view_panel`.
    """
    limits = [np.array([ax.get_xlim(), ax.get_ylim()]) for ax in panels]
    wide, high = np.abs(np.diff(limits, axis=2)).max(axis=0).ravel() / 2
    for ax, ((left, right), (bottom, top)) in zip(panels, limits, strict=True):
        x, y = (left + right) / 2, (bottom + top) / 2
        ax.set(xlim=(x - wide, x + wide), ylim=(y + high, y - high))
        scale_bar(ax, round_length(_BAR_SHARE * 2 * wide))


def mark_zoom(ax: Axes, zoomed: Axes) -> None:
    """Frame in a panel what another one shows, with lines that lead there.

    Parameters
    ----------
    ax : Axes
        The panel that shows more.
    zoomed : Axes
        With its limits, in the same unit; to the right of the other panel, or below it.
    """
    (left, right), (bottom, top) = zoomed.get_xlim(), zoomed.get_ylim()
    x, y = [left, right, right, left, left], [bottom, bottom, top, top, bottom]
    ax.plot(x, y, color=BLACK, lw=1.3, zorder=5, path_effects=rim(BLACK, 3.5), gid=ZOOM_FRAME)
    zoomed.spines[:].set(color=BLACK, linewidth=1.3)
    # from the frame's side that looks to the zoom to the zoom's side that looks back
    if zoomed.get_position().x0 >= ax.get_position().x1:
        leads = (((right, top), (0, 1)), ((right, bottom), (0, 0)))
    else:
        leads = (((left, bottom), (0, 1)), ((right, bottom), (1, 1)))
    line = {"arrowstyle": "-", "color": BLACK, "lw": 0.8, "shrinkA": 0, "shrinkB": 0, "path_effects": rim(BLACK)}
    for start, end in leads:
        lead = ax.annotate("", end, start, xycoords=zoomed.transAxes, textcoords="data", arrowprops=line)
        lead.set(annotation_clip=False, zorder=5)
        lead.set_in_layout(False)


def key(figure: Figure, *, columns: int = 4) -> None:
    """Write below a figure what its colours and lines mean: everything that was drawn with a label, once.

    Parameters
    ----------
    figure : Figure
    columns : int
        Most entries in a row.
    """
    named = [ax.get_legend_handles_labels() for ax in figure.axes]
    entries = {label: handle for handles, labels in named for handle, label in zip(handles, labels, strict=True)}
    style = {"fontsize": _SMALL_PT, "frameon": False, "ncols": min(columns, len(entries))}
    figure.legend(list(entries.values()), list(entries), loc="outside lower center", **style)
