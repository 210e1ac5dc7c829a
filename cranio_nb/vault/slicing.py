"""Along which planes an opening is cut: a radius map of the vault comes in -> stacks of slices go out.

Frames: slice (row, col) in mm about the head's centre; a slice's `frame` takes it to the world (mm,
LPS). Rays of a slice: angle 0 points to the opening, against the rows, and grows towards the columns.

The paper cuts axially and its opening is lateral. Near the vertex an axial slice is a cap, not a ring, and meets the
rim at a flat angle. A fan of planes through a point inside the head cuts every opening as the paper's slices cut
theirs: each slice is a full ring, and crosses the hole the short way or any other way one likes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..volume import Volume
from .ray_grid import RadiusMap, filled_from_nearest
from .rims import RayProfile

_APART = 1.0  # mm between slices on the vault
_RAY = 0.4  # mm between rays on the vault
_SIDE = 0.75  # radians of bone looked at on each side of the hole


@dataclass(frozen=True, eq=False)
class Fan:
    """Planes that share a line through the head's centre.

    Parameters
    ----------
    axes : ndarray, shape (3, 3)
        Rows, world: the shared line (columns of the slices), the direction the planes turn to, the opening.
    tilts : ndarray, shape (P,)
        Angle of each plane from the opening's direction, radians, evenly spaced.
    angles : ndarray, shape (K,)
        Angles of the rays within a slice, radians, evenly spaced.
    """

    axes: NDArray[np.float64]
    tilts: NDArray[np.float64]
    angles: NDArray[np.float64]

    @property
    def directions(self) -> NDArray[np.float64]:
        """Unit vector of each ray of each slice.

        Returns
        -------
        ndarray, shape (P, K, 3)
            World.
        """
        tilt, angle = self.tilts[:, None, None], self.angles[None, :, None]
        hinge, turn, middle = self.axes
        return np.cos(angle) * (np.cos(tilt) * middle + np.sin(tilt) * turn) + np.sin(angle) * hinge

    def locate(self, directions: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where directions lie in the fan; the inverse of `directions`.

        Parameters
        ----------
        directions : ndarray, shape (..., 3)
            Unit vectors, world.

        Returns
        -------
        ndarray, shape (2, ...)
            Fractional (slice, ray).
        """
        hinge, turn, middle = np.moveaxis(directions @ self.axes.T, -1, 0)
        tilt, angle = np.arctan2(turn, middle), np.arcsin(np.clip(hinge, -1, 1))
        steps = self.tilts[1] - self.tilts[0], self.angles[1] - self.angles[0]
        return np.stack([(tilt - self.tilts[0]) / steps[0], (angle - self.angles[0]) / steps[1]])

    def frames(self, centre: NDArray[np.float64]) -> NDArray[np.float64]:
        """Place of each slice in the world: point = origin + row r + col c.

        Parameters
        ----------
        centre : ndarray, shape (3,)
            World mm.

        Returns
        -------
        ndarray, shape (P, 3, 3)
            Origin, row and column vector, world.
        """
        up = np.cos(self.tilts)[:, None] * self.axes[2] + np.sin(self.tilts)[:, None] * self.axes[1]
        return np.stack([np.broadcast_to(centre, up.shape), -up, np.broadcast_to(self.axes[0], up.shape)], axis=1)


def axial_frames(bone: Volume, planes: range) -> NDArray[np.float64]:
    """Frames of planes of the scan itself.

    Parameters
    ----------
    bone : Volume
    planes : range

    Returns
    -------
    ndarray, shape (P, 3, 3)
        Origin, row and column vector, world; slice (row, col) in px.

    Examples
    --------
    >>> axial_frames(Volume(np.zeros((4, 4, 4)), np.eye(4)), range(2, 3))[0, 0]
    array([2., 0., 0.])
    """
    origins = [bone.to_world([plane, 0, 0]) for plane in planes]
    return np.stack([[origin, *bone.edges[1:]] for origin in origins])


def make_fans(radius_map: RadiusMap, n: int) -> list[Fan]:
    """Fans whose slices cross the hole in `n` directions, evenly turned; the slices of the first cross its short side.

    Parameters
    ----------
    radius_map : RadiusMap
    n : int
        Number of directions, 1 or more.

    Returns
    -------
    list of Fan
    """
    hole = radius_map.grid.directions[radius_map.hole]
    radius = float(np.nanmedian(radius_map.outer))
    across, along, middle = radius_map.grid.axes
    out = []
    for turn in np.arange(n) * np.pi / n:
        hinge = np.cos(turn) * across + np.sin(turn) * along
        axes = np.stack([hinge, np.cross(middle, hinge), middle])
        # slices and rays over the hole, and bone to both sides of it
        h, t, m = (hole @ axes.T).T
        tilt, angle = np.arctan2(t, m), np.arcsin(h)
        tilts = np.arange(tilt.min() - 2 * _APART / radius, tilt.max() + 2 * _APART / radius, _APART / radius)
        angles = np.arange(max(angle.min() - _SIDE, -1.55), min(angle.max() + _SIDE, 1.55), _RAY / radius)
        out.append(Fan(axes, tilts, angles))
    return out


def read_profile(radius_map: RadiusMap, fan: Fan) -> RayProfile:
    """Radii and gap of every slice of a fan, read off a radius map.

    Parameters
    ----------
    radius_map : RadiusMap
    fan : Fan

    Returns
    -------
    RayProfile
        Lengths in mm.
    """
    at = radius_map.grid.locate(fan.directions)
    inside = ((at >= 0) & (at <= radius_map.grid.n - 1)).all(axis=0)
    hole = ndimage.map_coordinates(radius_map.hole.astype(np.float32), at, order=1) > 0.5
    # a ray between known and unknown ones is unknown
    known = np.isfinite(radius_map.outer)
    seen = inside & (ndimage.map_coordinates(known.astype(np.float32), at, order=1) > 0.99)
    outer, inner = (
        np.where(seen, ndimage.map_coordinates(filled_from_nearest(radius), at, order=1, mode="nearest"), np.nan)
        for radius in (radius_map.outer, radius_map.inner)
    )
    return RayProfile(np.zeros(2), fan.angles, outer=outer, inner=inner, missing=hole)


def sample_mask(
    volume: Volume, frame: NDArray[np.float64], rows: NDArray[np.float64], cols: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """The mask in a slice.

    Parameters
    ----------
    volume : Volume
        Bool mask.
    frame : ndarray, shape (3, 3)
        Origin, row and column vector of the slice, world.
    rows, cols : ndarray, shape (R,), (C,)
        Places in the slice, in its own unit.

    Returns
    -------
    ndarray of bool, shape (R, C)
    """
    origin, row, col = frame
    return volume.at(origin + rows[:, None, None] * row + cols[None, :, None] * col, outside=False)
