"""Numbers -> a small chart on a canvas: axes, lines, bars.

Frame: values in their own units inside, canvas (x, y) px outside.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .canvas import Canvas, round_length
from .palette import BLACK, GREY, PALE

_LARGEST = 1e4  # of ticks that are written as numbers
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_LEFT, _BELOW, _ABOVE, _RIGHT = 58, 40, 26, 12  # px around the plotted area for ticks, names and title


@dataclass(frozen=True)
class Chart:
    """Axes on a canvas.

    Parameters
    ----------
    box : tuple of float
        x, y, width, height on the canvas, ticks and names included.
    x, y : tuple of float
        Limits of the axes.
    log : bool
        Whether y is logarithmic.

    Examples
    --------
    >>> chart = Chart((0, 0, 170, 166), (0, 10), (0, 1))
    >>> chart.px([[0, 0], [10, 1]]).tolist()
    [[58.0, 126.0], [158.0, 26.0]]
    """

    box: tuple[float, float, float, float]
    x: tuple[float, float]
    y: tuple[float, float]
    log: bool = False

    @property
    def area(self) -> tuple[float, float, float, float]:
        """The plotted area.

        Returns
        -------
        tuple of float
            x, y, width, height on the canvas, px.
        """
        x, y, width, height = self.box
        return x + _LEFT, y + _ABOVE, width - _LEFT - _RIGHT, height - _ABOVE - _BELOW

    def px(self, points: ArrayLike) -> NDArray[np.float64]:
        """Places of values on the canvas.

        Parameters
        ----------
        points : array_like, shape (n, 2)
            Values (x, y) in the units of the axes.

        Returns
        -------
        ndarray, shape (n, 2)
            (x, y), px of the canvas, kept within the plotted area.
        """
        x, y, width, height = self.area
        values = np.asarray(points, float).reshape(-1, 2)
        # shares of the axes' lengths; y counts up, the canvas down
        across = (values[:, 0] - self.x[0]) / (self.x[1] - self.x[0])
        low, high, ups = *self._scaled(np.array(self.y)), self._scaled(values[:, 1])
        up = (ups - low) / (high - low)
        return np.column_stack([x + width * np.clip(across, 0, 1), y + height * (1 - np.clip(up, 0, 1))])

    def frame(self, canvas: Canvas, title: str, x_name: str) -> None:
        """Draw axes, ticks and names.

        Parameters
        ----------
        canvas : Canvas
        title : str
            What y is, with its unit.
        x_name : str
            What x is, with its unit.
        """
        x, y, width, height = self.area
        # a pale line at each tick of y, a short mark at each of x
        values = self._ticks_y()
        for value, name in zip(values, _names(values), strict=True):
            (_, at), *_ = self.px([[self.x[0], value]])
            canvas.line([(x, at), (x + width, at)], PALE, width=1)
            canvas.text(x - 6, at, name, size=11, colour=GREY, anchor="rm")
        for value in _ticks(*self.x):
            (at, _), *_ = self.px([[value, self.y[0]]])
            canvas.line([(at, y + height), (at, y + height + 4)], BLACK, width=1)
            canvas.text(at, y + height + 7, f"{value:g}", size=11, colour=GREY, anchor="ma")
        # the axes over these, then their names
        canvas.line([(x, y), (x, y + height), (x + width, y + height)], BLACK, width=1)
        canvas.text(self.box[0] + 8, y - 11, title, size=13)
        canvas.text(x + width, y + height + 36, x_name, size=12, anchor="rs")

    def bars(self, canvas: Canvas, edges: NDArray, counts: NDArray, colour: str) -> None:
        """Draw a histogram.

        Parameters
        ----------
        canvas : Canvas
        edges : ndarray, shape (n + 1,)
            In units of x.
        counts : ndarray, shape (n,)
            In units of y.
        colour : str
        """
        # from each count down to the x axis; half a pixel wide at least, to be seen
        base = self.area[1] + self.area[3]
        tops = self.px(np.column_stack([edges[:-1], counts]))
        ends = self.px(np.column_stack([edges[1:], counts]))
        for (left, top), (right, _) in zip(tops, ends, strict=True):
            canvas.area((left, top, max(right - left, 0.5), base - top), colour)

    def upright(
        self, canvas: Canvas, value: float, colour: str, *, width: float = 2.0, dash: tuple[float, float] | None = None
    ) -> None:
        """Draw an upright line.

        Parameters
        ----------
        canvas : Canvas
        value : float
            Where on the x axis.
        colour : str
        width : float
            px.
        dash : tuple of float, optional
            Length of a dash and of the space after it, px.
        """
        (at, _), *_ = self.px([[value, self.y[0]]])
        canvas.line([(at, self.area[1]), (at, self.area[1] + self.area[3])], colour, width=width, dash=dash)

    def level(self, canvas: Canvas, value: float, colour: str, *, dash: tuple[float, float] | None = None) -> None:
        """Draw a level line.

        Parameters
        ----------
        canvas : Canvas
        value : float
            Where on the y axis.
        colour : str
        dash : tuple of float, optional
            Length of a dash and of the space after it, px.
        """
        canvas.line(self.px([[self.x[0], value], [self.x[1], value]]), colour, width=1.5, dash=dash)

    def _scaled(self, values: NDArray) -> NDArray[np.float64]:
        """Values of y as they are laid out along the axis."""
        return np.log10(np.maximum(values, 1e-30)) if self.log else values.astype(float)

    def _ticks_y(self) -> NDArray[np.float64]:
        """Where y has ticks: round values, or powers of ten."""
        if not self.log:
            return _ticks(*self.y)
        # at most about five powers, evenly apart
        low, high = np.ceil(np.log10(self.y[0])), np.floor(np.log10(self.y[1]))
        return 10.0 ** np.arange(low, high + 1, max(1, (high - low) // 4))


def _names(values: NDArray[np.float64]) -> list[str]:
    """How ticks are written: all of them as numbers, or all as powers of ten where some would be long."""
    if not len(values) or (np.abs(values).max() <= _LARGEST and np.abs(values[values != 0]).min() >= 1 / _LARGEST):
        return [f"{value:g}" for value in values]
    powers = (str(round(np.log10(value))) for value in values)
    return ["10" + power.translate(_RAISED) for power in powers]


def _ticks(low: float, high: float) -> NDArray[np.float64]:
    """About four round values between two limits."""
    step = round_length((high - low) / 3)
    return np.round(np.arange(np.ceil(low / step), np.floor(high / step) + 1) * step, 10) + 0.0  # no "-0"
