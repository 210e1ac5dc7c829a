"""Several patches for one hole -> a cut through all of them, each as a line of its own style."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike
from scipy import ndimage

from ...vault import slicing
from ...volume import Volume
from ..palette import BLACK, BLUE, BONE, GREEN, MIDDLE_GREY, ORANGE, PURPLE, TRUTH, VERMILLION, faded
from .axes import fill_mask, name_sides, new_figure, scale_bar

if TYPE_CHECKING:
    from .axes import Figure

_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, BLACK, ORANGE, MIDDLE_GREY)
_DASHES: tuple[tuple[float, ...], ...] = (
    (),
    (6.0, 2.0),
    (6.0, 1.5, 1.5, 1.5),
    (2.0, 1.2),
    (1.0, 1.5),
    (9.0, 1.5),
    (3.0, 1.0, 1.0, 1.0, 1.0, 1.0),
)
_PIXEL_MM = 0.35


def line_style(i: int) -> tuple[str, tuple[float, ...]]:
    """Style of the i-th of several lines drawn over each other.

    Parameters
    ----------
    i : int

    Returns
    -------
    str
        Colour.
    tuple of float
        Dashes (on, off, ...) in line widths; empty for an unbroken line. Alone the dashes tell seven lines apart; with
        the colours it is 49 before one comes back.

    Examples
    --------
    >>> line_style(0), line_style(1)
    (('#0072B2', ()), ('#D55E00', (6.0, 2.0)))
    """
    n = len(_DASHES)
    return _COLOURS[i % n], _DASHES[(i + i // n) % n]


def outlines_figure(
    bone: Volume,
    truth: Volume | None,
    patches: Sequence[Volume],
    *,
    centre: ArrayLike,
    axes: ArrayLike,
    reach_mm: float,
) -> Figure:
    """A cut through several patches for one hole: bone and truth as areas, each patch as a line of its `line_style`.

    Parameters
    ----------
    bone, truth : Volume
        Bool masks.
    patches : sequence of Volume
        Bool masks.
    centre : array_like, shape (3,)
        World mm: half-way between left and right in the picture.
    axes : array_like, shape (2, 3)
        Unit vectors to the right and down in the picture, world.
    reach_mm : float
        Shown to the left and right of the centre; half as much above it, and 0.7 as much below.

    Returns
    -------
    Figure
    """
    # a slice frame, and even places in it
    right, down = np.asarray(axes, float)
    frame = np.stack([np.asarray(centre, float), down, right])
    rows = np.arange(-0.5 * reach_mm, 0.7 * reach_mm, _PIXEL_MM)
    cols = np.arange(-reach_mm, reach_mm, _PIXEL_MM)
    extent = (cols[0], cols[-1], rows[-1], rows[0])
    figure, ax = new_figure(5.0, 5.0 * len(rows) / len(cols))
    for mask, colour in ((bone, BONE), (truth, faded(TRUTH))):
        if mask is not None:
            fill_mask(ax, slicing.sample_mask(mask, frame, rows, cols), extent, colour)
    # outlines of the smoothed masks: those of voxels would be stairs
    for i, patch in enumerate(patches):
        colour, dashes = line_style(i)
        soft = ndimage.gaussian_filter(slicing.sample_mask(patch, frame, rows, cols).astype(float), 1.0)
        if soft.max() > 0.5:
            style = (0, dashes) if dashes else "-"
            ax.contour(cols, rows, soft, levels=[0.5], colors=[colour], linestyles=[style], linewidths=1.4)
    ax.set_xlim(extent[:2])
    ax.set_ylim(extent[2:])
    name_sides(ax, np.stack([right, down]))
    scale_bar(ax, 20.0)
    return figure
