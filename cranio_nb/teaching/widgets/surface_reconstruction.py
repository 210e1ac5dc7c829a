"""Stage 5 under sliders: the surface of a patch, smoothing against deviation.

Frame: world mm (LPS).
"""

from __future__ import annotations

from functools import lru_cache
from itertools import islice

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...drawing.canvas import Canvas
from ...drawing.canvas_axes import Chart
from ...drawing.palette import BLACK, BLUE, COUNTS, MEASURE, PATCH, rgb_shares
from ...drawing.pixels import RGB
from ...drawing.shading import Solid, render
from ...mesh import Mesh
from ...stages import surface_reconstruction as stage
from ...volume import Volume
from .controls import Slider, View
from .panel import Panel
from .parts import HEIGHT, LEFT, RIGHT, WIDTH, pixel_to_fit, put_view

MOST_STEPS = 48


def surface(patch: Volume, *, towards: ArrayLike = (1.0, -0.4, 0.3)) -> Panel:
    """Smooth the surface of a patch step by step and follow how far it moves from the stairs.

    Parameters
    ----------
    patch : Volume
        Bool mask.
    towards : array_like, shape (3,)
        From the patch to the viewer, LPS; `Opening.direction` looks straight at it.

    Returns
    -------
    Panel
        Control ``steps``.
    """
    # the relaxation is run once; each number of steps is made a solid and drawn once
    stairs = stage.find_stairs(patch)
    raw, relaxed = stairs.mesh, list(islice(stage.relaxations(stairs), MOST_STEPS + 1))
    smoothed = lru_cache(maxsize=None)(lambda n: stage.smoothed(stairs, relaxed[n]) if n else raw)
    shaded = lru_cache(maxsize=None)(lambda n: _shaded(smoothed(n), towards))
    moved = lru_cache(maxsize=None)(lambda n: np.linalg.norm(smoothed(n).vertices - raw.vertices, axis=1))
    controls = (Slider("steps", "smoothing steps", 0, MOST_STEPS, 24),)
    alt = "The shaded surface of the patch after smoothing, and a histogram of how far its vertices moved."
    bounds = float(patch.spacing.max() / 2), float(np.linalg.norm(patch.spacing) / 2)
    return Panel(
        controls, lambda steps: _view(*shaded(steps), towards, moved(steps), bounds, steps), alt=alt, ahead="steps"
    )


def _view(
    rgb: RGB, px: float, towards: ArrayLike, moved: NDArray[np.float64], bounds: tuple[float, float], steps: int
) -> View:
    """The surface and its deviation from marching cubes, mm.

    `bounds` are half the longest side and half the diagonal of a voxel: from its middle to a wall, and to a corner.
    """
    wall, corner = bounds
    # surface at the left, how far its vertices moved at the right
    canvas = Canvas(WIDTH, HEIGHT)
    put_view(canvas, rgb, px, towards, (0, 0, LEFT, HEIGHT))
    _draw_deviation(canvas, moved, wall, corner)
    what = "Marching cubes as they come" if steps == 0 else f"{steps} smoothing steps"
    line = f"{what}: vertices moved {moved.mean():.2f} mm on average, {moved.max():.2f} mm at most; "
    line += f"half a voxel is {wall:.2f} mm along its longest side, {corner:.2f} mm to a corner."
    return View(canvas.array(), line)


def _draw_deviation(canvas: Canvas, moved: NDArray[np.float64], wall: float, corner: float) -> None:
    """Histogram of how far the vertices moved, beside their mean and the bounds."""
    # beside the histogram the two bounds that half a voxel sets
    counts, edges = np.histogram(moved, 60, (0, corner * 1.05))
    chart = Chart((RIGHT[0], 20, RIGHT[2], 350), (0, corner * 1.05), (0.8, max(10.0, 1.5 * counts.max())), log=True)
    chart.frame(canvas, "vertices", "moved from marching cubes (mm)")
    chart.bars(canvas, edges, np.maximum(counts, 0.8), COUNTS)
    chart.upright(canvas, moved.mean(), BLUE, width=2.5)
    chart.upright(canvas, wall, MEASURE, dash=(6, 4))
    chart.upright(canvas, corner, BLACK, dash=(6, 4))
    legend = [
        (BLUE, "line", f"mean {moved.mean():.2f} mm"),
        (MEASURE, "dash", f"half longest side, {wall:.2f} mm"),
        (BLACK, "dash", f"half diagonal, {corner:.2f} mm"),
    ]
    canvas.legend(RIGHT[0] + 6, 390, legend)


def _shaded(mesh: Mesh, towards: ArrayLike) -> tuple[RGB, float]:
    """A view of the surface, and the size of its pixels in mm."""
    px = pixel_to_fit(mesh, towards, LEFT - 60)
    solid = Solid(mesh, rgb_shares(PATCH))
    return (255 * render([solid], towards, px_mm=px).rgb).astype(np.uint8), px
