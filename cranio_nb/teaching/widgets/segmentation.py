"""Stages 0 and 1 under sliders: a CT seen through a window, and the bone that a threshold leaves.

Frame: slices (row, col) px of the scan, seen from the feet as radiologists do: the patient's left is on the right.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ...drawing.canvas import (
    BLACK,
    BONE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    RGB,
    SKY,
    VERMILLION,
    YELLOW,
    Canvas,
    Window,
    round_length,
    tinted,
    windowed,
)
from ...drawing.canvas_axes import Chart
from ...stages.segmentation import BONE_HU, fill_holes, threshold_hu
from ...volume import Volume
from .controls import Slider, Switch, View
from .panel import Panel

SIDE = 512  # px of a slice's picture
_PART_COLOURS = (BONE, ORANGE, SKY, PURPLE, YELLOW, VERMILLION)


def ct_viewer(ct: Volume) -> Panel:
    """Browse a CT: slice, and the centre and width of the grey window.

    Parameters
    ----------
    ct : Volume
        HU.
    """
    last = ct.shape[0] - 1
    controls = (
        Slider("plane", f"slice (0 to {last})", 0, last, round(0.6 * last)),
        Slider("centre", "window centre (HU)", -1000, 2000, 300, 10),
        Slider("width", "window width (HU)", 50, 4000, 1500, 50),
    )
    alt = "An axial slice of the head CT in grey, with a histogram of its HU and the chosen grey window."
    return Panel(controls, lambda **values: ct_view(ct, **values), alt=alt)


def ct_view(ct: Volume, plane: int, centre: float, width: float) -> View:
    """A slice through a grey window, and the histogram of its HU below that window."""
    hu = ct.voxels[plane]
    canvas = Canvas(SIDE + 360, SIDE)
    window = Window.whole((0, 0, SIDE, SIDE), hu.shape)
    canvas.show(windowed(hu, centre, width), window, smooth=True)
    dress(canvas, window, ct, plane)
    edges, counts = histogram(hu, -1100, 2500)
    chart = hu_chart(canvas, (SIDE + 4, 16, 350, 300), edges, counts)
    for value in (centre - width / 2, centre + width / 2):
        chart.upright(canvas, value, VERMILLION, dash=(5, 3))
    chart.upright(canvas, centre, VERMILLION)
    grey_ramp(canvas, (SIDE + 62, 350, 280, 18), centre, width)
    low, high = centre - width / 2, centre + width / 2
    line = f"Slice {plane}: {low:g} HU and below is black, {high:g} HU and above is white."
    return View(canvas.array(), line)


def threshold(ct: Volume) -> Panel:
    """Choose the bone threshold and see what becomes bone.

    Parameters
    ----------
    ct : Volume
        HU.
    """
    last = ct.shape[0] - 1
    controls = (
        Slider("plane", f"slice (0 to {last})", 0, last, round(0.6 * last)),
        Slider("hu", "lowest HU of bone", -200, 1500, BONE_HU, 10),
        Slider("max_hole", "fill holes up to (mm\N{SUPERSCRIPT TWO})", 0, 200, 60, 5),
        Switch("parts", "colour the pieces", False),
    )
    edges, counts = histogram(ct.voxels[:, ::2, ::2], -1100, 2500)
    alt = "An axial slice with what the threshold takes for bone, filled holes in green, and the histogram of the CT."
    return Panel(controls, lambda **values: threshold_view(ct, edges, counts, **values), alt=alt)


def threshold_view(
    ct: Volume, edges: NDArray, counts: NDArray, plane: int, hu: float, max_hole: float, parts: bool
) -> View:
    """A slice with its bone, filled holes and pieces, and the histogram with the threshold."""
    area = float(np.prod(ct.spacing[1:]))
    raw = threshold_hu(ct.voxels[plane], hu)
    bone = fill_holes(raw[None], max_hole / area)[0]
    labels, n_parts = ndimage.label(bone, np.ones((3, 3)))
    canvas = Canvas(SIDE + 360, SIDE)
    window = Window.whole((0, 0, SIDE, SIDE), raw.shape)
    canvas.show(bone_picture(ct.voxels[plane], raw, bone, labels if parts else None), window)
    dress(canvas, window, ct, plane)
    chart = hu_chart(canvas, (SIDE + 4, 16, 350, 300), edges, counts)
    chart.upright(canvas, hu, VERMILLION, width=3)
    (x, y), *_ = chart.px([[hu, chart.y[1]]])
    canvas.text(x + 6, y + 12, "bone", size=12, colour=VERMILLION, anchor="ls")
    entries = [(BONE, "area", "bone"), (GREEN, "area", "holes filled")]
    canvas.legend(SIDE + 62, 350, [*entries, (ORANGE, "area", "other pieces")] if parts else entries)
    filled = (np.count_nonzero(bone) - np.count_nonzero(raw)) * area
    line = (
        f"Slice {plane} at {hu:g} HU: {np.count_nonzero(bone) * area / 100:.1f} cm\N{SUPERSCRIPT TWO} of bone in "
        f"{n_parts} {'piece' if n_parts == 1 else 'pieces'}; {filled:.0f} mm\N{SUPERSCRIPT TWO} of holes filled."
    )
    return View(canvas.array(), line)


def bone_picture(hu: NDArray, raw: NDArray[np.bool_], bone: NDArray[np.bool_], labels: NDArray | None) -> RGB:
    """Dim CT, bone over it, filled holes in green, pieces in colours where labels are given; shape (R, C, 3)."""
    rgb = windowed(hu, 200, 1400) // 2
    if labels is None:
        rgb = tinted(rgb, raw, BONE)
    else:
        order = np.argsort(np.bincount(labels.ravel())[1:])[::-1]
        for rank, part in enumerate(order[:60]):
            rgb = tinted(rgb, labels == part + 1, _PART_COLOURS[min(rank, len(_PART_COLOURS) - 1)])
    return tinted(rgb, bone & ~raw, GREEN)


def dress(canvas: Canvas, window: Window, grid: Volume, plane: int) -> None:
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


def grey_ramp(canvas: Canvas, box: tuple[float, float, float, float], centre: float, width: float) -> None:
    """The grey scale of a window with HU at its ends."""
    x, y, w, h = box
    ramp = np.linspace(0, 255, round(w)).astype(np.uint8)
    canvas.area((x - 1, y - 1, w + 2, h + 2), BLACK)
    canvas.place(np.broadcast_to(ramp[None, :, None], (round(h), round(w), 3)).copy(), x, y)
    for at, value, anchor in ((x, centre - width / 2, "la"), (x + w, centre + width / 2, "ra")):
        canvas.text(at, y + h + 5, f"{value:g} HU", size=12, colour=GREY, anchor=anchor)
