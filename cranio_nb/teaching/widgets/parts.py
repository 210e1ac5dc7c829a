"""What several panels draw: marks on a slice, the histogram of a CT, a shaded view, a scale of distances.

Frames: slices (row, col) px of the scan, the patient's left on the right; places on a canvas as (x, y) px.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...drawing.canvas import Canvas, round_length
from ...drawing.canvas_axes import Chart
from ...drawing.figures import colour_scale
from ...drawing.palette import COUNTS, GREY, side_letter
from ...drawing.pixels import RGB, Window
from ...drawing.shading import view_axes
from ...mesh import Mesh
from ...volume import Volume

WIDTH, HEIGHT = 660, 540
"""px of every panel's picture: with controls beside it, whole on a screen of 1366 x 768."""
LEFT = 420
"""px of its left part, which shows a slice or a surface."""
RIGHT = (LEFT + 4, 0, WIDTH - LEFT - 4, HEIGHT)
"""Box of its right part: x, y, width, height, px."""
HU_RANGE = (-1100.0, 2500.0)
"""HU that histograms show."""

_COLOURS = (colour_scale(1.0).to_rgba(np.linspace(0, 1, 256), bytes=True)[:, :3]).astype(np.uint8)
_MARGIN = 0.06  # around what a window shows, of its larger extent: room for letters

Histogram = tuple[NDArray, NDArray]


def left_window(shown: NDArray[np.bool_], width: int = LEFT) -> Window:
    """A window on the left part of a panel that holds what is shown of any slice, so that nothing jumps.

    Parameters
    ----------
    shown : ndarray of bool, shape (P, R, C)
        All of it where nothing is True.
    width : int
        px.

    Returns
    -------
    Window
    """
    seen = shown.any(axis=0) if shown.any() else np.ones(shown.shape[1:], bool)
    low, high = np.argwhere(seen).min(axis=0), np.argwhere(seen).max(axis=0)
    margin = _MARGIN * (high - low).max() + 1
    return Window.around((0, 0, width, HEIGHT), low - margin, high + margin)


def annotate_slice(canvas: Canvas, window: Window, grid: Volume, plane: int) -> None:
    """Write scale bar, sides of the patient and the number of the slice over an axial slice.

    Parameters
    ----------
    canvas : Canvas
    window : Window
        Where the slice is drawn.
    grid : Volume
        Gives the size of a pixel and where its rows and columns lead.
    plane : int
    """
    x, y, width, height = window.box
    px = float(grid.spacing[2])
    mm = round_length(0.2 * width / window.zoom * px)
    canvas.scale_bar(x + 14, y + height - 14, mm / px * window.zoom, f"{mm:g} mm")
    canvas.sides(window.box, *grid.edges[[2, 1]])
    canvas.text(x + width - 12, y + height - 14, f"slice {plane}", anchor="rs", halo=True)


def name_ends(canvas: Canvas, chart: Chart, right: ArrayLike) -> None:
    """Write the letters of the patient's sides at both ends of a chart's x axis.

    Parameters
    ----------
    canvas : Canvas
    chart : Chart
    right : array_like, shape (3,)
        Where the axis leads in the head, LPS.
    """
    x, y, width, height = chart.area
    for at, way in ((x + 10, -1), (x + width - 10, 1)):
        canvas.text(at, y + height - 12, side_letter(way * np.asarray(right, float)), size=14, anchor="mm", halo=True)


def count_hu(hu: NDArray, n: int = 120) -> Histogram:
    """Histogram of the HU of a slice or a scan, over `HU_RANGE`.

    Parameters
    ----------
    hu : ndarray, any shape
    n : int
        Number of bins.

    Returns
    -------
    edges : ndarray of float, shape (n + 1,)
        HU.
    counts : ndarray of int, shape (n,)
        Voxels.

    Examples
    --------
    >>> edges, counts = count_hu(np.array([0, 10, 1000, 9000]), n=2)
    >>> edges.tolist(), counts.tolist()
    ([-1100.0, 700.0, 2500.0], [2, 1])
    """
    counts, edges = np.histogram(hu, n, HU_RANGE)
    return edges, counts


