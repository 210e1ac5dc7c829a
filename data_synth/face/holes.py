"""Seed and number -> where a vault is opened, within what surgeons open.

Frame: head mm, directions from the centre.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..defect import DefectSpec

Array = NDArray[np.float64]

SMALLEST, LARGEST = 10.0, 120.0
"""mm: mean diameters that are drawn."""
_RADIUS = 80.0  # mm: a vault's usual distance from the centre
_STRETCH = 1.3  # largest ratio of the long to the short diameter
_APART = 9.0  # degrees of bone left between two holes
_LOWEST = (14.0, 2.0, -6.0)  # degrees above the centre's level at the front, the sides and the back: no rim is lower
_TRIES = 400


def draw_holes(
    rng: np.random.Generator, count: int, diameters_mm: Sequence[float] | None = None
) -> tuple[DefectSpec, ...]:
    """Holes that lie in the vault and do not meet.

    Parameters
    ----------
    rng : Generator
        Chooses size, place, form and rim.
    count : int
        1 to 3.
    diameters_mm : sequence of float, optional
        Mean diameter of each, 10 to 120 mm; drawn if not given.

    Returns
    -------
    tuple of DefectSpec
        Largest first if the diameters were drawn.

    Raises
    ------
    ValueError
        If the number or a diameter is out of range, or the holes do not fit beside each other.
    """
    if not 1 <= count <= 3 or (diameters_mm is not None and len(diameters_mm) != count):
        raise ValueError(f"1 to 3 holes with one diameter each are wanted, not {count} with {diameters_mm}.")
    if diameters_mm is not None and not all(SMALLEST <= d <= LARGEST for d in diameters_mm):
        raise ValueError(f"A hole measures {SMALLEST:.0f} to {LARGEST:.0f} mm; {diameters_mm} does not.")
    for _ in range(_TRIES):
        drawn = np.exp(rng.uniform(np.log(SMALLEST), np.log(LARGEST), count))
        sizes = np.sort(drawn)[::-1] if diameters_mm is None else np.asarray(diameters_mm, float)
        directions = rng.standard_normal((count, 3))
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        if _fit(directions, sizes):
            return tuple(_spec(d, float(size), rng) for d, size in zip(directions, sizes, strict=True))
    widths = "of widths drawn" if diameters_mm is None else f"of {', '.join(f'{d:g}' for d in diameters_mm)} mm"
    raise ValueError(f"{count} holes {widths} do not fit into one vault; fewer or smaller ones are wanted.")


def _fit(directions: Array, sizes: Array) -> bool:
    """Whether the rims stay in the vault and apart."""
    half = np.rad2deg(np.arcsin(np.minimum(sizes / 2 * np.sqrt(_STRETCH) / _RADIUS, 0.97)))
    frontal = -directions[:, 1] / np.maximum(np.hypot(directions[:, 0], directions[:, 1]), 1e-9)
    front, side, back = _LOWEST
    lowest = side + np.where(frontal > 0, (front - side) * frontal, (side - back) * frontal)
    if (np.rad2deg(np.arcsin(directions[:, 2])) - half < lowest).any():
        return False
    angles = np.rad2deg(np.arccos(np.clip(np.einsum("ai,bi->ab", directions, directions), -1, 1)))
    apart = angles - half[:, None] - half
    return bool((apart[~np.eye(len(sizes), dtype=bool)] > _APART).all())


def _spec(direction: Array, size: float, rng: np.random.Generator) -> DefectSpec:
    x, y, z = map(float, direction)
    ragged = float(rng.uniform(0.0, 0.08)) if size > 30 else 0.01
    aspect = (1.0, _STRETCH) if size > 20 else (1.0, 1.05)
    return DefectSpec(
        (x, y, z), (size, size), aspect, ragged, float(rng.uniform(0, 2.5)), either_side=False, jitter=0.0
    )
