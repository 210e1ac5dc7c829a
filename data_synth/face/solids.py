"""Simple bodies -> how deep points lie inside them.

Frame: head mm. `depth` is positive inside and 0 on the surface; its sign is exact, and near the surface it is the
distance in mm (exact for cones of one radius, boxes and round rings, to first order for the others).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol, Self

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Triple = tuple[float, float, float]


class Solid(Protocol):
    """Anything with a depth and a ball that holds it."""

    @property
    def ball(self) -> tuple[Triple, float]:
        """Centre and radius in mm of a ball that holds the solid."""

    def depth(self, p: Array) -> Array:
        """Depth in mm, shape (...), of points of shape (3, ...)."""

    def on_side(self, side: float) -> Solid:
        """The solid itself (1) or its mirror image in the plane x = 0 (-1)."""


@dataclass(frozen=True)
class Cone:
    """Ball swept from one end to another while its radius changes; with a = b a ball.

    Parameters
    ----------
    a, b : tuple of float
        Ends, mm.
    ra, rb : float
        Radii at the ends, mm.
    """

    a: Triple
    b: Triple
    ra: float
    rb: float

    @property
    def ball(self) -> tuple[Triple, float]:
        """Centre and radius in mm of a ball that holds the cone."""
        a, b = np.array(self.a), np.array(self.b)
        x, y, z = (a + b) / 2
        return (float(x), float(y), float(z)), float(np.linalg.norm(b - a) / 2 + max(self.ra, self.rb))

    def depth(self, p: Array) -> Array:
        """Depth in mm, shape (...), of points of shape (3, ...)."""
        way = np.subtract(self.b, self.a)
        square = float(way @ way)
        x, y, z = p[0] - self.a[0], p[1] - self.a[1], p[2] - self.a[2]
        if square == 0:
            return self.ra - np.sqrt(x * x + y * y + z * z)
        share = np.clip((x * way[0] + y * way[1] + z * way[2]) / square, 0, 1)
        x, y, z = x - share * way[0], y - share * way[1], z - share * way[2]
        flat = np.sqrt(1 + (self.rb - self.ra) ** 2 / square)  # a slanted side is nearer than straight across
        return (self.ra + share * (self.rb - self.ra) - np.sqrt(x * x + y * y + z * z)) / flat

    def on_side(self, side: float) -> Cone:
        """The cone itself (1) or its mirror image (-1)."""
        (ax, ay, az), (bx, by, bz) = self.a, self.b
        return replace(self, a=(side * ax, ay, az), b=(side * bx, by, bz))


@dataclass(frozen=True)
class Centred:
    """What solids about a centre share.

    Parameters
    ----------
    centre : tuple of float
        mm.
    """

    centre: Triple

    def on_side(self, side: float) -> Self:
        """The solid itself (1) or its mirror image (-1)."""
        x, y, z = self.centre
        return replace(self, centre=(side * x, y, z))


@dataclass(frozen=True)
class Ellipsoid(Centred):
    """Ellipsoid along the axes.

    Parameters
    ----------
    centre, radii : tuple of float
        mm.
    """

    radii: Triple

    @property
    def ball(self) -> tuple[Triple, float]:
        """Centre and radius in mm of a ball that holds the ellipsoid."""
        return self.centre, max(self.radii)

    def depth(self, p: Array) -> Array:
        """Depth in mm, shape (...), of points of shape (3, ...); to first order."""
        u = [(p[i] - self.centre[i]) / self.radii[i] for i in range(3)]
        v = [u[i] / self.radii[i] for i in range(3)]
        norm = np.sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2])
        slope = np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
        return norm * (1 - norm) / np.maximum(slope, 1e-6)


@dataclass(frozen=True)
class Box(Centred):
    """Box along the axes with rounded edges.

    Parameters
    ----------
    centre, half : tuple of float
        Middle and half widths, mm, rounding included.
    rounding : float
        Radius of the edges, mm.
    """

    half: Triple
    rounding: float = 0.5

    @property
    def ball(self) -> tuple[Triple, float]:
        """Centre and radius in mm of a ball that holds the box."""
        return self.centre, float(np.linalg.norm(self.half))

    def depth(self, p: Array) -> Array:
        """Depth in mm, shape (...), of points of shape (3, ...)."""
        over = [np.abs(p[i] - self.centre[i]) - (self.half[i] - self.rounding) for i in range(3)]
        most = np.maximum(np.maximum(over[0], over[1]), over[2])
        x, y, z = (np.maximum(o, 0) for o in over)
        return self.rounding - np.sqrt(x * x + y * y + z * z) - np.minimum(most, 0)


@dataclass(frozen=True)
class Ring(Centred):
    """Ring of elliptic section about an axis along z; it may end at a plane y, as a dental arch does.

    Parameters
    ----------
    centre : tuple of float
        mm.
    radius : float
        From the axis to the middle of the section along x, mm.
    across, height : float
        Half width and half height of the section, mm.
    stretch : float
        Length of the ring along y, relative to x.
    front_of : float
        Largest y of the ring, mm.
    """

    radius: float
    across: float
    height: float
    stretch: float = 1.0
    front_of: float = np.inf

    @property
    def ball(self) -> tuple[Triple, float]:
        """Centre and radius in mm of a ball that holds the ring."""
        wide = (self.radius + self.across) * max(1.0, self.stretch)
        return self.centre, float(np.hypot(wide, self.height))

    def depth(self, p: Array) -> Array:
        """Depth in mm, shape (...), of points of shape (3, ...)."""
        x, y, z = p[0] - self.centre[0], (p[1] - self.centre[1]) / self.stretch, p[2] - self.centre[2]
        away = (np.sqrt(x * x + y * y) - self.radius) / self.across
        z = z / self.height
        inside = (1 - np.sqrt(away * away + z * z)) * min(self.across, self.height)
        return inside if np.isinf(self.front_of) else np.minimum(inside, self.front_of - p[1])


@dataclass(frozen=True)
class Cells:
    """Small chambers with thin walls between them, within another solid: air cells of mastoid and ethmoid.

    Parameters
    ----------
    within : Solid
        What holds the cells.
    period : float
        From wall to wall, mm.
    wall : float
        Thickness of the walls, mm.
    """

    within: Solid
    period: float
    wall: float

    @property
    def ball(self) -> tuple[Triple, float]:
        """Centre and radius in mm of a ball that holds the cells."""
        return self.within.ball

    def depth(self, p: Array) -> Array:
        """Depth in mm, shape (...), of points of shape (3, ...)."""
        depth = self.within.depth(p)
        for axis in range(3):
            share = np.abs(p[axis]) / self.period  # walls lie alike on both sides
            wall = np.abs(share - np.rint(share)) * self.period - self.wall / 2
            depth = np.minimum(depth, wall)
        return depth

    def on_side(self, side: float) -> Cells:
        """The cells themselves (1) or their mirror image (-1)."""
        return replace(self, within=self.within.on_side(side))


def both(*solids: Solid) -> tuple[Solid, ...]:
    """Solids of the left side, followed by their mirror images.

    Parameters
    ----------
    *solids : Solid

    Returns
    -------
    tuple of Solid
        Twice as many.

    Examples
    --------
    >>> [solid.centre for solid in both(Ellipsoid((30, 0, 0), (1, 1, 1)))]
    [(30.0, 0, 0), (-30.0, 0, 0)]
    """
    return tuple(solid.on_side(side) for side in (1.0, -1.0) for solid in solids)


def chain(points: tuple[Triple, ...], radii: tuple[float, ...]) -> tuple[Cone, ...]:
    """Cones from point to point.

    Parameters
    ----------
    points : tuple of tuple of float
        mm.
    radii : tuple of float
        Radius at each point, mm.

    Returns
    -------
    tuple of Cone
        One fewer than points.
    """
    ends = zip(points[:-1], points[1:], radii[:-1], radii[1:], strict=True)
    return tuple(Cone(a, b, ra, rb) for a, b, ra, rb in ends)
