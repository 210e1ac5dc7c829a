"""A design's slices and distances -> rows of numbers: this run's Tables 1 to 3 and the paper's own.

Frames: angles in degrees, lengths in mm unless a name says voxels.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

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
    # only slices with their own balloons have angles and steps
    own = [s for s in slices if s["status"] == "balloon"]
    if not own:
        return {}
    values = {key: np.array([s[key] for s in own]) for key in ("theta0", "theta1", "n_iter")}
    return {
        side: {key: (v[:, i].min().item(), v[:, i].max().item()) for key, v in values.items()}
        for i, side in enumerate(("outer", "inner"))
    }


def count_statuses(slices: Sequence[dict[str, Any]]) -> dict[str, int]:
    """Number of slices of each of the `STATUSES`.

    Parameters
    ----------
    slices : sequence of dict
        As for `balloon_ranges`.

    Returns
    -------
    dict of str to int

    Examples
    --------
    >>> count_statuses([{"status": "hull"}, {"status": "hull"}])
    {'balloon': 0, 'hull': 2, 'carried': 0, 'skipped': 0}
    """
    found = Counter(s["status"] for s in slices)
    return {status: found[status] for status in STATUSES}


def count_not_converged(slices: Sequence[dict[str, Any]]) -> int:
    """Number of slices with a balloon that was stopped before it came to rest.

    Parameters
    ----------
    slices : sequence of dict
        As for `balloon_ranges`.

    Returns
    -------
    int
    """
    return sum(not all(s["converged"]) for s in slices if s["status"] == "balloon")


def count_crossed(slices: Sequence[dict[str, Any]]) -> int:
    """Number of slices whose outer and inner curve cross.

    Parameters
    ----------
    slices : sequence of dict
        As for `balloon_ranges`.

    Returns
    -------
    int

    Examples
    --------
    >>> count_crossed([{"status": "carried", "crossed": True}, {"status": "skipped"}])
    1
    """
    return sum(s.get("crossed", False) for s in slices)


def pick_slices(kinds: Sequence[str], n: int) -> list[int]:
    """Which slices to show: evenly spread, with one of each kind other than "balloon" among them.

    Parameters
    ----------
    kinds : sequence of str
        Of all slices, in order: their status, or "crossed".
    n : int
        Number wanted.

    Returns
    -------
    list of int
        At most `n` indices, rising.

    Examples
    --------
    >>> pick_slices(["balloon"] * 4 + ["hull"] + ["balloon"] * 4, 3)
    [2, 4, 7]
    """
    # the middle one of each other kind, then balloons at even steps
    special = []
    for kind in ("crossed", *STATUSES[1:]):
        at = [i for i, one in enumerate(kinds) if one == kind]
        special += at[len(at) // 2 : len(at) // 2 + 1]
    special = special[: max(n - 1, 0)]
    plain = [i for i, one in enumerate(kinds) if one == "balloon"]
    n_plain = min(n - len(special), len(plain))
    even = (np.arange(n_plain) + 0.5) / max(n_plain, 1) * len(plain)
    return sorted(special + [plain[int(i)] for i in even])