def hu_chart(canvas: Canvas, box: tuple[float, float, float, float], histogram: Histogram, counted: str) -> Chart:
    """Draw a histogram of HU on logarithmic counts.

    Parameters
    ----------
    canvas : Canvas
    box : tuple of float
        x, y, width and height of the chart, px.
    histogram : tuple
        As `count_hu` gives it.
    counted : str
        What was counted, for the chart's title.

    Returns
    -------
    Chart
        To draw more into.
    """
    edges, counts = histogram
    chart = Chart(box, (edges[0], edges[-1]), (0.8, max(10.0, 1.5 * counts.max())), log=True)
    chart.frame(canvas, counted, "HU")
    chart.bars(canvas, edges, np.maximum(counts, 0.8), COUNTS)
    return chart


def coloured(distances: NDArray[np.float32], top: float) -> RGB:
    """Colours of a picture of distances, in the scale cividis.

    Parameters
    ----------
    distances : ndarray, shape (H, W)
        mm; nan where there is none.
    top : float
        Upper end of the scale, mm.

    Returns
    -------
    ndarray of uint8, shape (H, W, 3)
        White where there is no distance.

    Examples
    --------
    >>> coloured(np.array([[0.0, np.nan, 2.0, 9.0]], np.float32), 2.0)[0].tolist()
    [[0, 34, 77], [255, 255, 255], [253, 231, 55], [253, 231, 55]]
    """
    known = np.isfinite(distances)
    index = np.clip(np.where(known, distances, 0) * (255 / top), 0, 255).astype(np.uint8)
    rgb = _COLOURS[index]
    rgb[~known] = 255
    return rgb


def draw_colour_scale(canvas: Canvas, at: tuple[float, float], width: int, top: float) -> None:
    """Draw the scale of `coloured` with its ends named below it.

    Parameters
    ----------
    canvas : Canvas
    at : tuple of float
        x and y of its upper left corner, px.
    width : int
        px.
    top : float
        Upper end of the scale, mm.
    """
    x, y = at
    canvas.place(coloured(np.broadcast_to(np.linspace(0, top, width, dtype=np.float32), (14, width)), top), x, y)
    canvas.text(x, y + 34, "0 mm", size=12, colour=GREY)
    canvas.text(x + width, y + 34, f"{top:g} mm or more", size=12, colour=GREY, anchor="rs")


def pixel_to_fit(mesh: Mesh, towards: ArrayLike, size: int) -> float:
    """Size of a pixel at which a view of a mesh just fits a square.

    Parameters
    ----------
    mesh : Mesh
    towards : array_like, shape (3,)
        From the mesh to the viewer, LPS.
    size : int
        Side of the square, px.

    Returns
    -------
    float
        mm.
    """
    flat = mesh.vertices @ view_axes(towards)[:2].T
    return float(np.ptp(flat, axis=0).max() / size)


def put_view(
    canvas: Canvas, rgb: RGB, px: float, towards: ArrayLike, box: tuple[float, float, float, float]
) -> tuple[int, int]:
    """Put a rendered view in the middle of a box, with its scale bar and the sides of the patient.

    Parameters
    ----------
    canvas : Canvas
    rgb : ndarray of uint8, shape (H, W, 3)
    px : float
        Size of its pixels, mm.
    towards : array_like, shape (3,)
        From what is seen to the viewer, LPS.
    box : tuple of float
        x, y, width and height, px; at least as large as the view.

    Returns
    -------
    tuple of int
        x and y of the view's upper left corner.
    """
    x, y, width, height = box
    corner = int(x + (width - rgb.shape[1]) // 2), int(y + (height - rgb.shape[0]) // 2)
    canvas.place(rgb, *corner)
    length = round_length(0.3 * width * px)
    canvas.scale_bar(x + 14, y + height - 14, length / px, f"{length:g} mm")
    canvas.sides(box, *view_axes(towards)[:2])
    return corner
