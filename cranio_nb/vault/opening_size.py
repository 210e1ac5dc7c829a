"""An opening -> how large it is and where it lies on the head.

Frames: lengths in mm; directions and points in the world (LPS); planes of the scan.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..grid import true_indices
from ..opening import Opening


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
        Where it lies on the head, e.g. "left, top"; by the axes of the scan where those of the head are not known.
    """

    planes: tuple[int, int]
    length: float
    width: float
    centre: tuple[float, float, float]
    direction: tuple[float, float, float]
    lowest: float
    place: str


def measure_opening(opening: Opening) -> OpeningSize:
    """Measure an opening by its coarse sheet.

    Parameters
    ----------
    opening : Opening

    Returns
    -------
    OpeningSize
    """
    index = true_indices(opening.sheet.voxels)
    points = opening.sheet.to_world(index)
    centre = points.mean(axis=0)
    # unit direction out of the head
    out = (centre - opening.head_centre) / np.linalg.norm(centre - opening.head_centre)
    # extents across its direction, along the principal axes, without the outermost percent
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
        name_place(out if opening.head_axes is None else opening.head_axes @ out),
    )


def name_place(direction: Sequence[float] | np.ndarray) -> str:
    """Words for a direction from the head's centre.

    Parameters
    ----------
    direction : array_like, shape (3,)
        Unit vector along the head's left, back and up.

    Returns
    -------
    str

    Examples
    --------
    >>> name_place([0.8, -0.5, 0.1])
    'left, front'
    """
    # a side is named when the direction leads to it by more than 22 degrees: sin 22 = 0.38
    names = (("right", "left"), ("front", "back"), ("base", "top"))
    x, y, z = direction
    words = [pair[int(v > 0)] for pair, v in zip(names, (x, y, z), strict=True) if abs(v) > 0.38]
    return ", ".join(words)
