"""Designs -> pictures: slices with their curves, shaded views, distance maps. The only importer of matplotlib.

Colours are those of Okabe and Ito, told apart by the colour-blind; lines differ in style as well. Every picture has a
scale bar in mm. Functions take an axis and draw on it; `new_figure` makes one without any global state.
"""

from __future__ import annotations

import io
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from ..mesh import Mesh
from ..methods.slicewise import SlicedDesign, SliceResult
from ..stages import feature_extraction
from ..vault import slicing
from ..volume import Volume
from .shading import Picture, Solid, render, view_axes

BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
YELLOW, BLUE, VERMILLION, PURPLE = "#F0E442", "#0072B2", "#D55E00", "#CC79A7"
BONE, GREY = "#D8D2C4", "#6B6B6B"
OUTER_COLOUR, INNER_COLOUR = BLUE, VERMILLION
_COLOURS = (OUTER_COLOUR, INNER_COLOUR)
DPI = 110

SIDES = {
    "from the left": (1.0, 0.0, 0.0),
    "from the right": (-1.0, 0.0, 0.0),
    "from the front": (0.0, -1.0, 0.0),
    "from the back": (0.0, 1.0, 0.0),
    "from above": (0.0, 0.0, 1.0),
}
"""Directions from the head to the viewer, LPS."""

_LINE_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, BLACK, ORANGE, GREY)
_DASHES: tuple[tuple[float, ...], ...] = (
    (),
    (6.0, 2.0),
    (6.0, 1.5, 1.5, 1.5),
    (2.0, 1.2),
    (1.0, 1.5),
    (9.0, 1.5),
    (3.0, 1.0, 1.0, 1.0, 1.0, 1.0),
)

_LETTERS = (("R", "L"), ("A", "P"), ("I", "S"))  # negative and positive end of each world axis
_RIM = 14  # px left free around a view
_PIXEL = 0.35  # mm of a slice's picture
_AROUND = 12.0  # mm of slice shown around the curves


def new_figure(width: float, height: float) -> tuple[Figure, Axes]:
    """A figure of given inches, all of it one empty axis, without touching any global state."""
    figure = Figure(figsize=(width, height), dpi=DPI)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    return figure, axes


def png(figure: Figure) -> bytes:
    """A figure as PNG."""
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=figure.dpi, metadata={"Software": None})
    return stream.getvalue()


def scale_bar(ax: Axes, length: float, label: str | None = None, *, colour: str = BLACK) -> None:
    """Draw a bar of `length` data units in the lower left corner; the label says its length in mm.

    Call it last, when the limits of the axis are set.
    """
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    x, y = x0 + 0.03 * (x1 - x0), y0 + 0.03 * (y1 - y0)
    step = length * np.sign(x1 - x0)
    ax.plot([x, x + step], [y, y], color=colour, lw=3, solid_capstyle="butt")
    text = f"{length:g} mm" if label is None else label
    ax.text(x, y + 0.02 * (y1 - y0), text, color=colour, fontsize=8, va="bottom", ha="left")


