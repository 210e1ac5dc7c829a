"""The distance of the slices -> the smallest hole that a scan can show."""

from __future__ import annotations

LEAST_MM = 8.0
"""Width of the smallest opening that is looked for: sutures, vessels and pits of thin bone are narrower."""
THICK_MM = 2.9
"""A slice as thick as the vault's thin places is wide: 3 mm, and what is rounded to it."""
_CORE_MM = 6.0  # of an opening must be seen free; thick slices blur up to one slice of it at each rim


def smallest_hole_mm(slice_mm: float) -> float:
    """Width of the smallest hole that is found for sure.

    Parameters
    ----------
    slice_mm : float
        Distance of the slices.

    Returns
    -------
    float
        mm.

    Examples
    --------
    >>> smallest_hole_mm(1.0), smallest_hole_mm(5.0)
    (8.0, 16.0)
    """
    return LEAST_MM if slice_mm < THICK_MM else _CORE_MM + 2 * slice_mm
