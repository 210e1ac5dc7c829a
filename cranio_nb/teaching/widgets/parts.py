"""What several panels draw: marks on a slice, the histogram of a CT, a shaded view, a scale of distances.

Frames: slices (row, col) px of the scan, the patient's left on the right; views in px of a canvas.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...drawing.canvas import GREY, RGB, SKY, Canvas, Window, round_length
from ...drawing.canvas_axes import Chart
from ...drawing.figures import colour_scale
from ...drawing.shading import view_axes
from ...mesh import Mesh
from ...volume import Volume

SIDE = 512  # px of a slice's picture
VIEW = 440  # px of a shaded view
_LUT = (colour_scale(1.0).to_rgba(np.linspace(0, 1, 256), bytes=True)[:, :3]).astype(np.uint8)


def annotate_slice(canvas: Canvas, window: Window, grid: Volume, plane: int) -> None:
    """Scale bar, sides of the patient and the number of the slice, over an axial slice."""
    mm = round_length(0.2 * window.box[2] / window.zoom * float(grid.spacing[2]))
    x, y, width, height = window.box
    canvas.scale_bar(x + 14, y + height - 14, mm / float(grid.spacing[2]) * window.zoom, f"{mm:g} mm")
    for at, letter in (((0.5, 0.035), "A"), ((0.5, 0.965), "P"), ((0.03, 0.5), "R"), ((0.97, 0.5), "L")):
        canvas.text(x + at[0] * width, y + at[1] * height, letter, size=14, anchor="mm", halo=True)
    canvas.text(x + width - 12, y + height - 14, f"slice {plane}", anchor="rs", halo=True)


def histogram(hu: NDArray, low: float, high: float, n: int = 120) -> tuple[NDArray, NDArray]:
    """Edges, shape (n + 1,), and counts, shape (n,), of the HU of a slice or a scan."""
    counts, edges = np.histogram(hu, n, (low, high))
    return edges, counts


def hu_chart(canvas: Canvas, box: tuple[float, float, float, float], edges: NDArray, counts: NDArray) -> Chart:
    """A histogram of HU on logarithmic counts."""
    chart = Chart(box, (edges[0], edges[-1]), (0.8, max(10.0, 1.5 * counts.max())), log=True)
    chart.frame(canvas, "voxels", "HU")
    chart.bars(canvas, edges, np.maximum(counts, 0.8), SKY)
    return chart


def coloured(seen: NDArray[np.float32], top: float) -> RGB:
    """Distances in a view -> cividis, white beside the surface, shape (H, W, 3)."""
    known = np.isfinite(seen)
    index = np.clip(np.where(known, seen, 0) * (255 / top), 0, 255).astype(np.uint8)
    rgb = _LUT[index]
    rgb[~known] = 255
    return rgb


def pixel(mesh: Mesh, towards: ArrayLike, size: int) -> float:
    """Mm per px at which a mesh just fits a square of `size` px."""
    flat = mesh.vertices @ view_axes(towards)[:2].T
    return float(np.ptp(flat, axis=0).max() / size)


def put_view(canvas: Canvas, rgb: RGB, px: float) -> None:
    """A rendered view in the middle of the left side, with its scale bar."""
    height, width = rgb.shape[:2]
    canvas.place(rgb, (VIEW - width) // 2, (VIEW - 36 - height) // 2 + 4)
    length = round_length(0.3 * VIEW * px)
    canvas.scale_bar(14, VIEW - 12, length / px, f"{length:g} mm")
    canvas.line([(VIEW, 8), (VIEW, VIEW - 8)], "#DADADA", width=1)


def colour_ramp(canvas: Canvas, x: float, y: float, width: int, top: float) -> None:
    """Draw the scale of `coloured`, from 0 to `top` mm, with its ends named below it.

    Parameters
    ----------
    canvas : Canvas
    x, y : float
        Upper left corner, px.
    width : int
        px.
    top : float
        Upper end of the scale, mm.
    """
    canvas.place(coloured(np.broadcast_to(np.linspace(0, top, width, dtype=np.float32), (14, width)), top), x, y)
    canvas.text(x, y + 34, "0 mm", size=12, colour=GREY)
    canvas.text(x + width, y + 34, f"{top:g} mm or more", size=12, colour=GREY, anchor="rs")