def draw_slice(
    ax: Axes, sliced: SlicedDesign, result: SliceResult, bone: Volume, patch: Volume | None, *, skeleton: bool = False
) -> None:
    """Draw a slice of a design: bone, its boundaries, ends, tangents, start and final curves, patch.

    Parameters
    ----------
    ax : Axes
        Will be in mm along columns and rows of the slice.
    sliced : SlicedDesign
    result : SliceResult
        One of ``sliced.slices``.
    bone, patch : Volume
        Bool masks.
    skeleton : bool
        Boundaries by skeleton and hull, as the paper takes them; otherwise by their distance from the head's centre.
    """
    unit, frame = sliced.unit, sliced.frames[result.plane]
    (left, right), (bottom, top) = _limits(ax, sliced)
    rows, cols = (np.arange(low, high, _PIXEL) for low, high in ((top, bottom), (left, right)))
    seen = slicing.picture(bone, frame, rows / unit, cols / unit)
    extent = (cols[0] - _PIXEL / 2, cols[-1] + _PIXEL / 2, rows[-1] + _PIXEL / 2, rows[0] - _PIXEL / 2)
    _fill(ax, seen, extent, BONE)
    if patch is not None:
        _fill(ax, slicing.picture(patch, frame, rows / unit, cols / unit), extent, SKY, alpha=0.55)
    edges = _skeleton_boundaries(bone, frame, unit) if skeleton else None
    for points, colour in zip(edges or _boundaries(seen, rows, cols, _centre(sliced, frame)), _COLOURS, strict=True):
        ax.plot(*points.T[::-1], ls="none", marker=".", ms=1.6, mew=0, color=colour)
    for curve, start, colour in zip(result.curves, _starts(result), _COLOURS, strict=False):
        if len(start):
            ax.plot(*unit * start.T[::-1], color=colour, ls=(0, (4, 2)), lw=1.1)
        ax.plot(*unit * curve.T[::-1], color=colour, ls="-", lw=1.8)
    for ends in result.ends:
        _draw_ends(ax, unit * ends.points, ends.tangents)
    ax.set_xlim(left, right)
    ax.set_ylim(bottom, top)
    scale_bar(ax, 20.0)


def slice_figure(
    sliced: SlicedDesign, result: SliceResult, bone: Volume, patch: Volume | None, *, skeleton: bool = False
) -> Figure:
    """`draw_slice` on a new figure."""
    figure, ax = new_figure(3.4, 2.5)
    draw_slice(ax, sliced, result, bone, patch, skeleton=skeleton)
    return figure


