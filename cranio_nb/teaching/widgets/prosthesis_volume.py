"""Stage 4 under a slider: the patch of every slice, and how large it is from slice to slice.

Frame: slice (row, col) px of the scan; planes of the scan.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...drawing.canvas import Canvas
from ...drawing.canvas_axes import Chart
from ...drawing.palette import BLACK, BONE, GREEN, GREY, INNER, ORANGE, OUTER, PATCH, WHITE
from ...drawing.pixels import Window, plain, tinted
from ...methods.design import design
from ...methods.slicewise.slices import SliceResult
from ...opening import Opening
from ...volume import Volume
from .controls import Choice, Slider, Switch, View
from .panel import Panel
from .parts import HEIGHT, LEFT, RIGHT, WIDTH, annotate_slice

PRESSURES = ("from the end tangents", "the paper's constant k")
_WORDS = {
    "balloon": ("bridged by its own balloons", PATCH),
    "hull": ("partial loss: hull minus bone", GREEN),
    "carried": ("carried from its neighbours", ORANGE),
    "skipped": ("left empty", GREY),
}


@dataclass(frozen=True, eq=False)
class Stack:
    """The patches of one opening, slice by slice.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    first : int
        Plane of the first slice.
    slices : tuple of SliceResult
    patches : ndarray of bool, shape (len(slices), R, C)
    """

    bone: Volume
    first: int
    slices: tuple[SliceResult, ...]
    patches: NDArray[np.bool_]

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Area of each patch.

        Returns
        -------
        ndarray, shape (len(slices),)
            mm2.
        """
        return self.patches.sum(axis=(1, 2)) * float(np.prod(self.bone.spacing[1:]))

    @cached_property
    def window(self) -> Window:
        """Where all patches are drawn, with some bone around them.

        Returns
        -------
        Window
        """
        # one window for all slices, so that nothing jumps from slice to slice
        rows, cols = np.nonzero(self.patches.any(axis=0))
        low, high = np.array([rows.min(), cols.min()]), np.array([rows.max(), cols.max()])
        margin = 0.25 * (high - low).max() + 4
        return Window.around((0, 0, LEFT, HEIGHT), low - margin, high + margin)


def patch(bone: Volume, opening: Opening) -> Panel:
    """Fill the gap of every slice: between the curves, or by the hull where the loss is partial.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    opening : Opening

    Returns
    -------
    Panel
        Controls ``plane``, ``pressure`` and ``curves``.
    """
    made = lru_cache(maxsize=2)(lambda pressure: fill_slices(bone, opening, pressure))
    first = made(PRESSURES[0]).first
    last = first + len(made(PRESSURES[0]).slices) - 1
    controls = (
        Slider("plane", f"slice ({first} to {last})", first, last, sum(opening.planes) // 2),
        Choice("pressure", "pressure k", PRESSURES, PRESSURES[0]),
        Switch("curves", "show the curves", True),
    )
    alt = "A slice with its bone, the two curves across the gap and the patch between them; beside it the patch's area."
    return Panel(controls, lambda pressure, **values: _view(made(pressure), **values), alt=alt)


def fill_slices(bone: Volume, opening: Opening, pressure: str) -> Stack:
    """Curves and patches of all slices of an opening, axial as in the paper.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    opening : Opening
    pressure : str
        One of `PRESSURES`.

    Returns
    -------
    Stack
    """
    # the paper's preset; k from the end tangents where that is chosen
    options: dict[str, Any] = {"pressure_mm": None} if pressure == PRESSURES[0] else {}
    made = design(bone, [opening], method="slicewise", preset="paper", **options)
    (sliced,) = made.working
    assert made.patch is not None
    first = round(float(bone.to_voxel(sliced.frames[0, 0])[0]))
    return Stack(bone, first, sliced.slices, made.patch.voxels[first : first + len(sliced.slices)])


def _view(stack: Stack, plane: int, curves: bool) -> View:
    """One slice with its patch, and the areas of all."""
    at = plane - stack.first
    result, mask = stack.slices[at], stack.bone.voxels[plane]
    words, colour = _WORDS[result.status]
    canvas = Canvas(WIDTH, HEIGHT)
    window = stack.window
    # the slice: bone, patch, curves
    inset = Canvas(LEFT, HEIGHT)
    colour = colour if result.status != "skipped" else PATCH
    inset.show(tinted(tinted(plain(mask.shape), mask, BONE), stack.patches[at], colour), window)
    if curves:
        for curve, line, dash in zip(result.curves, (OUTER, INNER), (None, (8, 4)), strict=False):
            inset.line(window.px(curve), line, width=2.5, dash=dash)
    annotate_slice(inset, window, stack.bone, plane)
    inset.legend(6, 26, [(BONE, "area", "bone"), (OUTER, "line", "outer curve"), (INNER, "dash", "inner curve")])
    canvas.inlay(inset, 0, 0)
    # beside it the areas of all slices
    _draw_areas(canvas, stack, at)
    found = sorted({s.status for s in stack.slices}, key=list(_WORDS).index)
    canvas.legend(RIGHT[0] + 6, 350, [(_WORDS[s][1], "area", _WORDS[s][0]) for s in found])
    line = f"Slice {plane}, {words}: patch of {stack.areas[at]:.0f} mm\N{SUPERSCRIPT TWO}"
    if result.inflation is not None:
        theta0, theta1 = result.inflation.theta0_deg[0], result.inflation.theta1_deg[0]
        line += f", outer theta0 {theta0:.0f}, theta1 {theta1:.0f} degrees"
        line += " (beyond 180: it would arrive from inside the head)" if max(theta0, theta1) > 180 else ""
    return View(canvas.array(), line + (f" ({result.reason})." if result.reason else "."))


def _draw_areas(canvas: Canvas, stack: Stack, at: int) -> None:
    """Area of each slice's patch, coloured by how it was filled."""
    # a bar for each slice in the colour of its status, the shown one marked
    n = len(stack.slices)
    chart = Chart(
        (RIGHT[0], 10, RIGHT[2], 320), (stack.first - 0.5, stack.first + n - 0.5), (0, 1.1 * stack.areas.max() + 1)
    )
    chart.frame(canvas, "area of the patch (mm\N{SUPERSCRIPT TWO})", "slice")
    for i, (result, area) in enumerate(zip(stack.slices, stack.areas, strict=True)):
        edges = stack.first + i + np.array([-0.42, 0.42])
        chart.bars(canvas, edges, np.array([area]), _WORDS[result.status][1])
    (x, y), *_ = chart.px([[stack.first + at, stack.areas[at]]])
    canvas.dots([(x, y)], WHITE, radius=4.5, edge=BLACK)
