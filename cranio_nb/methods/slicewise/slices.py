"""The nouns of the slice method: the settings of its balloons, one slice, the slices of one opening."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...curves import GapEnds, Points
from ...geometry.crossings import crossings
from ...opening import Opening

Pair = tuple[float, float]


@dataclass(frozen=True)
class Settings:
    """How the balloons of all slices are inflated, in the unit of the slices (px or mm).

    Parameters
    ----------
    n_snaxels : int
        Points of a balloon, ends included.
    pressure : float or None
        Constant k per index squared, outward positive; None where k follows from the end tangents.
    tension, rigidity, dt, tol, max_iter, max_moves
        As for `deformable_model.inflate`.
    """

    n_snaxels: int
    pressure: float | None
    tension: float
    rigidity: float
    dt: float
    tol: float
    max_iter: int
    max_moves: float = np.inf


@dataclass(frozen=True)
class Inflation:
    """How the two balloons of a slice came to rest; each value is a pair (outer, inner).

    Parameters
    ----------
    theta0_deg, theta1_deg : tuple of float
        End angles.
    length : tuple of float
        Of the gap, in the unit of the slice.
    n_iter : tuple of int
        Steps.
    converged : tuple of bool
        Whether the balloon came to rest.
    """

    theta0_deg: Pair
    theta1_deg: Pair
    length: Pair
    n_iter: tuple[int, int]
    converged: tuple[bool, bool]

    def record(self) -> dict[str, Any]:
        """JSON-able values.

        Returns
        -------
        dict
            theta0, theta1 (degrees), length (unit of the slice), n_iter, converged: lists [outer, inner].
        """
        return {
            "theta0": list(self.theta0_deg),
            "theta1": list(self.theta1_deg),
            "length": list(self.length),
            "n_iter": list(self.n_iter),
            "converged": list(self.converged),
        }


@dataclass(frozen=True, eq=False)
class SliceResult:
    """One slice of the design.

    Parameters
    ----------
    plane : int
        Index into the frames of its `SlicedDesign`.
    status : {"balloon", "hull", "carried", "skipped"}
        How the slice was filled. "carried": from its neighbours. "skipped": not at all.
    reason : str
        Why it was not bridged by its own balloon.
    ends : tuple of GapEnds
        Outer and inner gap ends, slice (row, col); empty unless status is "balloon".
    start, curves : ndarray, shape (2, n, 2)
        Outer and inner start and final curve, slice (row, col); empty for "hull" and "skipped".
    turns_rad : ndarray, shape (2, 2)
        [boundary, end]: how much the rim's own bone bends (see `rims.RimFits`), radians; 1 where unknown.
    inflation : Inflation or None
        None unless status is "balloon".
    """

    plane: int
    status: str
    reason: str = ""
    ends: tuple[GapEnds, ...] = ()
    start: Points = field(default_factory=lambda: np.empty((0, 0, 2)))
    curves: Points = field(default_factory=lambda: np.empty((0, 0, 2)))
    turns_rad: NDArray[np.float64] = field(default_factory=lambda: np.ones((2, 2)))
    inflation: Inflation | None = None

    @cached_property
    def crossings(self) -> Points:
        """Where the outer and the inner curve cross: there the patch is inside out, and its slice not to be trusted.

        Returns
        -------
        ndarray, shape (k, 2)
            Slice (row, col).
        """
        return crossings(*self.curves) if len(self.curves) == 2 else np.empty((0, 2))

    def record(self) -> dict[str, Any]:
        """JSON-able values of the slice.

        Returns
        -------
        dict
            plane, status, reason, where there are curves whether they are crossed, and those of `Inflation.record`.
        """
        # a slice without a balloon has no angles and no iterations to record
        facts: dict[str, Any] = {"plane": self.plane, "status": self.status, "reason": self.reason}
        if len(self.curves):
            facts["crossed"] = bool(len(self.crossings))
        return facts if self.inflation is None else facts | self.inflation.record()


@dataclass(frozen=True, eq=False)
class SlicedDesign:
    """What the method did for one opening in one direction, slice by slice; for pictures, tables and lessons.

    Parameters
    ----------
    opening : Opening
    frames : ndarray, shape (P, 3, 3)
        Origin, row and column vector of each slice, world mm: point = origin + row * r + col * c.
    unit : float
        mm per unit of the slices: 1, or the pixel size where the slices are planes of the scan.
    slices : tuple of SliceResult
    """

    opening: Opening
    frames: NDArray[np.float64]
    unit: float
    slices: tuple[SliceResult, ...]