def line_style(i: int) -> tuple[str, tuple[float, ...]]:
    """Colour and dashes (on, off, ... in line widths) of the i-th of several lines drawn over each other.

    Alone the dashes tell seven apart; with the colours it is 49 before one comes back.
    """
    n = len(_DASHES)
    return _LINE_COLOURS[i % n], _DASHES[(i + i // n) % n]


def outlines_figure(
    bone: Volume, truth: Volume | None, patches: Sequence[Volume], centre: ArrayLike, axes: ArrayLike, reach: float
) -> Figure:
    """A cut through several patches for one hole: bone and truth as areas, each patch as a line of its `line_style`.

    Parameters
    ----------
    bone, truth : Volume
        Bool masks.
    patches : sequence of Volume
        Bool masks.
    centre : array_like, shape (3,)
        Middle of the picture, world mm.
    axes : array_like, shape (2, 3)
        Unit vectors to the right and down in the picture, world.
    reach : float
        mm shown to the left and right of the centre; half as much above it, and as much below.
    """
    right, down = np.asarray(axes, float)
    frame = np.stack([np.asarray(centre, float), down, right])
    rows, cols = np.arange(-0.5 * reach, 0.7 * reach, _PIXEL), np.arange(-reach, reach, _PIXEL)
    extent = (cols[0], cols[-1], rows[-1], rows[0])
    figure, ax = new_figure(5.0, 5.0 * len(rows) / len(cols))
    for mask, colour in ((bone, BONE), (truth, SKY)):
        if mask is not None:
            _fill(ax, slicing.picture(mask, frame, rows, cols), extent, colour)
    for i, patch in enumerate(patches):
        colour, dashes = line_style(i)
        soft = ndimage.gaussian_filter(slicing.picture(patch, frame, rows, cols).astype(float), 1.0)
        if soft.max() > 0.5:
            style = (0, dashes) if dashes else "-"
            ax.contour(cols, rows, soft, levels=[0.5], colors=[colour], linestyles=[style], linewidths=1.4)
    ax.set_xlim(extent[:2])
    ax.set_ylim(extent[2:])
    _letters(ax, np.stack([right, down]))
    scale_bar(ax, 20.0)
    return figure


def _fill(
    ax: Axes, mask: NDArray[np.bool_], extent: tuple[float, float, float, float], colour: str, alpha: float = 1.0
) -> None:
    """Show a mask in one colour, clear elsewhere."""
    rgba = np.zeros((*mask.shape, 4))
    rgba[mask] = (*_rgb(colour), alpha)
    ax.imshow(rgba, extent=extent, interpolation="nearest")


def _starts(result: SliceResult) -> NDArray:
    return result.start if len(result.start) == len(result.curves) else np.empty((len(result.curves), 0, 2))


def _draw_ends(ax: Axes, points: NDArray, tangents: NDArray) -> None:
    """Gap ends (row, col) in mm as rings, their tangents as arrows of 12 mm."""
    for point, tangent in zip(points, tangents, strict=True):
        tip = point + 12.0 * tangent / np.linalg.norm(tangent)
        arrow = {"arrowstyle": "-|>", "color": GREEN, "lw": 1.3, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 8}
        ax.annotate("", xy=tip[::-1], xytext=point[::-1], arrowprops=arrow)
    ax.plot(*points.T[::-1], ls="none", marker="o", ms=4.5, mfc="white", mec=BLACK, mew=1.0)


def _centre(sliced: SlicedDesign, frame: NDArray[np.float64]) -> NDArray[np.float64]:
    """The head's centre in a slice, (row, col) in mm."""
    origin, row, col = frame
    away = sliced.opening.head_centre - origin
    return np.array([away @ axis / np.linalg.norm(axis) for axis in (row, col)])


def _skeleton_boundaries(
    bone: Volume, frame: NDArray[np.float64], unit: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Outer and inner boundary, (row, col) in mm, of a plane of the scan; None where it has no skeleton."""
    plane = round(float(bone.to_voxel(frame[0])[0]))
    try:
        seen = feature_extraction.extract_features(bone.voxels[plane])
    except feature_extraction.SliceProblem:
        return None
    return seen.outer * unit, seen.inner * unit


def _boundaries(
    bone: NDArray[np.bool_], rows: NDArray, cols: NDArray, centre: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Outer and inner boundary, (row, col) in mm, parted half-way between first and last bone along each ray."""
    index = np.argwhere(bone & ~ndimage.binary_erosion(bone, border_value=1))
    edge = np.column_stack([rows[index[:, 0]], cols[index[:, 1]]])
    radius = np.hypot(*(edge - centre).T)
    ray = np.round((np.arctan2(*(edge - centre).T) + np.pi) / 0.02).astype(int)
    high, low = np.full(ray.max(initial=0) + 1, -np.inf), np.full(ray.max(initial=0) + 1, np.inf)
    np.maximum.at(high, ray, radius)
    np.minimum.at(low, ray, radius)
    far = 2 * radius > high[ray] + low[ray]
    return edge[far], edge[~far]


def _limits(ax: Axes, sliced: SlicedDesign) -> tuple[tuple[float, float], tuple[float, float]]:
    """Limits of x and y in mm around the curves, the same for every slice of a design; rows run down.

    A balloon under too much pressure leaves any picture: what lies far from its gap is not followed.
    """
    curves = [np.clip(s.curves, *_reach(s)).reshape(-1, 2) for s in sliced.slices if s.curves.size]
    points = sliced.unit * np.concatenate(curves) if curves else _centre(sliced, sliced.frames[0])[None]
    low, high = points.min(axis=0) - _AROUND, points.max(axis=0) + _AROUND
    middle, half = (low + high) / 2, (high - low) / 2
    width, height = ax.get_window_extent().size
    half = np.maximum(half, [half[1] * height / width, half[0] * width / height])
    return (middle[1] - half[1], middle[1] + half[1]), (middle[0] + half[0], middle[0] - half[0])


def _reach(result: SliceResult) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Corners of the box around the ends of both curves that is as wide again on each side, shape (2,) each."""
    ends = result.curves[:, [0, -1]].reshape(-1, 2)
    low, high = ends.min(axis=0), ends.max(axis=0)
    return low - np.ptp(ends, axis=0).max(), high + np.ptp(ends, axis=0).max()


def views_of(directions: Sequence[ArrayLike]) -> dict[str, NDArray[np.float64]]:
    """Three directions to look from, by name: facing the largest opening, and two sides that show the openings.

    Parameters
    ----------
    directions : sequence of array_like, shape (3,)
        From the head's centre to each opening, LPS, the largest first.
    """
    towards = np.array(directions, float)
    views, seen = {"facing the opening": towards[0]}, towards @ towards[0]
    for _ in range(2):
        rest = {name: towards @ side for name, side in SIDES.items() if name not in views}
        # first the side that shows what is not yet seen well, then the one that shows most
        best = max(
            rest, key=lambda name: (np.clip(rest[name] - seen, 0, None).sum(), np.clip(rest[name], 0, None).sum())
        )
        views[best], seen = np.array(SIDES[best]), np.maximum(seen, rest[best])
    return views


def view_figure(skull: Mesh, prosthesis: Mesh, towards: ArrayLike, *, px: float = 0.6) -> Figure:
    """Skull and prosthesis, shaded, seen from a direction (from the head to the viewer, LPS)."""
    solids = [Solid(prosthesis, _rgb(BLUE))]
    if len(skull.faces):
        solids.insert(0, Solid(skull, _rgb("#EDE7D8")))
    picture = render(solids, towards, px=px)
    figure, ax = _show(picture)
    _letters(ax, view_axes(towards))
    scale_bar(ax, 50.0 / px, "50 mm")
    return figure


def distance_figure(
    whole: Mesh, surface: Mesh, distances: NDArray, towards: ArrayLike, top: float, *, px: float = 0.2
) -> Figure:
    """One side of a prosthesis, coloured by the distance of its nodes from the true surface; the rest is grey.

    Parameters
    ----------
    whole, surface : Mesh
        The prosthesis, and its side as an open surface.
    distances : ndarray, shape (V,)
        mm.
    towards : array_like, shape (3,)
        From the surface to the viewer, LPS.
    top : float
        mm at the upper end of the colour scale.
    """
    near = np.asarray(towards, float) / np.linalg.norm(towards) * 0.05  # mm: before the same faces of the whole
    coloured = Solid(Mesh(surface.vertices + near, surface.faces), colour_scale(top).to_rgba(distances)[:, :3])
    figure, ax = _show(render([Solid(whole, _rgb("#C9C9C9")), coloured], towards, px=px, shaded=False))
    _letters(ax, view_axes(towards))
    scale_bar(ax, 20.0 / px, "20 mm")
    return figure


def colour_scale(top: float) -> ScalarMappable:
    """Distances from 0 to `top` mm -> cividis, which reads the same for the colour-blind."""
    return ScalarMappable(Normalize(0.0, top), "cividis")


def colour_bar_figure(top: float, label: str) -> Figure:
    """The scale of distance maps."""
    figure = Figure(figsize=(3.6, 0.62), dpi=DPI)
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.05, 0.62, 0.9, 0.26))
    bar = figure.colorbar(colour_scale(top), cax=axes, orientation="horizontal", extend="max")
    bar.ax.tick_params(labelsize=8)
    bar.set_label(label, fontsize=8)
    return figure


def _show(picture: Picture) -> tuple[Figure, Axes]:
    """A rendered picture, one pixel for one, with a rim for letters and scale."""
    rgb = np.pad(picture.rgb, ((_RIM, 2 * _RIM), (_RIM, _RIM), (0, 0)), constant_values=1)
    height, width = rgb.shape[:2]
    figure, ax = new_figure(width / DPI, height / DPI)
    ax.imshow(rgb, interpolation="nearest", aspect="auto")
    return figure, ax


def _letters(ax: Axes, axes: NDArray[np.float64]) -> None:
    """Name the patient's sides at the edges of a view: L, R, A, P, S, I."""
    for x, y, direction in ((0.99, 0.5, axes[0]), (0.01, 0.5, -axes[0]), (0.5, 0.99, -axes[1])):
        axis = int(np.argmax(np.abs(direction)))
        letter = _LETTERS[axis][int(direction[axis] > 0)]
        across, up = {0.99: "right", 0.01: "left"}.get(x, "center"), "top" if y > 0.9 else "center"
        ax.text(x, y, letter, transform=ax.transAxes, ha=across, va=up, fontsize=9, color=GREY, weight="bold")


def _rgb(colour: str) -> NDArray[np.float64]:
    return np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255
