"""Stage 1 under sliders: the bone that a threshold leaves.

Frame: slices (row, col) px of the scan, seen from the feet as radiologists do: the patient's left is on the right.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ...drawing.canvas import Canvas
from ...drawing.palette import BLACK, BONE, GREEN, ORANGE, PURPLE, SKY, VERMILLION, YELLOW
from ...drawing.pixels import RGB, Window, tinted, windowed
from ...stages import segmentation as stage
from ...volume import Volume
from .controls import Slider, Switch, View
from .panel import Panel
from .parts import HEIGHT, RIGHT, WIDTH, Histogram, annotate_slice, count_hu, hu_chart, left_window

_PART_COLOURS = (BONE, ORANGE, SKY, PURPLE, YELLOW, VERMILLION)  # of the pieces, the largest first
_SHOWN = -200  # HU: the lowest threshold; the window holds what it leaves
_MOST_PARTS = 60  # coloured; the rest are specks


def threshold(ct: Volume) -> Panel:
    """Choose the bone threshold and follow what becomes bone.

    Parameters
    ----------
    ct : Volume
        HU.

    Returns
    -------
    Panel
        Controls ``plane``, ``threshold_hu``, ``max_hole_mm2`` and ``parts``.
    """
    # the histogram is of every fourth voxel: it does not change with the controls
    last = ct.shape[0] - 1
    controls = (
        Slider("plane", f"slice (0 to {last})", 0, last, round(0.6 * last), ahead=3),
        Slider("threshold_hu", "threshold: bone from", _SHOWN, 1500, stage.BONE_HU, 5, unit="HU"),
        Slider("max_hole_mm2", "fill holes up to", 0, 200, 60, 5, unit="mm\N{SUPERSCRIPT TWO}", ahead=2),
        Switch("parts", "colour the pieces", False, expert=True),
    )
    histogram = count_hu(ct.voxels[:, ::2, ::2])
    alt = "An axial slice with what the threshold takes for bone, filled holes in green, and the histogram of the CT."
    window = left_window(ct.voxels > _SHOWN)
    presets = {f"{level} HU": {"threshold_hu": level} for level in (400, 625, 800)}
    return Panel(controls, lambda **values: _view(ct, window, histogram, **values), alt=alt, presets=presets)


def _view(
    ct: Volume,
    window: Window,
    histogram: Histogram,
    plane: int,
    threshold_hu: float,
    max_hole_mm2: float,
    parts: bool,
) -> View:
    """A slice with its bone, filled holes and pieces, and the histogram with the threshold."""
    # the slice by itself, as the stage would take it: threshold, then small holes
    area = float(np.prod(ct.spacing[1:]))
    raw = stage.apply_threshold(ct.voxels[plane], threshold_hu)
    bone = stage.fill_holes(raw[None], max_hole_px=max_hole_mm2 / area)[0]
    labels, n_parts = ndimage.label(bone, np.ones((3, 3)))

    canvas = Canvas(WIDTH, HEIGHT)
    canvas.show(_bone_picture(ct.voxels[plane], raw, bone, labels if parts else None), window)
    annotate_slice(canvas, window, ct, plane)
    _draw_threshold(canvas, histogram, threshold_hu)
    entries = [(BONE, "area", "bone"), (GREEN, "area", "holes filled")]
    canvas.legend(RIGHT[0] + 50, 370, [*entries, (ORANGE, "area", "other pieces")] if parts else entries)

    # areas by counting pixels
    filled = (np.count_nonzero(bone) - np.count_nonzero(raw)) * area
    line = (
        f"Slice {plane} at {threshold_hu:g} HU: {np.count_nonzero(bone) * area / 100:.1f} cm\N{SUPERSCRIPT TWO} of "
        f"bone in {n_parts} {'piece' if n_parts == 1 else 'pieces'}; {filled:.0f} mm\N{SUPERSCRIPT TWO} of holes "
        "filled."
    )
    return View(canvas.array(), line)


def _draw_threshold(canvas: Canvas, histogram: Histogram, threshold_hu: float) -> None:
    """The histogram of the CT with the threshold."""
    chart = hu_chart(canvas, (RIGHT[0], 20, RIGHT[2], 330), histogram)
    chart.upright(canvas, threshold_hu, BLACK, width=3)
    (x, y), *_ = chart.px([[threshold_hu, chart.y[1]]])
    canvas.text(x + 6, y + 12, "bone", size=12, anchor="ls")


def _bone_picture(hu: NDArray, raw: NDArray[np.bool_], bone: NDArray[np.bool_], labels: NDArray | None) -> RGB:
    """Dim CT, bone over it, filled holes in green, pieces in colours where labels are given; shape (R, C, 3)."""
    # at half brightness, so that the colours over it stand out
    rgb = windowed(hu, 200, 1400) // 2
    if labels is None:
        rgb = tinted(rgb, raw, BONE)
    else:
        # the largest pieces first; the last colour serves all the rest
        by_size = np.argsort(np.bincount(labels.ravel())[1:])[::-1]
        for rank, part in enumerate(by_size[:_MOST_PARTS]):
            rgb = tinted(rgb, labels == part + 1, _PART_COLOURS[min(rank, len(_PART_COLOURS) - 1)])
    return tinted(rgb, bone & ~raw, GREEN)
