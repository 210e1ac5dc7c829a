"""A CT under sliders: a slice through a grey window.

Frame: slices (row, col) px of the scan, seen from the feet as radiologists do: the patient's left is on the right.
"""

from __future__ import annotations

import numpy as np

from ...drawing.canvas import Canvas
from ...drawing.palette import BLACK, GREY, VERMILLION
from ...drawing.pixels import Window, windowed
from ...volume import Volume
from .controls import Slider, View
from .panel import Panel
from .parts import HEIGHT, RIGHT, WIDTH, annotate_slice, count_hu, hu_chart, left_window

_AIR = -400  # HU: the window holds what lies above


def ct_viewer(ct: Volume) -> Panel:
    """Browse a CT: slice, and the centre and width of the grey window.

    Parameters
    ----------
    ct : Volume
        HU.

    Returns
    -------
    Panel
        Controls ``plane``, ``centre`` and ``width`` (HU).
    """
    last = ct.shape[0] - 1
    controls = (
        Slider("plane", f"slice (0 to {last})", 0, last, round(0.6 * last)),
        Slider("centre", "window centre", -1000, 2000, 300, 10, unit="HU", ahead=0),
        Slider("width", "window width", 50, 4000, 1500, 10, unit="HU", ahead=0),
    )
    alt = "An axial slice of the head CT in grey, with a histogram of its HU and the chosen grey window."
    window = left_window(ct.voxels > _AIR)
    presets = {"bone": {"centre": 800, "width": 800}, "brain": {"centre": 40, "width": 80}}
    return Panel(controls, lambda **values: _view(ct, window, **values), alt=alt, presets=presets)


def _view(ct: Volume, window: Window, plane: int, centre: float, width: float) -> View:
    """A slice through a grey window, and the histogram of its HU below that window."""
    low, high = centre - width / 2, centre + width / 2
    # the slice
    hu = ct.voxels[plane]
    canvas = Canvas(WIDTH, HEIGHT)
    canvas.show(windowed(hu, centre, width), window, smooth=True)
    annotate_slice(canvas, window, ct, plane)
    # its histogram, with the window's ends dashed and its centre
    x, _, width, _ = RIGHT
    chart = hu_chart(canvas, (x, 20, width, 330), count_hu(hu), "voxels of this slice")
    for value in (low, high):
        chart.upright(canvas, value, VERMILLION, dash=(5, 3))
    chart.upright(canvas, centre, VERMILLION)
    canvas.text(x + 58, 398, "grey", size=13)
    _draw_grey_scale(canvas, (x + 58, 406, width - 70, 18), low, high)
    line = f"Slice {plane}: {low:g} HU and below is black, {high:g} HU and above is white."
    return View(canvas.array(), line)


def _draw_grey_scale(canvas: Canvas, box: tuple[float, float, float, float], low: float, high: float) -> None:
    """The grey scale of a window with HU at its ends."""
    # a ramp of grey in a black frame, each end with its HU
    x, y, w, h = box
    ramp = np.linspace(0, 255, round(w)).astype(np.uint8)
    canvas.area((x - 1, y - 1, w + 2, h + 2), BLACK)
    canvas.place(np.broadcast_to(ramp[None, :, None], (round(h), round(w), 3)).copy(), x, y)
    for at, value, anchor in ((x, low, "la"), (x + w, high, "ra")):
        canvas.text(at, y + h + 5, f"{value:g} HU", size=12, colour=GREY, anchor=anchor)
