"""Name of a defect, seed -> cutters: where, how large and with what rim the skull is opened.

Frame: world mm (LPS) offsets from the head's centre. A cutter is a cone from that centre; its rim may be round,
elliptic or ragged, and bevelled so that the hole is wider outside than inside.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
_HARMONICS = np.arange(2, 9)


@dataclass(frozen=True)
class DefectSpec:
    """Kind of hole, before the seed chooses its exact place and size.

    Parameters
    ----------
    direction : tuple of float
        From the head's centre to the hole (LPS: left, back, up); any length. With `either_side` the seed may
        mirror it.
    diameter : tuple of float
        Smallest and largest mean diameter in mm.
    aspect : tuple of float
        Smallest and largest ratio of the long to the short diameter.
    ragged : float
        Relative height of the rim's waves.
    bevel : float
        How much further the rim reaches outside than inside, in mm, beyond the cone itself.
    depth : float
        Part of the thickness that is lost, counted from outside; 1 is a hole.
    either_side : bool
        Whether the seed chooses left or right.
    jitter : float
        Largest random turn of the direction, in degrees.
    """

    direction: tuple[float, float, float]
    diameter: tuple[float, float]
    aspect: tuple[float, float] = (1.0, 1.25)
    ragged: float = 0.02
    bevel: float = 2.0
    depth: float = 1.0
    either_side: bool = True
    jitter: float = 5.0


_TEMPLE = (1.0, 0.3, 0.42)
DEFECTS: dict[str, tuple[DefectSpec, ...]] = {
    "unilateral": (DefectSpec(_TEMPLE, (57.0, 61.0), (1.0, 1.06), bevel=3.0, jitter=2.0),),
    "round": (DefectSpec((0.8, 0.4, 0.7), (40.0, 60.0), (1.0, 1.0), ragged=0.0),),
    "elliptic": (DefectSpec((0.9, 0.2, 0.6), (45.0, 65.0), (1.4, 1.8), ragged=0.0),),
    "ragged": (DefectSpec((0.9, 0.1, 0.6), (55.0, 75.0), (1.1, 1.4), ragged=0.16),),
    "temporal": (DefectSpec((1.0, 0.0, 0.3), (45.0, 65.0)),),
    "parietal": (DefectSpec((0.6, 0.55, 0.75), (50.0, 80.0)),),
    "frontal": (DefectSpec((0.25, -1.0, 0.6), (50.0, 80.0), jitter=7.0),),
    "occipital": (DefectSpec((0.3, 1.0, 0.25), (40.0, 70.0)),),
    "vertex": (DefectSpec((0.06, 0.15, 1.0), (50.0, 80.0), jitter=7.0),),
    "near_base": (DefectSpec((1.0, 0.25, -0.02), (40.0, 60.0)),),
    "bilateral": (
        DefectSpec((0.8, -0.2, 0.6), (45.0, 60.0), either_side=False),
        DefectSpec((-0.8, 0.3, 0.6), (45.0, 60.0), either_side=False),
    ),
    "multiple": (
        DefectSpec((0.9, -0.1, 0.45), (35.0, 50.0), either_side=False),
        DefectSpec((-0.5, 0.8, 0.5), (30.0, 40.0), ragged=0.08, either_side=False),
        DefectSpec((-0.4, -0.7, 0.75), (12.0, 16.0), (1.0, 1.0), ragged=0.0, bevel=0.0, either_side=False),
    ),
    "burr_hole": (DefectSpec((0.6, -0.45, 0.75), (12.0, 15.0), (1.0, 1.0), ragged=0.0, bevel=0.0),),
    "large": (DefectSpec((0.85, -0.05, 0.55), (95.0, 115.0), (1.0, 1.2), ragged=0.05),),
    "partial": (DefectSpec((0.9, 0.2, 0.5), (35.0, 50.0), depth=0.55),),
}
"""Every named defect: one `DefectSpec` per hole."""


@dataclass(frozen=True, eq=False)
class Cutter:
    """A cone from the head's centre that takes bone away.

    Parameters
    ----------
    axes : ndarray, shape (3, 3)
        Rows: across, along and the cone's direction; a right-handed unit frame.
    half_angles : ndarray, shape (2,)
        Half openings towards `axes[0]` and `axes[1]`, as the chord 2 sin(angle / 2).
    rim : ndarray, shape (2, 7)
        Cosine and sine weights of the rim's waves of 2 to 8 periods, relative to the opening.
    bevel : float
        mm the rim moves outwards from the inner to the outer surface.
    depth : float
        Part of the thickness that is lost, counted from outside.
    """

    axes: Array
    half_angles: Array
    rim: Array
    bevel: float
    depth: float

    @property
    def reach(self) -> float:
        """Cosine of an angle about the direction that holds the whole cutter, bevel included."""
        chord = self.half_angles.max() * (1 + np.abs(self.rim).sum()) + self.bevel / 40.0
        return float(1 - min(chord, 1.95) ** 2 / 2)

    def distance(self, offsets: ArrayLike, inner: ArrayLike, outer: ArrayLike) -> Array:
        """About how far, in mm, points lie inside the cutter; the sign is exact, negative outside.

        Parameters
        ----------
        offsets : array_like, shape (..., 3)
            Points minus the head's centre.
        inner, outer : array_like, shape (...)
            Radii of the skull's surfaces along the same rays, mm.

        Returns
        -------
        ndarray, shape (...)
            mm.
        """
        p = np.asarray(offsets, float)
        length = np.linalg.norm(p, axis=-1)
        local = p @ self.axes.T / np.maximum(length, 1e-9)[..., None]
        share = (length - inner) / np.maximum(np.asarray(outer, float) - inner, 1e-6)
        chord = np.sqrt(np.maximum(2 - 2 * local[..., 2], 0))
        side = (self._opening(local) - chord) * length + self.bevel * (np.clip(share, 0, 1) - 0.5)
        floor = (share - (1 - self.depth)) * (np.asarray(outer, float) - inner)
        return side if self.depth >= 1 else np.minimum(side, floor)

    def rim_normal(self, offsets: ArrayLike) -> Array:
        """Directions in which the distance to the cone's side changes fastest.

        Parameters
        ----------
        offsets : array_like, shape (..., 3)
            Points minus the head's centre, mm.

        Returns
        -------
        ndarray, shape (..., 3)
            Unit vectors.
        """
        p = np.asarray(offsets, float)
        d = p / np.linalg.norm(p, axis=-1, keepdims=True)
        away = d * (d @ self.axes[2])[..., None] - self.axes[2]
        return away / np.maximum(np.linalg.norm(away, axis=-1, keepdims=True), 1e-9)

    def _opening(self, local: Array) -> Array:
        """Chord from the cone's direction to its rim, towards unit vectors in the cutter's frame."""
        angle = np.arctan2(local[..., 1], local[..., 0])
        a, b = self.half_angles
        opening = a * b / np.hypot(b * np.cos(angle), a * np.sin(angle))
        if not self.rim.any():
            return opening
        waves = angle[..., None] * _HARMONICS
        return opening * (1 + np.cos(waves) @ self.rim[0] + np.sin(waves) @ self.rim[1])


def plan_cutters(
    defect: str | tuple[DefectSpec, ...],
    rng: np.random.Generator,
    radius: Callable[[Array], float],
    *,
    diameter: float | None = None,
) -> tuple[Cutter, ...]:
    """Cutters of a named defect.

    Parameters
    ----------
    defect : str or tuple of DefectSpec
        A key of `DEFECTS`, or the holes themselves.
    rng : Generator
        Chooses side, place, size, turn and rim.
    radius : callable
        Distance in mm from the head's centre to the outer skull along a unit direction, shape (3,).
    diameter : float, optional
        Mean diameter in mm of every hole, instead of one drawn from the defect's range.

    Returns
    -------
    tuple of Cutter
        One per hole.

    Raises
    ------
    ValueError
        If the defect is unknown, or too wide for the skull.
    """
    if isinstance(defect, str) and defect not in DEFECTS:
        raise ValueError(f"There is no defect named {defect!r}; choose one of {', '.join(DEFECTS)}.")
    specs = DEFECTS[defect] if isinstance(defect, str) else defect
    return tuple(_cutter(spec, rng, radius, diameter) for spec in specs)


def _cutter(
    spec: DefectSpec, rng: np.random.Generator, radius: Callable[[Array], float], diameter: float | None
) -> Cutter:
    axes = _frame(_direction(spec, rng), rng.uniform(0, np.pi))
    mean = rng.uniform(*spec.diameter) if diameter is None else diameter
    stretch = np.sqrt(rng.uniform(*spec.aspect))
    sine = mean / 2 * np.array([stretch, 1 / stretch]) / radius(axes[2])
    if not 0 < sine.min() <= sine.max() < 0.95:
        raise ValueError(f"A hole of {mean:.0f} mm does not fit this skull; the diameter must be smaller.")
    rim = rng.standard_normal((2, _HARMONICS.size))
    rim *= spec.ragged / np.linalg.norm(rim)
    return Cutter(axes, 2 * np.sin(np.arcsin(sine) / 2), rim, spec.bevel, spec.depth)


def _direction(spec: DefectSpec, rng: np.random.Generator) -> Array:
    """Direction of the hole: the named one, on the seed's side, turned by at most the jitter."""
    side = rng.choice([-1.0, 1.0]) if spec.either_side else 1.0
    d = np.array(spec.direction) * [side, 1, 1]
    d /= np.linalg.norm(d)
    turned = d + np.tan(np.deg2rad(spec.jitter)) * rng.uniform(-1, 1, 3) / np.sqrt(3)
    return turned / np.linalg.norm(turned)


def _frame(direction: Array, roll: float) -> Array:
    """Right-handed unit frame whose last row is the direction."""
    helper = np.eye(3)[int(np.argmin(np.abs(direction)))]
    e1 = np.cross(helper, direction)
    e1 /= np.linalg.norm(e1)
    e2 = np.cross(direction, e1)
    return np.array([np.cos(roll) * e1 + np.sin(roll) * e2, np.cos(roll) * e2 - np.sin(roll) * e1, direction])
