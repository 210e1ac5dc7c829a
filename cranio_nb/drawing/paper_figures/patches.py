"""Figures 6 and 7 of the paper: partial loss of bone, and good and bad patches.

Frames: slices (row, col) px of one plane of a scan, drawn in mm.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage.morphology import convex_hull_image

from ...methods.slicewise.slices import SliceResult
from ...volume import Volume
from .. import figures
from ..figures import Axes, Figure
from ..palette import BLACK, BONE, INNER, MIDDLE_GREY, OUTER, PALE, PATCH, TRUTH

_ZOOM_MM = 10.0  # shown around the patch in a zoom
_BESIDE_MM = 22.0  # and in a panel that shows where it lies
_PATCH_MM = 3.0


def figure_6(ct: Volume, bone: Volume, plane: int, patch: NDArray[np.bool_]) -> Figure:
    """(a) Original slice, the defect highlighted. (b) Bone. (c) Convex hull minus bone. (d) Patch. Below each a zoom.

    Parameters
    ----------
    ct : Volume
        HU.
    bone : Volume
        Bool mask.
    plane : int
    patch : ndarray of bool, shape (R, C)
        What is kept of the difference; one pixel at least.

    Returns
    -------
    Figure
    """
    figure, panels = figures.panel_figure(["abcd", "ABCD"], 8.0, 5.6)
    titles = ("(a) slice of CT", "(b) bone", "(c) hull minus bone", "(d) patch")
    for name, title in zip("abcd", titles, strict=True):
        whole, zoom = panels[name], panels[name.upper()]
        figures.slice_panel(whole, bone, title=title)
        figures.slice_panel(zoom, bone, around=[np.argwhere(patch)], margin_mm=_ZOOM_MM)
        for ax in (whole, zoom):
            _show_loss(ax, name, ct, bone, plane, patch)
        figures.mark_zoom(whole, zoom)
    figures.key(figure)
    return figure


def _show_loss(ax: Axes, name: str, ct: Volume, bone: Volume, plane: int, patch: NDArray[np.bool_]) -> None:
    """Show one part of Figure 6, "a" to "d"."""
    mask = bone.voxels[plane]
    if name == "a":
        figures.show_ct(ax, ct, plane)
        return
    if name == "c":
        for region, colour, label in _fates(convex_hull_image(mask) & ~mask, patch):
            figures.paint(ax, region, bone, colour, label=label)
        return
    figures.paint(ax, mask, bone, BONE, label="bone")
    if name == "d":
        figures.paint(ax, patch, bone, PATCH, label="kept: the patch")


def _fates(difference: NDArray[np.bool_], patch: NDArray[np.bool_]) -> list[tuple[NDArray[np.bool_], str, str]]:
    """The pixels in the hull that are not bone, by what becomes of them: mask, colour and name."""
    labels, _ = ndimage.label(difference)
    largest = labels == np.bincount(labels.ravel())[1:].argmax() + 1
    return [
        (largest, PALE, "dropped: the largest region"),
        (difference & ~largest & ~patch, MIDDLE_GREY, "dropped: small islands"),
        (patch, PATCH, "kept: the patch"),
    ]


def figure_7(
    results: Sequence[SliceResult], planes: Sequence[int], bone: Volume, patch: Volume, lost: Volume
) -> Figure:
    """(a)-(c) Prosthesis patches obtained with the method. (d) Zoom in the patch of the last figure.

    Parameters
    ----------
    results : sequence of SliceResult
        Three slices along planes of the scan.
    planes : sequence of int
        Which planes these are.
    bone, patch, lost : Volume
        Bool masks: bone, the design, and the bone that is missing.

    Returns
    -------
    Figure
    """
    figure, panels = figures.panel_figure(["abcd"], 8.0, 4.4)
    shown = [np.argwhere(lost.voxels[plane] | patch.voxels[plane]) for plane in planes]
    for name, result, plane in zip("abcd", (*results, results[-1]), (*planes, planes[-1]), strict=True):
        ax, is_zoom = panels[name], name == "d"
        around, margin = (shown[-1:], _PATCH_MM) if is_zoom else (shown, _BESIDE_MM)
        title = "(d) zoom into (c)" if is_zoom else f"({name}) slice {plane}"
        figures.slice_panel(ax, bone, around=around, margin_mm=margin, title=title)
        figures.paint(ax, bone.voxels[plane], bone, BONE, label="bone")
        figures.paint(ax, patch.voxels[plane], bone, PATCH, label="patch")
        figures.outline(ax, lost.voxels[plane], bone, TRUTH, label="missing bone")
        if is_zoom:
            _draw_pair(ax, result, bone)
    figures.mark_zoom(panels["c"], panels["d"])
    figures.key(figure, columns=5)
    return figure


def _draw_pair(ax: Axes, result: SliceResult, bone: Volume) -> None:
    """Draw both curves of a slice."""
    # both full: dashed is where a balloon starts (figures 4 and 5)
    styles = (OUTER, "outer balloon"), (INNER, "inner balloon")
    for curve, (colour, name) in zip(result.curves, styles, strict=False):
        figures.plot_points(ax, curve, bone, color=colour, lw=1.8, label=name)
    if len(result.crossings):
        figures.plot_points(
            ax, result.crossings, bone, ls="none", marker="x", ms=9, mew=2.2, color=BLACK, label="they cross"
        )
