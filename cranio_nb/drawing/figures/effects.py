"""A measure against parameters: means by level with their spread, and a table of colours for two parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..palette import BLACK, BLUE, PALE, WHITE
from .axes import laid_out_figure

if TYPE_CHECKING:
    from .axes import Figure

_PER_ROW = 4
_PANEL_IN = (2.5, 2.0)
_CELL_IN = (0.75, 0.42)


@dataclass(frozen=True, eq=False)
class Panel:
    """A measure at the levels of a parameter.

    Parameters
    ----------
    name : str
        Of the parameter.
    labels : sequence of str
        Of its levels, rising.
    means, sds : ndarray, shape (levels,)
        Of the measure.
    """

    name: str
    labels: Sequence[str]
    means: NDArray[np.float64]
    sds: NDArray[np.float64]


def effects_figure(panels: Sequence[Panel], label: str) -> Figure:
    """Means with their standard deviation as a band, a panel for each parameter, all on one scale.

    Parameters
    ----------
    panels : sequence of Panel
        One at least.
    label : str
        Of the measure, with its unit.

    Returns
    -------
    Figure
    """
    rows, columns = -(-len(panels) // _PER_ROW), min(len(panels), _PER_ROW)
    size = (_PANEL_IN[0] * columns + 0.4, _PANEL_IN[1] * rows + 0.2)
    figure = laid_out_figure(*size)
    axes = figure.subplots(rows, columns, sharey=True, squeeze=False).ravel()
    for ax, one in zip(axes, panels, strict=False):
        at = np.arange(len(one.labels))
        ax.fill_between(at, one.means - one.sds, one.means + one.sds, color=PALE, lw=0)
        ax.plot(at, one.means, color=BLUE, marker="o", ms=4, lw=1.6)
        ax.set_xticks(at, one.labels, fontsize=7, rotation=35, ha="right")
        ax.set_xlabel(one.name, fontsize=9)
        ax.tick_params(axis="y", labelsize=8)
        ax.spines[["top", "right"]].set_visible(False)
    for ax in axes[len(panels) :]:
        ax.set_visible(False)
    for ax in axes[::columns]:
        ax.set_ylabel(label, fontsize=9)
    return figure


def pair_figure(
    table: NDArray[np.float64],
    rows: tuple[str, Sequence[str]],
    columns: tuple[str, Sequence[str]],
    label: str,
    *,
    digits: int,
) -> Figure:
    """Means of a measure at the levels of two parameters, as a table of colours with numbers in it.

    Parameters
    ----------
    table : ndarray, shape (R, C)
        nan where nothing was run.
    rows, columns : tuple
        Name and labels of the levels.
    label : str
        Of the measure, with its unit.
    digits : int
        Decimals of the numbers.

    Returns
    -------
    Figure
    """
    height, width = table.shape
    figure = laid_out_figure(_CELL_IN[0] * width + 2.6, _CELL_IN[1] * height + 1.1)
    ax = figure.subplots()
    shown = ax.imshow(table, cmap="cividis", aspect="auto", origin="lower")
    middle = np.nanmean([np.nanmin(table), np.nanmax(table)])
    for (r, c), value in np.ndenumerate(table):  # white on the dark half of the colours
        if np.isfinite(value):
            ax.text(
                c,
                r,
                f"{value:.{digits}f}",
                ha="center",
                va="center",
                fontsize=8,
                color=WHITE if value < middle else BLACK,
            )
    ax.set_xticks(range(width), columns[1], fontsize=7, rotation=35, ha="right")
    ax.set_yticks(range(height), rows[1], fontsize=7)
    ax.set_xlabel(columns[0], fontsize=9)
    ax.set_ylabel(rows[0], fontsize=9)
    figure.colorbar(shown, ax=ax).set_label(label, fontsize=9)
    return figure
