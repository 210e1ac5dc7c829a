"""Rays from inside the head on a square map, and numbers along them: the vault as maps of radii.

Frames: map (v, u) counts rays; directions and points in the world (LPS), radii in mm from the grid's centre.

The map is azimuthal-equidistant: the distance of a ray from the map's middle is its angle from the middle direction.
Distances are true along lines through the middle. On such a map the outer and the inner surface of the vault have one
radius per ray, a hole is a region, and a prosthesis is a pair of radii.
"""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..grid import nearest_values

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class RayGrid:
    """A square grid of rays that start in one point.

    Parameters
    ----------
    centre : ndarray, shape (3,)
        Where the rays start, world mm.
    axes : ndarray, shape (3, 3)
        Rows: orthogonal unit vectors along which u and v grow, and of the middle ray; world.
    step_rad : float
        Angle between neighbouring rays through the middle, radians.
    n : int
        Rays along each side.

    Examples
    --------
    >>> grid = RayGrid(np.zeros(3), np.eye(3), step_rad=0.1, n=5)
    >>> grid.directions[2, 2]
    array([0., 0., 1.])
    >>> grid.locate(7 * grid.directions[3, 0]).round(6)
    array([3., 0.])
    """

    centre: Array
    axes: Array
    step_rad: float
    n: int

    @property
    def offsets(self) -> Array:
        """Angles of each ray from the middle along v and u.

        Returns
        -------
        ndarray, shape (2, n, n)
            Radians.
        """
        return np.mgrid[: self.n, : self.n] * self.step_rad - (self.n - 1) / 2 * self.step_rad

    @property
    def polar(self) -> Array:
        """Angle of each ray from the middle one.

        Returns
        -------
        ndarray, shape (n, n)
            Radians.
        """
        v, u = self.offsets
        return np.hypot(u, v)

    @cached_property
    def directions(self) -> Array:
        """Unit vector of each ray.

        Returns
        -------
        ndarray, shape (n, n, 3)
            World.
        """
        v, u = self.offsets
        polar = np.hypot(u, v)
        scale = np.sinc(polar / np.pi)  # sin(angle) / angle
        found = np.stack([u * scale, v * scale, np.cos(polar)], axis=-1) @ self.axes
        found.setflags(write=False)  # asked for again and again
        return np.asarray(found)

    def points(self, radius: Array) -> Array:
        """Points at a radius along each ray.

        Parameters
        ----------
        radius : ndarray, shape (n, n)
            mm.

        Returns
        -------
        ndarray, shape (n, n, 3)
            World mm.
        """
        return self.centre + self.directions * radius[..., None]

    def locate(self, directions: Array) -> Array:
        """Where directions lie on the map; the inverse of `directions`.

        Parameters
        ----------
        directions : ndarray, shape (..., 3)
            World vectors from the centre, of any length.

        Returns
        -------
        ndarray, shape (2, ...)
            Fractional (v, u), also beyond the map.
        """
        x, y, z = np.moveaxis(directions @ self.axes.T, -1, 0)
        across = np.hypot(x, y)
        scale = np.arctan2(across, z) / np.maximum(across, 1e-12) / self.step_rad
        return np.stack([y * scale, x * scale]) + (self.n - 1) / 2

    def at(self, values: NDArray, directions: Array, *, outside: float) -> NDArray:
        """Values of the rays nearest to directions.

        Parameters
        ----------
        values : ndarray, shape (n, n)
        directions : ndarray, shape (..., 3)
            World vectors from the centre, of any length.
        outside : scalar
            Value of directions beyond the map.

        Returns
        -------
        ndarray, shape (...)
        """
        return nearest_values(values, np.moveaxis(self.locate(directions), 0, -1), outside=outside)


@dataclass(frozen=True, eq=False)
class RadiusMap:
    """The two surfaces of the vault along the rays of a grid.

    Parameters
    ----------
    grid : RayGrid
        n rays along each side.
    outer, inner : ndarray, shape (n, n)
        Radii of the two surfaces, mm; nan where a ray meets no bone.
    hole : ndarray of bool, shape (n, n)
        Rays along which bone is missing.
    """

    grid: RayGrid
    _: KW_ONLY
    outer: Array
    inner: Array
    hole: Mask

    @property
    def step_mm(self) -> float:
        """Distance between neighbouring rays on the vault.

        Returns
        -------
        float
            mm.
        """
        return float(np.nanmedian(self.outer) * self.grid.step_rad)


def filled_from_nearest(values: Array) -> Array:
    """A map with its unknown parts filled from the nearest known place.

    Parameters
    ----------
    values : ndarray, shape (M, N)
        nan where unknown, known somewhere.

    Returns
    -------
    ndarray, shape (M, N)

    Examples
    --------
    >>> filled_from_nearest(np.array([[1.0, np.nan, np.nan, 4.0]]))
    array([[1., 1., 4., 4.]])
    """
    nearest = ndimage.distance_transform_edt(np.isnan(values), return_distances=False, return_indices=True)
    return values[tuple(nearest)]
