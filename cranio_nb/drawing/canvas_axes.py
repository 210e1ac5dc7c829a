"""Numbers -> a small chart on a canvas: axes, lines, bars, marks.

Frame: values in their own units inside, canvas (x, y) px outside.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .canvas import BLACK, GREY, PALE, Canvas, round_length

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
    """

    box: tuple[float, float, float, float]
    x: tuple[float, float]
    y: tuple[float, float]
    log: bool = False

    @property
    def area(self) -> tuple[float, float, float, float]:
        """x, y, width, height of the plotted area."""
        x, y, width, height = self.box
        return x + _LEFT, y + _ABOVE, width - _LEFT - _RIGHT, height - _ABOVE - _BELOW

    def px(self, points: ArrayLike) -> NDArray[np.float64]:
        """Values (x, y) -> canvas px, shape (n, 2), kept within the plotted area."""
        x, y, width, height = self.area
        values = np.asarray(points, float).reshape(-1, 2)
        across = (values[:, 0] - self.x[0]) / (self.x[1] - self.x[0])
        low, high, ups = *self._scaled(np.array(self.y)), self._scaled(values[:, 1])
        up = (ups - low) / (high - low)
        return np.column_stack([x + width * np.clip(across, 0, 1), y + height * (1 - np.clip(up, 0, 1))])

    def frame(self, canvas: Canvas, title: str, x_name: str) -> None:
        """Draw axes, ticks and names; the title says what y is, with its unit."""
        x, y, width, height = self.area
        for value in self._ticks_y():
            (_, at), *_ = self.px([[self.x[0], value]])
            canvas.line([(x, at), (x + width, at)], PALE, width=1)
            canvas.text(x - 6, at, f"{value:g}", size=11, colour=GREY, anchor="rm")
        for value in _ticks(*self.x):
            (at, _), *_ = self.px([[value, self.y[0]]])
            canvas.line([(at, y + height), (at, y + height + 4)], BLACK, width=1)
            canvas.text(at, y + height + 7, f"{value:g}", size=11, colour=GREY, anchor="ma")
        canvas.line([(x, y), (x, y + height), (x + width, y + height)], BLACK, width=1)
        canvas.text(self.box[0] + 8, y - 11, title, size=13)
        canvas.text(x + width, y + height + 36, x_name, size=12, anchor="rs")

    def bars(self, canvas: Canvas, edges: NDArray, counts: NDArray, colour: str) -> None:
        """Draw a histogram: counts of shape (n,) between edges of shape (n + 1,)."""
        base = self.area[1] + self.area[3]
        tops = self.px(np.column_stack([edges[:-1], counts]))
        ends = self.px(np.column_stack([edges[1:], counts]))
        for (left, top), (right, _) in zip(tops, ends, strict=True):
            canvas.area((left, top, max(right - left, 0.5), base - top), colour)

    def upright(
        self, canvas: Canvas, value: float, colour: str, *, width: float = 2.0, dash: tuple[float, float] | None = None
    ) -> None:
        """Draw an upright line at a value of x."""
        (at, _), *_ = self.px([[value, self.y[0]]])
        canvas.line([(at, self.area[1]), (at, self.area[1] + self.area[3])], colour, width=width, dash=dash)

    def level(self, canvas: Canvas, value: float, colour: str, *, dash: tuple[float, float] | None = None) -> None:
        """Draw a level line at a value of y."""
        canvas.line(self.px([[self.x[0], value], [self.x[1], value]]), colour, width=1.5, dash=dash)

    def _scaled(self, values: NDArray) -> NDArray[np.float64]:
        return np.log10(np.maximum(values, 1e-30)) if self.log else values.astype(float)

    def _ticks_y(self) -> NDArray[np.float64]:
        if not self.log:
            return _ticks(*self.y)
        low, high = np.ceil(np.log10(self.y[0])), np.floor(np.log10(self.y[1]))
        return 10.0 ** np.arange(low, high + 1, max(1, (high - low) // 4))


def _ticks(low: float, high: float) -> NDArray[np.float64]:
    """About four round values between two limits."""
    step = round_length((high - low) / 3)
    return np.round(np.arange(np.ceil(low / step), np.floor(high / step) + 1) * step, 10)
