"""Points of the head's frame -> depths in bone, brain and body: the whole head as one set of exact level functions.

Frame: head mm. A depth is positive inside, and its sign is the truth: a point belongs to the bone where the bone's
depth is positive. Depths of parts are joined by the larger, hollowed by the smaller of two values.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from . import bones, tissue
from .base_map import CEILING, BaseMap
from .bones import Hollow
from .braincase import Braincase
from .solids import Solid

Array = NDArray[np.float64]
_COARSE = 4  # px between the points at which a plane's shell is looked for
_ROUND_BONE, _ROUND_SKIN = 4.0, 14.0  # mm over which solids flow into each other
_SKIN = 2.0  # mm of soft tissue over every bone
_FORAMEN = (-64.0, -24.0)  # mm: heights between which the great opening of the base is cut
REACH = 3.0
"""mm around a surface within which depths are exact."""
FAR = 60.0
"""mm: depth given where there is no surface."""
Part = tuple[slice, slice]


@dataclass(frozen=True, eq=False)
class Group:
    """Solids with the balls that hold them.

    Parameters
    ----------
    solids : tuple of Solid
    """

    solids: tuple[Solid, ...]

    @cached_property
    def centres(self) -> Array:
        """Centre of each ball in mm, shape (n, 3)."""
        return np.array([solid.ball[0] for solid in self.solids]).reshape(-1, 3)

    @cached_property
    def radii(self) -> Array:
        """Radius of each ball in mm, shape (n,)."""
        return np.array([solid.ball[1] for solid in self.solids])


@dataclass(frozen=True, eq=False)
class Anatomy:
    """One head before it is scanned.

    Parameters
    ----------
    case : Braincase
        With its cutters.
    base : BaseMap
        The floor inside.
    scale : ndarray, shape (3,)
        Size of the face relative to the lists of solids.
    skull, loose, teeth, body : Group
        See `bones` and `tissue`.
    hollows, airways, fillings : tuple of Hollow
        The same.
    """

    case: Braincase
    base: BaseMap
    scale: Array
    skull: Group = field(default_factory=lambda: Group(bones.skull_solids()))
    loose: Group = field(default_factory=lambda: Group(bones.loose_solids()))
    teeth: Group = field(default_factory=lambda: Group(bones.tooth_solids()))
    body: Group = field(default_factory=lambda: Group(tissue.body_solids()))
    hollows: tuple[Hollow, ...] = field(default_factory=bones.hollows)
    airways: tuple[Hollow, ...] = field(default_factory=tissue.airways)
    fillings: tuple[Hollow, ...] = field(default_factory=tissue.fillings)

    @cached_property
    def spaces(self) -> Group:
        """The hollows' solids."""
        return Group(tuple(hollow.solid for hollow in self.hollows))

    @cached_property
    def walled(self) -> Group:
        """Those with a wall of bone around them."""
        return Group(tuple(hollow.solid for hollow in self.hollows if hollow.wall))

    @cached_property
    def contents(self) -> Group:
        """What lies in the body, in the order in which it is laid: airways, hollows of the bone, fillings."""
        return Group(tuple(part.solid for part in (*self.airways, *self.hollows, *self.fillings)))

    @cached_property
    def content_hu(self) -> Array:
        """HU of each of `contents`; NaN where only bone is taken away."""
        return np.array([part.hu for part in (*self.airways, *self.hollows, *self.fillings)])


@dataclass(frozen=True, eq=False)
class Plane:
    """Points of one plane of a scan in the head's frame.

    Parameters
    ----------
    p : ndarray, shape (3, R, C)
        Head mm of each pixel.
    to_pixel : ndarray, shape (3, 4)
        Head mm (x, y, z, 1) -> mm above the plane, row, column.
    steps : ndarray, shape (2,)
        mm between rows and between columns.
    """

    p: Array
    to_pixel: Array
    steps: Array

    def windows(self, centres: Array, radii: Array) -> Iterator[tuple[int, Part]]:
        """The rectangles of pixels that balls may reach.

        Parameters
        ----------
        centres : ndarray, shape (n, 3)
            Head mm.
        radii : ndarray, shape (n,)
            mm.

        Yields
        ------
        tuple
            Index of a ball that meets plane and image, and its rows and columns as slices.
        """
        above, *middle = self.to_pixel[:, :3] @ centres.T + self.to_pixel[:, 3:]
        half = np.sqrt(np.maximum(radii**2 - above**2, 0)) / self.steps[:, None]
        low = np.clip(np.floor(middle - half), 0, None).astype(int)
        high = np.minimum(np.ceil(middle + half) + 1, np.array(self.p.shape[1:])[:, None]).astype(int)
        for i in np.flatnonzero((np.abs(above) < radii) & (high > low).all(axis=0)):
            yield int(i), (slice(low[0, i], high[0, i]), slice(low[1, i], high[1, i]))


@dataclass(frozen=True, eq=False)
class Depths:
    """Depths of one plane's pixels, each of shape (R, C), mm; positive inside.

    Parameters
    ----------
    bone, tooth : ndarray
        Complete bone of head and neck, and teeth.
    cavity : ndarray
        Inside of the skull.
    body : ndarray
        Everything under the skin.
    outer : ndarray
        Below the outer surface of the braincase.
    cut : ndarray
        Inside a cutter and within the braincase's wall.
    suture : ndarray
        Less the distance to the nearest suture.
    """

    bone: Array
    tooth: Array
    cavity: Array
    body: Array
    outer: Array
    cut: Array
    suture: Array


