"""Names of what surrounds a head or is fixed to it -> devices that a layer's HU are painted with.

Frame: head mm. Bodies are solids; what follows the skin (a holder, a mask) is a layer at a distance from it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .anatomy import Anatomy, Depths, Group, Plane
from .solids import Cone, Ring, Solid, Triple, chain

Array = NDArray[np.float64]
METAL, SILICONE, PLASTIC, AIR = 3071.0, 380.0, 250.0, -1000.0
"""HU of the materials."""


class Device(Protocol):
    """Anything that paints itself over a layer."""

    def paint(self, values: Array, plane: Plane, level: Depths, width: float) -> None:
        """Lay the device over the HU of a layer, in place.

        Parameters
        ----------
        values : ndarray, shape (R, C)
            HU.
        plane : Plane
        level : Depths
        width : float
            mm over which its surface is blended.
        """


@dataclass(frozen=True, eq=False)
class Body:
    """Solids of one material.

    Parameters
    ----------
    group : Group
        Joined solids.
    hu : float
        Material.
    streak_hu : float
        Height of the streaks it throws in its plane; 0 for none.
    """

    group: Group
    hu: float
    streak_hu: float = 0.0

    def paint(self, values: Array, plane: Plane, level: Depths, width: float) -> None:
        """See `Device.paint`."""
        first = True
        for index, part in plane.windows(self.group.centres, self.group.radii + width):
            if self.streak_hu and first:
                values += self.streak_hu * _streaks(plane, self.group.centres[index])
            first = False
            share = np.clip(0.5 + self.group.solids[index].depth(plane.p[:, *part]) / width, 0, 1)
            values[part] += share * (self.hu - values[part])


@dataclass(frozen=True, eq=False)
class Shell:
    """A layer at a distance from the skin, on one side of the head; it never reaches into the body.

    Parameters
    ----------
    side : ndarray, shape (3,)
        Unit vector from the head's centre to the middle of the layer.
    cosine : float
        Of the angle about `side` up to which it reaches.
    gap, thickness : float
        mm from the skin, and of the layer.
    hu : float
        Material.
    """

    side: Array
    cosine: float
    gap: float
    thickness: float
    hu: float

    def paint(self, values: Array, plane: Plane, level: Depths, width: float) -> None:
        """See `Device.paint`."""
        p = plane.p
        along = np.einsum("i,irc->rc", self.side, p) - self.cosine * np.sqrt(np.einsum("irc,irc->rc", p, p))
        depth = np.minimum(self.thickness / 2 - np.abs(level.body + self.gap + self.thickness / 2), along)
        share = np.clip(0.5 + depth / width, 0, 1) * (level.body < 0)
        values += share * (self.hu - values)


@dataclass(frozen=True, eq=False)
class Couch:
    """A flat plate under the head.

    Parameters
    ----------
    down : ndarray, shape (3,)
        Unit vector to the couch.
    distance, thickness, hu : float
        mm from the centre to the middle of the plate, mm, HU.
    """

    down: Array
    distance: float
    thickness: float = 3.0
    hu: float = 550.0

    def paint(self, values: Array, plane: Plane, level: Depths, width: float) -> None:
        """See `Device.paint`."""
        below = np.einsum("i,irc->rc", self.down, plane.p) - self.distance
        share = np.clip(0.5 + (self.thickness / 2 - np.abs(below)) / width, 0, 1) * (level.body < 0)
        values += share * (self.hu - values)


def devices(
    names: Sequence[str], head: Anatomy, down: Array, rng: np.random.Generator, *, streaks: bool = False
) -> tuple[Device, ...]:
    """Devices by their names.

    Parameters
    ----------
    names : sequence of str
        Of `AROUND`.
    head : Anatomy
        What they fit on.
    down : ndarray, shape (3,)
        Unit vector to the couch, in the head's frame.
    rng : Generator
        Chooses gaps, heights and HU.
    streaks : bool
        Whether metal throws streaks.

    Returns
    -------
    tuple of Device

    Raises
    ------
    ValueError
        If a name is unknown.
    """
    unknown = sorted(set(names) - set(AROUND))
    if unknown:
        raise ValueError(f"There is nothing named {unknown[0]!r} to put around a head; choose of {', '.join(AROUND)}.")
    found: list[Device] = []
    for name in names:
        found += AROUND[name](head, down, rng, 300.0 if streaks else 0.0)
    return tuple(found)


def _streaks(plane: Plane, centre: Array) -> Array:
    """Bright and dark rays about a point in the plane, fading over 30 mm."""
    _, row, col = plane.to_pixel[:, :3] @ centre + plane.to_pixel[:, 3]
    y = (np.arange(plane.p.shape[1])[:, None] - row) * plane.steps[0]
    x = (np.arange(plane.p.shape[2]) - col) * plane.steps[1]
    return np.cos(9 * np.arctan2(y, x) + 0.7) * np.exp(-np.hypot(x, y) / 30.0)


def _on(head: Anatomy, direction: Array, above_mm: float) -> Triple:
    """The point at a height above the outer skull, along a direction from the centre."""
    d = direction / np.linalg.norm(direction)
    x, y, z = d * (float(head.case.outer_radius(d)) + above_mm)
    return float(x), float(y), float(z)


def _path(head: Anatomy, start: Array, end: Array, count: int, above_mm: float) -> tuple[Triple, ...]:
    """Points over the skull from one direction to another."""
    return tuple(_on(head, start + t * (end - start), above_mm) for t in np.linspace(0, 1, count))


def _site(head: Anatomy) -> tuple[Array, Array, float]:
    """Direction of the first hole, one across it, and its half angle; the left temple in an intact head."""
    if not head.case.cutters:
        return np.array([0.77, 0.1, 0.63]), np.array([0.0, 1.0, -0.16]), 0.4
    cutter = head.case.cutters[0]
    return cutter.axes[2], cutter.axes[0], float(np.tan(2 * np.arcsin(cutter.half_angles[0] / 2)))


def _holder(head: Anatomy, down: Array, rng: np.random.Generator, streak: float) -> list[Device]:
    return [Shell(down, rng.uniform(0.1, 0.5), rng.uniform(6, 16), 4.0, rng.uniform(480, 550))]


def _mask(head: Anatomy, down: Array, rng: np.random.Generator, streak: float) -> list[Device]:
    return [Shell(np.array([0.0, -1.0, 0.0]), -0.1, rng.uniform(0.3, 2.0), 2.4, rng.uniform(40, 180))]


def _couch(head: Anatomy, down: Array, rng: np.random.Generator, streak: float) -> list[Device]:
    turn = np.random.default_rng(0).standard_normal((4000, 3))
    d = turn / np.linalg.norm(turn, axis=1, keepdims=True)
    lowest = float((head.case.skin_radius(d) * np.einsum("ni,i->n", d, down)).max())
    return [Couch(down, lowest + rng.uniform(3, 6))]


def _ring(head: Anatomy, down: Array, rng: np.random.Generator, streak: float) -> list[Device]:
    low = rng.uniform(-45.0, 25.0)
    solids: list[Solid] = []  # posts before the ring: streaks start at the first solid met
    for x, y in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        foot, top = (75.0 * x, 3.0 + 75.0 * y, low), (75.0 * x, 3.0 + 75.0 * y, low + 45.0)
        solids += [Cone(foot, top, 4.5, 4.5), Cone(top, _on(head, np.array(top), 0.5), 2.5, 0.8)]
    return [Body(Group((*solids, Ring((0.0, 3.0, low), 106.0, 4.0, 6.0))), METAL, streak)]


def _staples(head: Anatomy, down: Array, rng: np.random.Generator, streak: float) -> list[Device]:
    middle, across, half = _site(head)
    start, end = (middle + side * 1.2 * half * across for side in (-1, 1))
    line = _path(head, start, end, 14, head.case.scalp + 0.3)
    aside = 0.035 * np.cross(middle, across)
    solids = (
        Cone(
            _on(head, np.array(p) / 80 - aside, head.case.scalp),
            _on(head, np.array(p) / 80 + aside, head.case.scalp),
            0.4,
            0.4,
        )
        for p in line
    )
    return [Body(Group(tuple(solids)), METAL, streak)]


def _drain(head: Anatomy, down: Array, rng: np.random.Generator, streak: float) -> list[Device]:
    middle, across, half = _site(head)
    line = (*_path(head, middle, middle + 1.3 * half * across, 9, 2.5), _on(head, middle + 1.5 * half * across, 35.0))
    wall, lumen = (Group(chain(line, (radius,) * len(line))) for radius in (2.4, 1.3))
    return [Body(wall, SILICONE), Body(lumen, 10.0)]


def _tube(head: Anatomy, down: Array, rng: np.random.Generator, streak: float) -> list[Device]:
    line: tuple[Triple, ...] = ((0.0, -125.0, -84.0), (0.0, -86.0, -84.0), (0.0, -50.0, -77.0), (0.0, -26.0, -88.0),
                                (0.0, -23.0, -200.0))  # fmt: skip
    wall, lumen = (Group(chain(line, (radius,) * len(line))) for radius in (5.0, 3.7))
    return [Body(wall, PLASTIC), Body(lumen, AIR)]


def _clip(head: Anatomy, down: Array, rng: np.random.Generator, streak: float) -> list[Device]:
    side = rng.choice([-1.0, 1.0])
    clip = Cone((22.0 * side, -20.0, -2.0), (26.0 * side, -16.0, 3.0), 1.6, 1.2)
    return [Body(Group((clip,)), METAL, streak)]


def _plates(head: Anatomy, down: Array, rng: np.random.Generator, streak: float) -> list[Device]:
    middle, across, half = _site(head)
    other, solids = np.cross(middle, across), []
    for angle in np.deg2rad([20.0, 140.0, 260.0]):
        way = np.cos(angle) * across + np.sin(angle) * other
        line = _path(head, middle + (half + 0.02) * way, middle + (half + 0.2) * way, 4, 0.6)
        screws = (Cone(p, _on(head, np.array(p), -4.0), 1.0, 0.8) for p in (line[1], line[3]))
        solids += [*chain(line, (0.9,) * 4), *screws]
    return [Body(Group(tuple(solids)), METAL, streak)]


AROUND = {
    "holder": _holder,
    "mask": _mask,
    "couch": _couch,
    "ring": _ring,
    "staples": _staples,
    "drain": _drain,
    "tube": _tube,
    "clip": _clip,
    "plates": _plates,
}
"""What may be put around or on a head: holder 6 to 16 mm off the skin under the head, mask over the face, couch,
stereotactic ring on four pins, staples and drain at the first hole, tube in the windpipe, clip in the brain, small
plates with screws beside the hole."""
