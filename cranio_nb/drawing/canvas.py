"""Arrays and curves -> a picture as an RGB array, in a few milliseconds: fast enough to follow a slider.

Frames: canvas (x, y) px, y down; slices in (row, col) px through a `Window`; charts in their own units through a
`Chart`. Everything is drawn at twice the size and halved at the end, which smooths lines and letters.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image, ImageDraw, ImageFont

from .palette import BLACK, WHITE, side_letter
from .pixels import RGB, Window

_SCALE = 2  # drawn larger by this
_LETTER = 12  # px from an edge to the middle of the letter of a side


class Canvas:
    """A white picture to draw on.

    Parameters
    ----------
    width, height : int
        px of the finished picture.

    Examples
    --------
    >>> canvas = Canvas(120, 80)
    >>> canvas.line([(0, 40), (120, 40)], "#0072B2")
    >>> canvas.array().shape
    (80, 120, 3)
    """

    def __init__(self, width: int, height: int) -> None:
        self._image = Image.new("RGB", (_SCALE * width, _SCALE * height), WHITE)
        self._draw = ImageDraw.Draw(self._image)

    def copy(self) -> Canvas:
        """The same picture, to draw on further.

        Returns
        -------
        Canvas
        """
        other = Canvas(1, 1)
        other._image = self._image.copy()
        other._draw = ImageDraw.Draw(other._image)
        return other

    def array(self) -> RGB:
        """The finished picture.

        Returns
        -------
        ndarray of uint8, shape (height, width, 3)
        """
        return np.asarray(self._image.reduce(_SCALE))

    def place(self, rgb: RGB, x: float, y: float) -> None:
        """Put pixels on the canvas, one for one.

        Parameters
        ----------
        rgb : ndarray of uint8, shape (H, W, 3)
        x, y : float
            Their upper left corner.
        """
        large = Image.fromarray(rgb).resize((_SCALE * rgb.shape[1], _SCALE * rgb.shape[0]), Image.Resampling.NEAREST)
        self._image.paste(large, (round(_SCALE * x), round(_SCALE * y)))

    def inlay(self, other: Canvas, x: float, y: float) -> None:
        """Put another canvas on this one.

        Parameters
        ----------
        other : Canvas
        x, y : float
            Its upper left corner.
        """
        self._image.paste(other._image, (round(_SCALE * x), round(_SCALE * y)))

    def show(self, rgb: RGB, window: Window, *, smooth: bool = False) -> None:
        """Show a slice in a window.

        Parameters
        ----------
        rgb : ndarray of uint8, shape (R, C, 3)
        window : Window
        smooth : bool
            Interpolate between pixels; otherwise each is a square.
        """
        x, y, width, height = (round(v) for v in window.box)
        (top, bottom), (left, right) = window.rows, window.cols
        extent = (left + 0.5, top + 0.5, right + 0.5, bottom + 0.5)  # of pixel edges, not centres
        size, resample = (_SCALE * width, _SCALE * height), Image.Resampling.NEAREST
        if smooth and window.zoom != 1:  # interpolate at the finished size, where it is seen
            size, resample = (width, height), Image.Resampling.BILINEAR
        # what the window sees beyond the slice is white
        part = Image.fromarray(rgb).transform(size, Image.Transform.EXTENT, extent, resample, fillcolor=WHITE)
        if part.size != (_SCALE * width, _SCALE * height):
            part = part.resize((_SCALE * width, _SCALE * height), Image.Resampling.NEAREST)
        self._image.paste(part, (_SCALE * x, _SCALE * y))

    def line(
        self, points: ArrayLike, colour: str, *, width: float = 2.0, dash: tuple[float, float] | None = None
    ) -> None:
        """Draw a polyline.

        Parameters
        ----------
        points : array_like, shape (n, 2)
            (x, y).
        colour : str
        width : float
            px.
        dash : tuple of float, optional
            Length of a dash and of the space after it, px.
        """
        pieces = [np.asarray(points, float)] if dash is None else _dashes(np.asarray(points, float), *dash)
        for piece in pieces:
            flat = [tuple(p) for p in _SCALE * piece]
            self._draw.line(flat, fill=colour, width=max(1, round(_SCALE * width)), joint="curve")

    def dots(self, points: ArrayLike, colour: str, *, radius: float = 2.0, edge: str | None = None) -> None:
        """Draw discs.

        Parameters
        ----------
        points : array_like, shape (n, 2)
            (x, y) of their middles.
        colour : str
        radius : float
            px.
        edge : str, optional
            Colour of an edge.
        """
        r = _SCALE * radius
        for x, y in _SCALE * np.asarray(points, float).reshape(-1, 2):
            self._draw.ellipse((x - r, y - r, x + r, y + r), fill=colour, outline=edge, width=_SCALE)

    def arrow(self, start: ArrayLike, tip: ArrayLike, colour: str, *, width: float = 2.5) -> None:
        """Draw an arrow.

        Parameters
        ----------
        start, tip : array_like, shape (2,)
            (x, y).
        colour : str
        width : float
            px of the shaft.
        """
        a, b = np.asarray(start, float), np.asarray(tip, float)
        # unit vectors along and across the shaft; the head is five widths long
        along = (b - a) / max(float(np.hypot(*(b - a))), 1e-9)
        across = np.array([-along[1], along[0]])
        neck = b - 5 * width * along
        self.line([a, neck], colour, width=width)
        head = _SCALE * np.array([b, neck + 2 * width * across, neck - 2 * width * across])
        self._draw.polygon([tuple(p) for p in head], fill=colour)

    def area(self, box: tuple[float, float, float, float], colour: str) -> None:
        """Fill a box.

        Parameters
        ----------
        box : tuple of float
            x, y, width, height; nothing is drawn where one of the sizes is not positive.
        colour : str
        """
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
        """Write a line of text.

        Parameters
        ----------
        x, y : float
        text : str
        size : int
            px.
        colour : str
        anchor : str
            What of the text is at (x, y), as in Pillow, e.g. "ls" its left end on the base line.
        halo : bool
            White around the letters, to be read on any ground.
        """
        rim = 2 * _SCALE if halo else 0
        at = (_SCALE * x, _SCALE * y)
        self._draw.text(at, text, colour, _font(_SCALE * size), anchor, stroke_width=rim, stroke_fill=WHITE)

    def scale_bar(self, x: float, y: float, length: float, text: str) -> None:
        """Draw a scale bar with its length written above.

        Parameters
        ----------
        x, y : float
            Its left end.
        length : float
            px.
        text : str
            Its length in words, e.g. "20 mm".
        """
        self.line([(x, y), (x + length, y)], WHITE, width=7)
        self.line([(x + 1, y), (x + length - 1, y)], BLACK, width=3)
        self.text(x, y - 8, text, halo=True)

    def sides(
        self, box: tuple[float, float, float, float], right: ArrayLike = (1, 0, 0), down: ArrayLike = (0, 1, 0)
    ) -> None:
        """Write the letters of the patient's sides at the edges of a picture of a head.

        Parameters
        ----------
        box : tuple of float
            x, y, width and height of the picture, px.
        right, down : array_like, shape (3,)
            Where they lead in the head, LPS; by default those of an axial slice.
        """
        x, y, width, height = box
        for way, across, along in ((np.asarray(right, float), 0.5, 0.0), (np.asarray(down, float), 0.0, 0.5)):
            for sign in (-1, 1):
                left = x + width / 2 + 2 * sign * across * (width / 2 - _LETTER)
                top = y + height / 2 + 2 * sign * along * (height / 2 - _LETTER)
                self.text(left, top, side_letter(sign * way), size=14, anchor="mm", halo=True)

    def legend(self, x: float, y: float, entries: Sequence[tuple[str | Sequence[str], str, str]]) -> None:
        """Draw a legend, one entry below the other, on white.

        Parameters
        ----------
        x, y : float
            Its upper left corner.
        entries : sequence of (colour, kind, text)
            The kind is "line", "dash", "dot" or "area"; an area may have several colours, drawn from left to right.
        """
        # as wide as the longest text, 18 px for each entry
        font = _font(_SCALE * 12)
        width = max(font.getlength(text) for _, _, text in entries) / _SCALE + 44
        self.area((x, y, width, 18 * len(entries) + 6), WHITE)
        for i, (colour, kind, text) in enumerate(entries):
            middle = y + 12 + 18 * i
            if not isinstance(colour, str):
                for k, tone in enumerate(colour):
                    self.area((x + 8 + 20 * k / len(colour), middle - 5, 20 / len(colour), 10), tone)
            elif kind == "area":
                self.area((x + 8, middle - 5, 20, 10), colour)
            elif kind == "dot":
                self.dots([(x + 18, middle)], colour, radius=4, edge=BLACK)
            else:
                self.line([(x + 6, middle), (x + 30, middle)], colour, width=3, dash=(6, 4) if kind == "dash" else None)
            self.text(x + 36, middle, text, size=12, anchor="lm")


def round_length(longest: float) -> float:
    """A round length for a scale bar or between ticks: 1, 2 or 5 times a power of ten.

    Parameters
    ----------
    longest : float
        Positive, in any unit.

    Returns
    -------
    float
        The largest one that is not above `longest`.

    Examples
    --------
    >>> round_length(37.0), round_length(0.9)
    (20.0, 0.5)
    """
    # the power of ten below, times 1, 2 or 5
    power = 10.0 ** np.floor(np.log10(longest))
    return float(max(step * power for step in (1, 2, 5) if step * power <= longest))


def _dashes(points: NDArray, on: float, off: float) -> list[NDArray]:
    """A polyline cut into dashes."""
    # `at` is the length along the line up to each of its points
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
