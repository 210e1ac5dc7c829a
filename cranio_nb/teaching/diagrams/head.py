"""A skull, seen from somewhere, on which places of the world can be drawn.

Frames: the world in mm (LPS); the drawing in pixels of the picture, to the right and down.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...drawing import shading
from ...drawing.coarse_skull import skull_surface
from ...drawing.figures import Axes, Figure
from ...drawing.palette import SKULL, rgb_shares
from ...volume import Volume
from . import marks

_PIXEL_MM = 0.45


@dataclass(frozen=True, eq=False)
class Head:
    """A drawn skull.

    Parameters
    ----------
    ax : Axes
    picture : Picture
    """

    ax: Axes
    picture: shading.Picture

    def place(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where places are drawn.

        Parameters
        ----------
        points : ndarray, shape (n, 3)
            World mm.

        Returns
        -------
        ndarray, shape (n, 2)
        """
        return np.array([self.picture.pixel_of(point) for point in points])


def draw_head(figure: Figure, box: tuple[float, float, float, float], bone: Volume, towards: ArrayLike) -> Head:
    """Draw a skull in a part of a drawing, with the letters of its sides.

    Parameters
    ----------
    figure : Figure
    box : tuple of float
        As for `marks.plane`.
    bone : Volume
        Bool mask.
    towards : array_like, shape (3,)
        From the head to the viewer, LPS.

    Returns
    -------
    Head
    """
    seen = shading.render([shading.Solid(skull_surface(bone), rgb_shares(SKULL))], towards, px_mm=_PIXEL_MM)
    height, width = seen.rgb.shape[:2]
    wide_in, high_in = figure.get_size_inches() * box[2:]
    wide = max(width, height * wide_in / high_in)
    high = wide * high_in / wide_in
    ax = marks.plane(figure, box, (0, 0), wide)
    ax.imshow(seen.rgb, extent=(-0.5, width - 0.5, height - 0.5, -0.5), interpolation="nearest", aspect="auto")
    ax.set(xlim=((width - wide) / 2, (width + wide) / 2), ylim=((height + high) / 2, (height - high) / 2))
    marks.sides(ax, seen.frame.axes[:2])
    return Head(ax, seen)
