"""Figures 1 to 3 of the paper: one slice, its bone, the boundary and what is found on it.

Frames: slices (row, col) px of one plane of a scan, drawn in mm.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...curves import GapEnds
from ...stages import feature_extraction
from ...volume import Volume
from .. import figures
from ..figures import Axes, Figure
from ..palette import BLACK, BONE, INNER, MIDDLE_GREY, OUTER, TANGENT

_SIZE_IN = (8.0, 4.6)
_END_MM = 11.0  # shown around an end of the gap
_LINE_MM = 15.0  # of a tangent line on either side of its end


def figure_1(ct: Volume, bone: Volume, plane: int) -> Figure:
    """(a) Slice of the defective skull. (b) Bone segmentation.

    Parameters
    ----------
    ct : Volume
        HU.
    bone : Volume
        Bool mask.
    plane : int

    Returns
    -------
    Figure
    """
    figure, panels = figures.panel_figure([["a", "b"]], *_SIZE_IN)
    figures.slice_panel(panels["a"], ct, title=f"(a) CT, slice {plane}")
    figures.show_ct(panels["a"], ct, plane)
    figures.slice_panel(panels["b"], bone, title="(b) bone")
    figures.paint(panels["b"], bone.voxels[plane], bone, BONE, label="bone")
    figures.key(figure)
    return figure


def figure_2(bone: Volume, plane: int) -> Figure:
    """Bone boundary and skeleton; a zoom shows their pixels where the gap begins.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    plane : int
        With a gap.

    Returns
    -------
    Figure

    Raises
    ------
    SliceProblem
        Where the slice has no skeleton.
    """
    seen = feature_extraction.extract_features(bone.voxels[plane])
    boundary = _as_mask(np.concatenate([seen.outer, seen.inner]), bone)
    figure, panels = figures.panel_figure([["whole", "zoom"]], *_SIZE_IN)
    windows = {"whole": [], "zoom": [seen.skeleton[0][-1]]}
    for (name, around), title in zip(windows.items(), (f"slice {plane}", "where the gap begins"), strict=True):
        ax = panels[name]
        figures.slice_panel(ax, bone, around=around, margin_mm=_END_MM, title=title)
        figures.paint(ax, bone.voxels[plane], bone, BONE, label="bone")
        figures.paint(ax, boundary, bone, MIDDLE_GREY, label="boundary B")
        for spine in seen.skeleton:
            figures.plot_points(ax, spine, bone, color=BLACK, lw=1.6, label="skeleton")
    figures.mark_zoom(panels["whole"], panels["zoom"])
    figures.key(figure)
    return figure


def figure_3(bone: Volume, plane: int, ends: Sequence[GapEnds]) -> Figure:
    """(a) Inner and outer boundaries of the bone plus the tangent lines; a zoom on either end of the gap.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    plane : int
        With a gap.
    ends : sequence of GapEnds
        Of the outer and of the inner boundary.

    Returns
    -------
    Figure

    Raises
    ------
    SliceProblem
        Where the slice has no skeleton.
    """
    seen = feature_extraction.extract_features(bone.voxels[plane])
    middles = np.mean([one.points for one in ends], axis=0)
    figure, panels = figures.panel_figure([["whole", "first"], ["whole", "second"]], *_SIZE_IN, widths=(1.6, 1.0))
    windows = {"whole": [], **{name: [middles[i]] for i, name in enumerate(("first", "second"))}}
    titles = (f"(a) slice {plane}", "its first end", "its second end")
    for (name, around), title in zip(windows.items(), titles, strict=True):
        ax = panels[name]
        figures.slice_panel(ax, bone, around=around, margin_mm=_END_MM, title=title)
        figures.paint(ax, bone.voxels[plane], bone, BONE, label="bone")
        figures.paint(ax, _as_mask(seen.outer, bone), bone, OUTER, label="outer boundary")
        figures.paint(ax, _as_mask(seen.inner, bone), bone, INNER, label="inner boundary")
        for one in ends:
            _draw_tangents(ax, one, bone)
    for name in ("first", "second"):
        figures.mark_zoom(panels["whole"], panels[name])
    figures.key(figure, columns=5)
    return figure


def _as_mask(points: NDArray, bone: Volume) -> NDArray[np.bool_]:
    """Pixels of a slice as its mask."""
    mask = np.zeros(bone.shape[1:], bool)
    mask[tuple(points.astype(int).T)] = True
    return mask


def _draw_tangents(ax: Axes, ends: GapEnds, bone: Volume) -> None:
    """Draw the ends of a gap as rings, and the tangent lines through them."""
    for point, tangent in zip(ends.points, ends.tangents, strict=True):
        along = tangent / np.linalg.norm(tangent * bone.spacing[1:])  # px for a mm
        line = point + _LINE_MM * np.array([[-1.0], [1.0]]) * along
        figures.plot_points(ax, line, bone, color=TANGENT, lw=1.6, label="tangent line")
    ring = {"ls": "none", "marker": "o", "ms": 5, "mfc": "white", "mec": BLACK}
    figures.plot_points(ax, ends.points, bone, label="end of the balloon", **ring)
