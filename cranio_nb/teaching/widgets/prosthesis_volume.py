"""Stage 4 under a slider: the patch of every slice, and how large it is from slice to slice.

Frame: slice (row, col) px of the scan; planes of the scan.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ...drawing.canvas import BLACK, BLUE, BONE, GREEN, GREY, ORANGE, SKY, VERMILLION, Canvas, Window, plain, tinted
from ...drawing.canvas_axes import Chart
from ...methods import slicewise
from ...opening import Opening
from ...stages import prosthesis_volume
from ...volume import Volume
from .controls import Choice, Slider, Switch, View
from .panel import Panel
from .parts import SIDE, annotate_slice

PRESSURES = ("from the end tangents", "the paper's constant k")
_WORDS = {
    "balloon": ("bridged by its own balloons", SKY),
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
    slices: tuple[slicewise.SliceResult, ...]
    patches: NDArray[np.bool_]

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Area of each patch, mm2."""
        return self.patches.sum(axis=(1, 2)) * float(np.prod(self.bone.spacing[1:]))

    @cached_property
    def window(self) -> Window:
        """All patches with some room around."""
        rows, cols = np.nonzero(self.patches.any(axis=0))
        low, high = np.array([rows.min(), cols.min()]), np.array([rows.max(), cols.max()])
        room = 0.25 * (high - low).max() + 4
        return Window.around((0, 0, SIDE, SIDE), low - room, high + room)


def patch(bone: Volume, opening: Opening) -> Panel:
    """Fill the gap of every slice: between the curves, or by the hull where the loss is partial.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    opening : Opening
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
    return Panel(controls, lambda pressure, **values: patch_view(made(pressure), **values), alt=alt)


def fill_slices(bone: Volume, opening: Opening, pressure: str) -> Stack:
    """Curves and patches of all slices of an opening, axial as in the paper."""
    options = slicewise.paper_options(bone)
    if pressure == PRESSURES[0]:
        options["pressure"] = None
    made = slicewise.design(bone, [opening], **options)
    (working,) = made.working
    first = round(float(bone.to_voxel(working.frames[0, 0])[0]))
    slices = bone.voxels[first : first + len(working.slices)]
    px = float(bone.spacing[1:].mean())
    near = ndimage.binary_dilation(opening.sheet.voxels.any(axis=0), iterations=int(np.ceil(3 / px)))
    patches = [_filled(result, slices[result.plane], near, 4 / px**2) for result in working.slices]
    return Stack(bone, first, working.slices, np.array(patches))


def _filled(
    result: slicewise.SliceResult, bone: NDArray[np.bool_], near: NDArray[np.bool_], min_area: float
) -> NDArray[np.bool_]:
    if result.status == "hull":
        return prosthesis_volume.partial_loss(bone, min_area=min_area, region=near)
    if result.curves.size:
        return prosthesis_volume.patch(result.curves[0], result.curves[1], bone)
    return np.zeros_like(bone)


def patch_view(stack: Stack, plane: int, curves: bool) -> View:
    """One slice with its patch, and the areas of all."""
    at = plane - stack.first
    result, mask = stack.slices[at], stack.bone.voxels[plane]
    words, colour = _WORDS[result.status]
    canvas = Canvas(SIDE + 350, SIDE)
    window = stack.window
    inset = Canvas(SIDE, SIDE)
    rgb = tinted(
        tinted(plain(mask.shape), mask, BONE), stack.patches[at], colour if result.status != "skipped" else SKY
    )
    inset.show(rgb, window)
    if curves:
        for curve, line, dash in zip(result.curves, (BLUE, VERMILLION), (None, (8, 4)), strict=False):
            inset.line(window.px(curve), line, width=2.5, dash=dash)
    annotate_slice(inset, window, stack.bone, plane)
    inset.legend(SIDE - 140, 6, [(BLUE, "line", "outer curve"), (VERMILLION, "dash", "inner curve")])
    canvas.inlay(inset, 0, 0)
    _draw_areas(canvas, stack, at)
    found = sorted({s.status for s in stack.slices}, key=list(_WORDS).index)
    canvas.legend(SIDE + 58, 330, [(_WORDS[s][1], "area", _WORDS[s][0]) for s in found])
    line = f"Slice {plane}, {words}: patch of {stack.areas[at]:.0f} mm\N{SUPERSCRIPT TWO}"
    return View(canvas.array(), line + (f" ({result.reason})." if result.reason else "."))


def _draw_areas(canvas: Canvas, stack: Stack, at: int) -> None:
    """Area of each slice's patch, coloured by how it was filled."""
    n = len(stack.slices)
    chart = Chart(
        (SIDE + 4, 10, 340, 300), (stack.first - 0.5, stack.first + n - 0.5), (0, 1.1 * stack.areas.max() + 1)
    )
    chart.frame(canvas, "area of the patch (mm\N{SUPERSCRIPT TWO})", "slice")
    for i, (result, area) in enumerate(zip(stack.slices, stack.areas, strict=True)):
        edges = stack.first + i + np.array([-0.42, 0.42])
        chart.bars(canvas, edges, np.array([area]), _WORDS[result.status][1])
    (x, y), *_ = chart.px([[stack.first + at, stack.areas[at]]])
    canvas.dots([(x, y)], "#FFFFFF", radius=4.5, edge=BLACK)