def depths(head: Anatomy, plane: Plane) -> Depths:
    """Evaluate a head on a plane.

    Parameters
    ----------
    head : Anatomy
    plane : Plane

    Returns
    -------
    Depths
        Exact within `REACH` of a surface; further away they keep their sign.
    """
    outer, inner, cut, suture = _wall(head.case, plane)
    cavity, bone = _floored(head.base, plane.p, outer, inner)
    _join(bone, plane, head, head.walled, walls=np.array([hollow.wall for hollow in head.hollows if hollow.wall]))
    _join(bone, plane, head, head.skull, round_mm=_ROUND_BONE)
    low = (plane.p[2] > _FORAMEN[0]) & (plane.p[2] < _FORAMEN[1]) & (bone > -REACH)
    bone[low] = np.minimum(bone[low], -head.case.foramen_distance(plane.p[:, low].T))
    for _, part, depth in parts(head, plane, head.spaces):
        bone[part] = np.minimum(bone[part], -depth)
    _join(bone, plane, head, head.loose, round_mm=_ROUND_BONE)
    tooth, body = np.full(bone.shape, -FAR), outer + head.case.scalp
    _join(tooth, plane, head, head.teeth)
    _join(body, plane, head, head.body, round_mm=_ROUND_SKIN)
    body = np.maximum(body, np.maximum(bone, tooth) + _SKIN)
    return Depths(bone, tooth, np.minimum(cavity, -bone), body, outer, cut, suture)


def parts(head: Anatomy, plane: Plane, group: Group, *, reach: float = REACH) -> Iterator[tuple[int, Part, Array]]:
    """Where the solids of a group meet a plane, and their depths there.

    Parameters
    ----------
    head : Anatomy
        Gives the scale of the solids.
    plane : Plane
    group : Group
    reach : float
        mm around each solid.

    Yields
    ------
    tuple
        Index of the solid, rows and columns as slices, and the depth in mm of their pixels.
    """
    for index, part in plane.windows(group.centres * head.scale, group.radii * float(head.scale.max()) + reach):
        yield index, part, group.solids[index].depth(plane.p[:, *part] / head.scale[:, None, None])


def _join(
    total: Array, plane: Plane, head: Anatomy, group: Group, *, walls: Array | None = None, round_mm: float = 0.0
) -> None:
    """Raise `total` to the depth of each solid, grown by its wall, in place; corners between them are filled."""
    walls = np.zeros(len(group.solids)) if walls is None else walls
    for index, part, depth in parts(head, plane, group, reach=max(REACH, round_mm) + float(walls.max(initial=0))):
        total[part] = _union(total[part], depth + walls[index], round_mm)


def _union(a: Array, b: Array, round_mm: float) -> Array:
    """The larger of two depths, raised by up to a quarter of `round_mm` where they differ by less than that."""
    if not round_mm:
        return np.maximum(a, b)
    return np.maximum(a, b) + np.maximum(round_mm - np.abs(a - b), 0) ** 2 / (4 * round_mm)


def _wall(case: Braincase, plane: Plane) -> tuple[Array, Array, Array, Array]:
    """Depths below the outer and inner surface of the braincase, in a cutter, and less the distance to a suture."""
    outer, inner, slope = _rough(case, plane.p)
    near = (outer > -REACH) & (inner < REACH)
    cut, suture = np.full(outer.shape, -FAR), np.full(outer.shape, -FAR)
    p = plane.p[:, near].T
    if len(p):
        depth, thickness = case.surfaces(p)
        outer[near], inner[near] = depth / slope[near], (depth - thickness) / slope[near]
        suture[near] = -case.suture_distance(p)
        if case.cutters:
            cut[near] = _cut_depth(case, p, depth, thickness)
    return outer, inner, cut, suture


def _rough(case: Braincase, p: Array) -> tuple[Array, Array, Array]:
    """Depths below both surfaces and the slope: known at every fourth pixel, linear between (right to 0.1 mm)."""
    few = np.moveaxis(p[:, ::_COARSE, ::_COARSE], 0, -1) + 1e-9
    depth, thickness = case.surfaces(few)
    slope = case.slope(few)
    fields = (depth / slope, (depth - thickness) / slope, slope)
    outer, inner, slope = (_spread(_spread(field, p.shape[1]).T, p.shape[2]).T for field in fields)
    return outer, inner, slope


def _spread(few: Array, count: int) -> Array:
    """Rows known at every fourth place, linear between and constant beyond, shape (count, n)."""
    at = np.minimum(np.arange(count) / _COARSE, len(few) - 1)
    low = at.astype(int)
    high, share = np.minimum(low + 1, len(few) - 1), (at - low)[:, None]
    return few[low] * (1 - share) + few[high] * share


def _cut_depth(case: Braincase, p: Array, depth: Array, thickness: Array) -> Array:
    """Depth within any cutter, from 3 mm inside the skull to 3 mm outside."""
    length = np.sqrt(np.einsum("ni,ni->n", p, p))
    outer, cut = depth + length, np.full(len(p), -FAR)
    for cutter in case.cutters:
        near = np.flatnonzero(p @ cutter.axes[2] > cutter.reach * length - 6.0)
        inside = cutter.distance(p[near], (outer - thickness)[near], outer[near])
        cut[near] = np.maximum(cut[near], inside)
    return np.minimum(cut, np.minimum(depth + 3.0, thickness - depth + 3.0))


def _floored(base: BaseMap, p: Array, outer: Array, inner: Array) -> tuple[Array, Array]:
    """Depth in the cavity above the floor, and in the bone of vault and floor."""
    cavity, shell = inner.copy(), outer.copy()
    low = (p[2] < CEILING) & (outer > -REACH)
    if low.any():
        x, y, z = p[:, low]
        top, bottom, slope = base.at(x, y)
        cavity[low] = np.minimum(cavity[low], (z - top) / slope)
        shell[low] = np.minimum(shell[low], (z - bottom) / slope)
    return cavity, np.minimum(shell, -cavity)
