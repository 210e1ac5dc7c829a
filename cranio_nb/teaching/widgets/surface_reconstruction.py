"""Stage 5 and the comparison with the truth under sliders: smoothing against deviation, maps of distances.

Frame: world mm (LPS).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...drawing.canvas import BLUE, GREEN, GREY, ORANGE, RGB, SKY, VERMILLION, Canvas, rgb_of, round_length
from ...drawing.canvas_axes import Chart
from ...drawing.figures import colour_scale
from ...drawing.shading import Solid, render, view_axes
from ...errors import InputRefused
from ...evaluation import scores
from ...mesh import Mesh
from ...prosthesis import INNER, OUTER, Prosthesis
from ...stages import surface_reconstruction as stage
from ...volume import Volume
from .controls import Choice, Slider, View
from .panel import Panel

SIDES = ("outer", "inner")
_SIDE, _CHART = 440, 350  # px
_LUT = (colour_scale(1.0).to_rgba(np.linspace(0, 1, 256), bytes=True)[:, :3]).astype(np.uint8)


def surface(patch: Volume, *, towards: ArrayLike = (1.0, -0.4, 0.3)) -> Panel:
    """Smooth the surface of a patch step by step and see how far it moves from the stairs.

    Parameters
    ----------
    patch : Volume
        Bool mask.
    towards : array_like, shape (3,)
        From the patch to the viewer, LPS; `Opening.direction` looks straight at it.
    """
    raw = stage.extract(patch, smooth=False)
    smoothed = lru_cache(maxsize=None)(lambda n: raw if n == 0 else stage.extract(patch, n_steps=n))
    seen = lru_cache(maxsize=None)(lambda n: _shaded(smoothed(n), towards))
    moved = lru_cache(maxsize=None)(lambda n: np.linalg.norm(smoothed(n).vertices - raw.vertices, axis=1))
    controls = (Slider("steps", "smoothing steps", 0, 48, 24),)
    alt = "The shaded surface of the patch after smoothing, and a histogram of how far its vertices moved."
    bounds = float(patch.spacing.max() / 2), float(np.linalg.norm(patch.spacing) / 2)
    return Panel(controls, lambda steps: surface_view(*seen(steps), moved(steps), bounds, steps), alt=alt)


def surface_view(rgb: RGB, px: float, moved: NDArray[np.float64], bounds: tuple[float, float], steps: int) -> View:
    """The surface and its deviation from marching cubes, mm.

    `bounds` are half the longest side and half the diagonal of a voxel: from its middle to a wall, and to a corner.
    """
    wall, corner = bounds
    canvas = Canvas(_SIDE + _CHART, _SIDE)
    put_view(canvas, rgb, px)
    counts, edges = np.histogram(moved, 60, (0, corner * 1.05))
    chart = Chart((_SIDE, 20, _CHART, 320), (0, corner * 1.05), (0.8, max(10.0, 1.5 * counts.max())), log=True)
    chart.frame(canvas, "vertices", "moved from marching cubes (mm)")
    chart.bars(canvas, edges, np.maximum(counts, 0.8), SKY)
    chart.upright(canvas, moved.mean(), BLUE, width=2.5)
    chart.upright(canvas, wall, GREEN, dash=(6, 4))
    chart.upright(canvas, corner, VERMILLION, dash=(6, 4))
    legend = [
        (BLUE, "line", f"mean {moved.mean():.2f} mm"),
        (GREEN, "dash", f"half a voxel's longest side, {wall:.2f} mm"),
        (VERMILLION, "dash", f"half a voxel's diagonal, {corner:.2f} mm"),
    ]
    canvas.legend(_SIDE + 56, 352, legend)
    what = "Marching cubes as they come" if steps == 0 else f"{steps} smoothing steps"
    line = f"{what}: vertices moved {moved.mean():.2f} mm on average, {moved.max():.2f} mm at most; "
    line += f"half a voxel is {wall:.2f} mm along its longest side, {corner:.2f} mm to a corner."
    return View(canvas.array(), line)


def evaluation(prosthesis: Prosthesis, truth: Prosthesis) -> Panel:
    """Map the distances of a prosthesis from the true one.

    Parameters
    ----------
    prosthesis, truth : Prosthesis
        With outer and inner side; `run.check_truth` makes the true one from a mask (``.prosthesis``).
    """
    maps = {name: distance_map(prosthesis, truth, side) for name, side in zip(SIDES, (OUTER, INNER), strict=True)}
    top = max(0.2, round(float(np.percentile(maps["outer"].distances, 99)), 1))
    controls = (
        Choice("side", "side of the prosthesis", SIDES, "outer"),
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
    px = pixel(own, towards, _SIDE - 60)
    values = np.repeat(distances[:, None], 3, axis=1)
    drawn = render([Solid(own, values)], towards, px=px, shaded=False)
    return DistanceMap(distances, np.where(np.isfinite(drawn.depth), drawn.rgb[..., 0], np.nan), px)


def distance_view(known: DistanceMap, side: str, top: float, limit: float) -> View:
    """A map of distances with its scale, and their histogram."""
    canvas = Canvas(_SIDE + _CHART, _SIDE)
    put_view(canvas, coloured(known.seen, top), known.px)
    high = max(top, 0.2)
    counts, edges = np.histogram(np.minimum(known.distances, high), 60, (0, high))
    chart = Chart((_SIDE, 20, _CHART, 300), (0, high), (0, 1.1 * counts.max()))
    chart.frame(canvas, "nodes", "distance (mm)")
    chart.bars(canvas, edges, counts, SKY)
    if limit <= high:
        chart.upright(canvas, limit, VERMILLION, dash=(6, 4))
    x, _, width, _ = chart.area
    canvas.place(
        np.broadcast_to(_LUT[np.linspace(0, 255, round(width)).astype(int)], (14, round(width), 3)).copy(), x, 360
    )
    canvas.text(x, 392, "0 mm", size=12, colour=GREY)
    canvas.text(x + width, 392, f"\N{GREATER-THAN OR EQUAL TO} {top:g} mm", size=12, colour=GREY, anchor="rs")
    d = known.distances
    line = f"{side.capitalize()} side: mean {d.mean():.2f} mm, std {d.std():.2f} mm, max {d.max():.2f} mm; "
    return View(canvas.array(), line + f"{100 * (d <= limit).mean():.0f} % of the nodes lie within {limit:g} mm.")


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


def _shaded(mesh: Mesh, towards: ArrayLike) -> tuple[RGB, float]:
    px = pixel(mesh, towards, _SIDE - 60)
    solid = Solid(mesh, np.array(rgb_of(ORANGE)) / 255)
    return (255 * render([solid], towards, px=px).rgb).astype(np.uint8), px


def put_view(canvas: Canvas, rgb: RGB, px: float) -> None:
    """A rendered view in the middle of the left side, with its scale bar."""
    height, width = rgb.shape[:2]
    canvas.place(rgb, (_SIDE - width) // 2, (_SIDE - 36 - height) // 2 + 4)
    length = round_length(0.3 * _SIDE * px)
    canvas.scale_bar(14, _SIDE - 12, length / px, f"{length:g} mm")
    canvas.line([(_SIDE, 8), (_SIDE, _SIDE - 8)], "#DADADA", width=1)
