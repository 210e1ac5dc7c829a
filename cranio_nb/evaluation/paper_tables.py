"""A design's slices, openings and distances -> rows of numbers: this run's Tables 1 to 3 and the paper's own.

Frames: angles in degrees, lengths in mm unless a name says voxels.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..opening import Opening
from ..prosthesis import DistanceStats

PAPER_BALLOONS = {
    "outer": {"theta0": (4.0, 22.0), "theta1": (156.0, 169.0), "n_iter": (48, 135)},
    "inner": {"theta0": (12.0, 29.0), "theta1": (143.0, 156.0), "n_iter": (31, 147)},
}
"""The paper's Tables 1 (outer) and 2 (inner): smallest and largest value. Its text takes 135 and 147 for means."""

PAPER_DISTANCES = {
    "outer": DistanceStats(0.0, 2.89, 1.10, 0.52),
    "inner": DistanceStats(0.0, 3.16, 0.72, 0.48),
    "You et al.": DistanceStats(0.06, 6.06, 3.09, 1.34),
}
"""The paper's Table 3, in voxels, against a reflection."""

STATUSES = ("balloon", "hull", "carried", "skipped")
"""How a slice was filled: by its own balloons, by the convex hull, from its neighbours, not at all."""


@dataclass(frozen=True)
class OpeningSize:
    """An opening in words and numbers.

    Parameters
    ----------
    planes : tuple of int
        First and last plane, both of them in it.
    length, width : float
        Long and short extent across the direction of the opening, mm.
    centre : tuple of float
        World mm, LPS.
    direction : tuple of float
        Unit vector from the head's centre to it, LPS.
    lowest : float
        World z of its lowest place, mm.
    place : str
        Where it lies on the head, e.g. "left, top".
    """

    planes: tuple[int, int]
    length: float
    width: float
    centre: tuple[float, float, float]
    direction: tuple[float, float, float]
    lowest: float
    place: str


def measure_opening(opening: Opening) -> OpeningSize:
    """Measure an opening by its coarse sheet."""
    index = np.argwhere(opening.sheet.voxels)
    points = opening.sheet.to_world(index)
    centre = points.mean(axis=0)
    out = (centre - opening.head_centre) / np.linalg.norm(centre - opening.head_centre)
    flat = (points - centre)[::3]
    flat = flat - np.outer(flat @ out, out)
    axes = np.linalg.eigh(flat.T @ flat)[1][:, :0:-1].T
    length, width = (float(np.ptp(np.quantile(flat @ axis, [0.005, 0.995]))) for axis in axes)
    return OpeningSize(
        (int(index[0, 0]), int(index[-1, 0])),
        length,
        width,
        tuple(centre.tolist()),
        tuple(out.tolist()),
        float(points[:, 2].min()),
        place(out),
    )


def place(direction: Sequence[float] | np.ndarray) -> str:
    """Words for a direction from the head's centre (LPS).

    Examples
    --------
    >>> place([0.8, -0.5, 0.1])
    'left, front'
    """
    names = (("right", "left"), ("front", "back"), ("base", "top"))
    x, y, z = direction
    words = [pair[int(v > 0)] for pair, v in zip(names, (x, y, z), strict=True) if abs(v) > 0.38]
    return ", ".join(words)


def balloon_ranges(slices: Sequence[dict[str, Any]]) -> dict[str, dict[str, tuple[float, float]]]:
    """Tables 1 and 2 of a run: smallest and largest angle (degrees) and number of steps of the balloons.

    Parameters
    ----------
    slices : sequence of dict
        `Prosthesis.record["slices"]`.

    Returns
    -------
    dict
        ``{"outer": {"theta0": (min, max), "theta1": ..., "n_iter": ...}, "inner": ...}``; empty without balloons.
    """
    own = [s for s in slices if s["status"] == "balloon"]
    if not own:
        return {}
    values = {key: np.array([s[key] for s in own]) for key in ("theta0", "theta1", "n_iter")}
    return {
        side: {key: (v[:, i].min().item(), v[:, i].max().item()) for key, v in values.items()}
        for i, side in enumerate(("outer", "inner"))
    }


def count_statuses(slices: Sequence[dict[str, Any]]) -> dict[str, int]:
    """Number of slices of each of the `STATUSES`."""
    found = Counter(s["status"] for s in slices)
    return {status: found[status] for status in STATUSES}


def not_converged(slices: Sequence[dict[str, Any]]) -> int:
    """Number of slices with a balloon that was stopped before it came to rest."""
    return sum(not all(s["converged"]) for s in slices if s["status"] == "balloon")


def telling_slices(statuses: Sequence[str], n: int) -> list[int]:
    """Which slices to show: evenly spread, with one of each kind other than "balloon" among them.

    Parameters
    ----------
    statuses : sequence of str
        Of all slices, in order.
    n : int
        Number wanted.

    Returns
    -------
    list of int
        At most `n` indices, rising.
    """
    special = []
    for status in STATUSES[1:]:
        at = [i for i, s in enumerate(statuses) if s == status]
        special += at[len(at) // 2 : len(at) // 2 + 1]
    special = special[: max(n - 1, 0)]
    plain = [i for i, s in enumerate(statuses) if s == "balloon"]
    n_plain = min(n - len(special), len(plain))
    even = (np.arange(n_plain) + 0.5) / max(n_plain, 1) * len(plain)
    return sorted(special + [plain[int(i)] for i in even])
