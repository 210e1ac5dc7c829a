"""Slices -> pixels: grey values, tints, and the part of a slice that is seen.

Frames: slices in (row, col) px; the canvas in (x, y) px, y down.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .palette import WHITE, rgb_of

RGB = NDArray[np.uint8]
"""Pixels, shape (H, W, 3)."""


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
        """The smallest window with square pixels that holds a part of a slice.

        Parameters
        ----------
        box : tuple of float
            x, y, width, height on the canvas, px.
        low, high : array_like, shape (2,)
            First and last (row, col), px of the slice.

        Returns
        -------
        Window
            With `low` to `high` in its middle.

        Examples
        --------
        >>> Window.around((0, 0, 200, 100), (10, 10), (20, 20)).cols
        (5.0, 25.0)
        """
        low, high = np.asarray(low, float), np.asarray(high, float)
        zoom = min(box[3] / (high[0] - low[0]), box[2] / (high[1] - low[1]))
        middle, half = (low + high) / 2, np.array([box[3], box[2]]) / zoom / 2
        (top, left), (bottom, right) = (middle - half).tolist(), (middle + half).tolist()
        return cls(box, (top, bottom), (left, right))

    @classmethod
    def whole(cls, box: tuple[float, float, float, float], shape: tuple[int, ...]) -> Window:
        """A window that holds a whole slice.

        Parameters
        ----------
        box : tuple of float
            x, y, width, height on the canvas, px.
        shape : tuple of int
            Rows and columns of the slice.

        Returns
        -------
        Window
        """
        return cls.around(box, (-0.5, -0.5), (shape[0] - 0.5, shape[1] - 0.5))

    @property
    def zoom(self) -> float:
        """Canvas px per slice px.

        Returns
        -------
        float
        """
        return self.box[2] / (self.cols[1] - self.cols[0])

    def px(self, points: ArrayLike) -> NDArray[np.float64]:
        """Places of a slice on the canvas.

        Parameters
        ----------
        points : array_like, shape (..., 2)
            (row, col), px of the slice.

        Returns
        -------
        ndarray, shape (..., 2)
            (x, y), px of the canvas.

        Examples
        --------
        >>> Window((0, 0, 100, 100), (0, 50), (0, 50)).px([10, 20]).tolist()
        [40.0, 20.0]
        """
        corner = np.array([self.rows[0], self.cols[0]])
        return ((np.asarray(points, float) - corner) * self.zoom)[..., ::-1] + np.array(self.box[:2])


def tinted(rgb: RGB, mask: NDArray[np.bool_], colour: str, alpha: float = 1.0) -> RGB:
    """A picture with a colour laid over a mask.

    Parameters
    ----------
    rgb : ndarray of uint8, shape (R, C, 3)
    mask : ndarray of bool, shape (R, C)
    colour : str
        "#RRGGBB".
    alpha : float
        Share of the colour, 0 to 1.

    Returns
    -------
    ndarray of uint8, shape (R, C, 3)

    Examples
    --------
    >>> tinted(plain((1, 2)), np.array([[True, False]]), "#000000", 0.6).tolist()
    [[[102, 102, 102], [255, 255, 255]]]
    """
    out = rgb.copy()
    out[mask] = ((1 - alpha) * rgb[mask] + alpha * np.array(rgb_of(colour))).astype(np.uint8)
    return out


def plain(shape: tuple[int, ...], colour: str = WHITE) -> RGB:
    """A picture of one colour.

    Parameters
    ----------
    shape : tuple of int
        Rows and columns.
    colour : str
        "#RRGGBB".

    Returns
    -------
    ndarray of uint8, shape (R, C, 3)

    Examples
    --------
    >>> plain((2, 3)).shape
    (2, 3, 3)
    """
    return np.full((*shape[:2], 3), rgb_of(colour), np.uint8)


def windowed(hu: NDArray, centre: float, width: float) -> RGB:
    """CT numbers as grey.

    Parameters
    ----------
    hu : ndarray, shape (R, C)
    centre, width : float
        HU: black below ``centre - width / 2``, white above ``centre + width / 2``.

    Returns
    -------
    ndarray of uint8, shape (R, C, 3)

    Examples
    --------
    >>> windowed(np.array([[-1000, 40, 1000]]), 40, 80)[0, :, 0].tolist()
    [0, 127, 255]
    """
    level = np.clip((hu.astype(np.float32) - (centre - width / 2)) * (255 / width), 0, 255).astype(np.uint8)
    return np.repeat(level[..., None], 3, axis=2)
