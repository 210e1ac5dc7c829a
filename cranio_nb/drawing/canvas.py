"""Arrays and curves -> a picture as an RGB array, in a few milliseconds: what moves under a slider is drawn here.

Frames: canvas (x, y) px, y down; slices in (row, col) px through a `Window`; charts in their own units through a
`Chart`. Everything is drawn at twice the size and halved at the end, which smooths lines and letters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw, ImageFont

RGB = NDArray[np.uint8]
WHITE, BLACK, ORANGE, SKY, GREEN = "#FFFFFF", "#000000", "#E69F00", "#56B4E9", "#009E73"
YELLOW, BLUE, VERMILLION, PURPLE = "#F0E442", "#0072B2", "#D55E00", "#CC79A7"
BONE, GREY, PALE = "#D8D2C4", "#595959", "#DADADA"
_SCALE = 2


class Canvas:
    """A white picture to draw on.

    Parameters
    ----------
    width, height : int
        px of the finished picture.
    """

    def __init__(self, width: int, height: int) -> None:
        self._image = Image.new("RGB", (_SCALE * width, _SCALE * height), WHITE)
        self._draw = ImageDraw.Draw(self._image)

    def copy(self) -> Canvas:
        """The same picture, to draw on further."""
        other = Canvas(1, 1)
        other._image = self._image.copy()
        other._draw = ImageDraw.Draw(other._image)
        return other

    def array(self) -> RGB:
        """The finished picture, shape (height, width, 3)."""
        return np.asarray(self._image.reduce(_SCALE))

    def place(self, rgb: RGB, x: float, y: float) -> None:
        """Put an RGB array with its upper left corner at (x, y), one pixel for one."""
        large = Image.fromarray(rgb).resize((_SCALE * rgb.shape[1], _SCALE * rgb.shape[0]), Image.Resampling.NEAREST)
        self._image.paste(large, (round(_SCALE * x), round(_SCALE * y)))

    def inlay(self, other: Canvas, x: float, y: float) -> None:
        """Put another canvas with its upper left corner at (x, y)."""
        self._image.paste(other._image, (round(_SCALE * x), round(_SCALE * y)))

    def show(self, rgb: RGB, window: Window, *, smooth: bool = False) -> None:
        """Show a slice, shape (R, C, 3), in a window."""
        x, y, width, height = (round(v) for v in window.box)
        (top, bottom), (left, right) = window.rows, window.cols
        extent = (left + 0.5, top + 0.5, right + 0.5, bottom + 0.5)  # of pixel edges, not centres
        size, resample = (_SCALE * width, _SCALE * height), Image.Resampling.NEAREST
        if smooth and window.zoom != 1:  # interpolate at the finished size, where it is seen
            size, resample = (width, height), Image.Resampling.BILINEAR
        part = Image.fromarray(rgb).transform(size, Image.Transform.EXTENT, extent, resample, fillcolor=WHITE)
        if part.size != (_SCALE * width, _SCALE * height):
            part = part.resize((_SCALE * width, _SCALE * height), Image.Resampling.NEAREST)
        self._image.paste(part, (_SCALE * x, _SCALE * y))

    def line(
        self, points: ArrayLike, colour: str, *, width: float = 2.0, dash: tuple[float, float] | None = None
    ) -> None:
        """Draw a polyline through canvas points, shape (n, 2); `dash` is (on, off) in px."""
        pieces = [np.asarray(points, float)] if dash is None else _dashes(np.asarray(points, float), *dash)
        for piece in pieces:
            flat = [tuple(p) for p in _SCALE * piece]
            self._draw.line(flat, fill=colour, width=max(1, round(_SCALE * width)), joint="curve")

    def dots(self, points: ArrayLike, colour: str, *, radius: float = 2.0, edge: str | None = None) -> None:
        """Draw discs at canvas points, shape (n, 2), with an edge where one is named."""
        r = _SCALE * radius
        for x, y in _SCALE * np.asarray(points, float).reshape(-1, 2):
            self._draw.ellipse((x - r, y - r, x + r, y + r), fill=colour, outline=edge, width=_SCALE)

    def arrow(self, start: ArrayLike, tip: ArrayLike, colour: str, *, width: float = 2.5) -> None:
        """Draw an arrow between two canvas points."""
        a, b = np.asarray(start, float), np.asarray(tip, float)
        along = (b - a) / max(float(np.hypot(*(b - a))), 1e-9)
        across = np.array([-along[1], along[0]])
        neck = b - 5 * width * along
        self.line([a, neck], colour, width=width)
        head = _SCALE * np.array([b, neck + 2 * width * across, neck - 2 * width * across])
        self._draw.polygon([tuple(p) for p in head], fill=colour)

    def area(self, box: tuple[float, float, float, float], colour: str) -> None:
        """Fill a box (x, y, width, height)."""
        x, y, width, height = (_SCALE * v for v in box)
        if width > 0 and height > 0:
            self._draw.rectangle((x, y, max(x, x + width - 1), max(y, y + height - 1)), fill=colour)

    def text(
        self,
        x: float,
        y: float,
        text: str,
        *,
        size: int = 13,
        colour: str = BLACK,
        anchor: str = "ls",
        halo: bool = False,
    ) -> None:
        """Write at (x, y); `anchor` as in Pillow, e.g. "ls" left on the base line; `halo` for uneven ground."""
        rim = 2 * _SCALE if halo else 0
        at = (_SCALE * x, _SCALE * y)
        self._draw.text(at, text, colour, _font(_SCALE * size), anchor, stroke_width=rim, stroke_fill=WHITE)

    def scale_bar(self, x: float, y: float, length: float, text: str) -> None:
        """A bar of `length` px whose left end stands at (x, y), with its length written above."""
        self.line([(x, y), (x + length, y)], WHITE, width=7)
        self.line([(x + 1, y), (x + length - 1, y)], BLACK, width=3)
        self.text(x, y - 8, text, halo=True)

    def legend(self, x: float, y: float, entries: Sequence[tuple[str, str, str]]) -> None:
        """Entries (colour, "line" | "dash" | "dot" | "area", text), one below the other, on white."""
        font = _font(_SCALE * 12)
        width = max(font.getlength(text) for _, _, text in entries) / _SCALE + 44
        self.area((x, y, width, 18 * len(entries) + 6), WHITE)
        for i, (colour, kind, text) in enumerate(entries):
            middle = y + 12 + 18 * i
            if kind == "area":
                self.area((x + 8, middle - 5, 20, 10), colour)
            elif kind == "dot":
                self.dots([(x + 18, middle)], colour, radius=4, edge=BLACK)
            else:
                self.line([(x + 6, middle), (x + 30, middle)], colour, width=3, dash=(6, 4) if kind == "dash" else None)
            self.text(x + 36, middle, text, size=12, anchor="lm")


@dataclass(frozen=True)
class Window:
    """The part of a slice that is seen, and where on the canvas.

    Parameters
    ----------
    box : tuple of float
        x, y, width, height on the canvas, px.
    rows, cols : tuple of float
        First and last (row, col) seen, px of the slice.
    """

    box: tuple[float, float, float, float]
    rows: tuple[float, float]
    cols: tuple[float, float]

    @classmethod
    def around(cls, box: tuple[float, float, float, float], low: ArrayLike, high: ArrayLike) -> Window:
        """The smallest window with square pixels that holds the (row, col) from `low` to `high`."""
        low, high = np.asarray(low, float), np.asarray(high, float)
        zoom = min(box[3] / (high[0] - low[0]), box[2] / (high[1] - low[1]))
        middle, half = (low + high) / 2, np.array([box[3], box[2]]) / zoom / 2
        (top, left), (bottom, right) = (middle - half).tolist(), (middle + half).tolist()
        return cls(box, (top, bottom), (left, right))

    @classmethod
    def whole(cls, box: tuple[float, float, float, float], shape: tuple[int, ...]) -> Window:
        """A whole slice of given shape (R, C)."""
        return cls.around(box, (-0.5, -0.5), (shape[0] - 0.5, shape[1] - 0.5))

    @property
    def zoom(self) -> float:
        """Canvas px per slice px."""
        return self.box[2] / (self.cols[1] - self.cols[0])

    def px(self, points: ArrayLike) -> NDArray[np.float64]:
        """Slice (row, col) -> canvas (x, y), shape (..., 2)."""
        corner = np.array([self.rows[0], self.cols[0]])
        return ((np.asarray(points, float) - corner) * self.zoom)[..., ::-1] + np.array(self.box[:2])


def tinted(rgb: RGB, mask: NDArray[np.bool_], colour: str, alpha: float = 1.0) -> RGB:
    """A picture with a colour laid over the mask, shape (R, C, 3)."""
    out = rgb.copy()
    out[mask] = ((1 - alpha) * rgb[mask] + alpha * np.array(rgb_of(colour))).astype(np.uint8)
    return out


def plain(shape: tuple[int, ...], colour: str = WHITE) -> RGB:
    """An even picture of shape (R, C, 3)."""
    return np.full((*shape[:2], 3), rgb_of(colour), np.uint8)


def windowed(hu: NDArray, centre: float, width: float) -> RGB:
    """HU -> grey, shape (R, C, 3): black below ``centre - width / 2``, white above ``centre + width / 2``."""
    level = np.clip((hu.astype(np.float32) - (centre - width / 2)) * (255 / width), 0, 255).astype(np.uint8)
    return np.repeat(level[..., None], 3, axis=2)


def rgb_of(colour: str) -> tuple[int, int, int]:
    """Red, green, blue of a name like "#0072B2", 0 to 255."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def round_length(longest: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above `longest`."""
    power = 10.0 ** np.floor(np.log10(longest))
    return float(max(step * power for step in (1, 2, 5) if step * power <= longest))


def _dashes(points: NDArray, on: float, off: float) -> list[NDArray]:
    """A polyline cut into dashes."""
    at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    pieces = []
    for start in np.arange(0.0, at[-1], on + off):
        end = min(start + on, at[-1])
        inside = at[(at > start) & (at < end)]
        steps = np.concatenate([[start], inside, [end]])
        pieces.append(np.stack([np.interp(steps, at, axis) for axis in points.T], axis=1))
    return pieces


@lru_cache(maxsize=16)
def _font(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    """DejaVu Sans, which comes with matplotlib and has Greek letters; Pillow's own where that is missing."""
    spec = find_spec("matplotlib")
    path = Path(spec.origin).parent / "mpl-data/fonts/ttf/DejaVuSans.ttf" if spec and spec.origin else None
    return ImageFont.truetype(str(path), size) if path and path.is_file() else ImageFont.load_default(size)
