"""The floor inside the skull as a height map: what closes the braincase towards orbits, nose and ears.

Frame: head mm. The floor is a plate, 1 to 7 mm thick. The heights of its top and bottom over (x, y) are given on a grid
of 0.5 mm and are linear between its points; that grid is the truth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Array = NDArray[np.float64]

CEILING = 16.0
"""mm: the floor nowhere rises higher."""
DEEP = -78.0
"""mm: the floor's height behind the ear bones, where the braincase itself is the floor."""
_STEP, _HALF = 0.5, (84.0, 112.0)


@dataclass(frozen=True, eq=False)
class BaseMap:
    """Top and bottom of the plate that is the skull's floor.

    Parameters
    ----------
    top, bottom : ndarray, shape (X, Y)
        Heights in mm on the grid.
    slope : ndarray, shape (X, Y)
        Length of the gradient of z - top.
    """

    top: Array
    bottom: Array
    slope: Array

    def at(self, x: Array, y: Array) -> tuple[Array, Array, Array]:
        """Heights of the plate's top and bottom, and slope, at head coordinates.

        Parameters
        ----------
        x, y : ndarray, shape (...)
            mm.

        Returns
        -------
        tuple of ndarray, shape (...)
            Top and bottom in mm, linear between the grid's points; the nearest point's slope.
        """
        index = np.array([(x + _HALF[0]) / _STEP, (y + _HALF[1]) / _STEP])
        heights = (ndimage.map_coordinates(field, index, order=1, mode="nearest") for field in (self.top, self.bottom))
        row, col = np.clip(np.rint(index).astype(int).T, 0, np.array(self.slope.shape) - 1).T
        top, bottom = heights
        return top, bottom, self.slope[row, col]


def base_map(rng: np.random.Generator) -> BaseMap:
    """The floor of one head.

    Parameters
    ----------
    rng : Generator
        Varies the heights by 2 or 3 mm and the roofs' thickness by half.

    Returns
    -------
    BaseMap
        Left and right alike.
    """
    x, y = np.meshgrid(*(np.arange(-half, half + _STEP / 2, _STEP) for half in _HALF), indexing="ij")
    lift = rng.uniform([-0.5, -2.0, -2.0], [3.0, 2.0, 2.0])
    thin = rng.uniform(0.7, 2.5)
    height = _height(np.abs(x), y, lift)
    slope = np.sqrt(1 + sum(g**2 for g in np.gradient(height, _STEP)))
    return BaseMap(height, height - slope * _thickness(np.abs(x), y, thin), slope)


def _step(value: Array, width: float) -> Array:
    """0 to 1 as a value in mm rises through 0."""
    return 1 / (1 + np.exp(-np.clip(value / width, -60, 60)))


def _height(x: Array, y: Array, lift: Array) -> Array:
    # Front: roofs of the orbits, with the sieve plate sunk between them; it ends at the wing of the sphenoid.
    front = -3.0 + 5.0 * np.exp(-(((x - 34) / 17) ** 2)) - 3.0 * np.exp(-((x / 6) ** 2)) + lift[0]
    front = front - (0.27 - 0.16 * np.exp(-((x / 8) ** 2))) * np.maximum(y + 80, 0)  # the roofs fall to the back
    front = front + 0.06 * np.maximum(x - 40, 0) ** 1.2
    # Middle: a saddle on the axis, and the deep middle pits beside it.
    saddle = -9.0 - 5.0 * np.exp(-(((y + 17) / 5) ** 2)) + 2.0 * np.exp(-(((y + 6) / 3) ** 2)) + lift[1]
    pits = -29.0 + 0.012 * np.maximum(x - 45, 0) ** 2 + lift[2]
    middle = saddle + (pits - saddle) * _step(x - 13, 1.8)
    # The ear bone's ridge runs back and outwards from the saddle; behind it the floor falls to the braincase.
    along = y - (-6.0 + 0.42 * x)
    middle = middle + 14.0 * _step(x - 12, 3.0) * np.exp(-((along / 6.0) ** 2))
    behind = np.minimum(0.0, -2.6 * np.maximum(along - 3.0, 0.0))
    middle = np.maximum(middle + behind, DEEP)
    wing = -29.0 - 0.003 * x**2
    return front + (middle - front) * _step(y - wing, 1.6)


def _thickness(x: Array, y: Array, thin: float) -> Array:
    roof = (
        0.3 * thin * (1 + 0.5 * np.sin(0.31 * x + 1.0) * np.sin(0.27 * y))
        + 2.2 * _step(x - 50, 2.5)
        + 2.5 * _step(-y - 78, 2.5)
        + 1.2 * np.exp(-(((y + 31) / 3) ** 2))
    )
    roof = roof * (1 - 0.3 * np.exp(-((x / 5) ** 2)))
    pits = 2.2 + 2.5 * _step(12 - x, 2.0) + 2.0 * _step(y + 4, 3.0)
    return roof + (pits - roof) * _step(y + 28, 2.0)
