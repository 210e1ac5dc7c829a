"""More than one skull in an image: the large parts beside the skull come in -> a finding for each that is one too.

Frame: world (mm, LPS).

A skull encloses a cavity. Couches, holders, jaws and vertebrae do not; the cap of a sawn skull shares the cavity of
the rest of it, so that the middles of both lie near each other.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..errors import InputRefused
from ..readers import Finding
from ..volume import Volume
from .cavity import cavity_ball, coarse_bone
from .opening_size import name_place
from .orientation import head_axes

_APART_MM = 90.0  # between the middles of two cavities: two newborns' heads that touch are farther apart


def second_skull_remarks(bone: Volume, others: Sequence[Volume]) -> tuple[Finding, ...]:
    """Say that there is another skull in the image.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull that is examined.
    others : sequence of Volume
        Bool masks of the other large parts (`segmentation.Parts.others`).

    Returns
    -------
    tuple of Finding
        ``SecondSkull`` (warning) for each, with its planes, its extent in mm and where it lies.
    """
    middles = [(other, _cavity(other)) for other in others]
    skulls = [(other, middle) for other, middle in middles if middle is not None]
    own = _cavity(bone) if skulls else None
    if own is None:
        return ()
    return tuple(
        _remark(bone, other, middle - own) for other, middle in skulls if np.linalg.norm(middle - own) > _APART_MM
    )


def _cavity(part: Volume) -> NDArray[np.float64] | None:
    """Middle of the cavity that a part encloses by itself, world mm; None where it encloses none."""
    try:
        return cavity_ball(coarse_bone(part))[0]
    except InputRefused:
        return None


def _remark(bone: Volume, other: Volume, way: NDArray[np.float64]) -> Finding:
    """The finding on one of them, `way` from the cavity of the skull that is examined, mm."""
    (first, last), (its_first, its_last) = (_planes(bone, part) for part in (bone, other))
    extent = [round(float(n * step)) for n, step in zip(other.shape, other.spacing, strict=True)]
    distance = float(np.linalg.norm(way))
    place = name_place(head_axes(bone) @ way / distance)
    message = (
        f"There is a second skull in the image, {' x '.join(map(str, extent))} mm, in planes {its_first} to {its_last},"
        f" {distance:.0f} mm from the other ({place}). It is not looked at: only the skull in planes {first} to {last}"
        " is. If the second one is meant, give an image of it alone."
    )
    values = {"planes": [its_first, its_last], "extent_mm": extent, "distance_mm": round(distance, 1), "place": place}
    return Finding("SecondSkull", "warning", message, values)


def _planes(bone: Volume, part: Volume) -> tuple[int, int]:
    """First and last plane of a part, counted on the grid of the skull."""
    planes = np.flatnonzero(part.voxels.any(axis=(1, 2)))
    start = round(float(bone.to_voxel(part.to_world(np.zeros(3)))[0]))
    return start + int(planes[0]), start + int(planes[-1])
