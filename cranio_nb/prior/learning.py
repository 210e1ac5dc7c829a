"""Intact skulls -> a shape prior.

Frames: mean head (see `mean_frame`), radii in mm of it; world mm (LPS).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InputRefused
from ..vault import opening_choice
from ..vault.head_frame import head_or_grid_axes
from ..vault.opening_search import survey_openings
from ..volume import Volume
from .alignment import align, centre_frames, mean_head
from .mean_frame import MeanFrame, even_directions
from .shape_prior import Prior
from .skull_points import SkullPoints, measure_outline, sample_surface, vault_in_image
from .vault_radii import interpolate_radius, local_median, measure_vault, mirror_radii, without_outliers

Array = NDArray[np.float64]

MIN_SKULLS = 2
"""Fewest skulls that make a prior."""
_IN_IMAGE = 0.98  # of the vault, of a scan of the whole head


def learn_prior(bones: Iterable[Volume], progress: Callable[[str, float], None] | None = None) -> Prior:
    """Learn a prior from intact skulls.

    Parameters
    ----------
    bones : iterable of Volume
        Bool masks, taken one at a time; each is to pass `check_intact`.
    progress : callable, optional
        Called with (step, fraction).

    Returns
    -------
    Prior

    Raises
    ------
    InputRefused
        ``TooFewSkulls``; ``NoVault``.
    """
    report = progress or (lambda step, done: None)
    # the masks stay, at one bit a voxel: they are measured once the mean head is known
    packed, skulls = [], []
    for bone in bones:
        packed.append(_Packed.of(bone))
        skulls.append(sample_surface(bone, head_or_grid_axes(bone)))
    if len(packed) < MIN_SKULLS:
        message = f"A prior needs {MIN_SKULLS} intact skulls; {len(packed)} could be used."
        raise InputRefused("TooFewSkulls", message, "Give a folder with more scans of whole heads.")
    # their radii in the frame of their mean head
    mean, frames = _lay_together(packed, skulls, report)
    middle = interpolate_radius(mean.outer)
    radii = []
    for i, (one, frame) in enumerate(zip(packed, frames, strict=True)):
        report("measuring", i / len(packed))
        radii.append(measure_vault(one.bone, frame, middle))
    return Prior(mean, _completed(np.array(radii)).astype(np.float32))


_WHOLE = "A prior is learned from scans of whole, closed skulls."


def check_intact(bone: Volume, scan: Volume | None = None) -> None:
    """Refuse what is not the intact skull of a whole head.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    scan : Volume, optional
        HU on the same grid, which shows bone too thin for the threshold.

    Raises
    ------
    InputRefused
        ``NotIntact`` where the skull has an opening that was cut; ``VaultLeavesImage`` where a part of the vault lies
        outside the image; ``NoVault``.
    """
    share = vault_in_image(bone)
    if share < _IN_IMAGE:
        message = f"{100 * (1 - share):.0f} % of the vault lies outside the image."
        raise InputRefused("VaultLeavesImage", message, _WHOLE)
    opening_choice.check_intact(survey_openings(bone, scan=scan), _WHOLE)


@dataclass(frozen=True, eq=False)
class _Packed:
    """A bone mask at one bit a voxel: thirty fit in memory."""

    bits: NDArray[np.uint8]
    shape: tuple[int, int, int]
    affine: Array

    @classmethod
    def of(cls, bone: Volume) -> _Packed:
        return cls(np.packbits(bone.voxels), bone.shape, bone.affine)

    @property
    def bone(self) -> Volume:
        voxels = np.unpackbits(self.bits, count=int(np.prod(self.shape)))
        return Volume(voxels.reshape(self.shape).view(bool), self.affine)


def _lay_together(
    packed: list[_Packed], skulls: list[SkullPoints], report: Callable[[str, float], None]
) -> tuple[SkullPoints, list[MeanFrame]]:
    """The mean head and each skull's frame on it: laid on the first skull by similarities, then twice on the mean."""
    mean, directions = skulls[0], even_directions(4)
    for turn, affine in enumerate((False, True, True)):
        frames = []
        for i, skull in enumerate(skulls):
            report("aligning", (turn + i / len(skulls)) / 3)
            frames.append(align(skull, mean, affine=affine))
        # the mean head of all skulls is the goal of the next round
        frames = centre_frames(frames, skulls)
        outlines = [measure_outline(p.bone, f, directions) for p, f in zip(packed, frames, strict=True)]
        mean = mean_head(np.array(outlines), directions)
    return mean, frames


def _completed(radii: Array) -> Array:
    """Radius maps (n, 2, m) of intact skulls; where a ray is missing or far off, the offset around it holds."""
    # what is usual at a ray: the mean head moved by what this skull differs around it
    middle = np.nanmedian(np.concatenate([radii, mirror_radii(radii)]), axis=0)
    usual = np.stack([middle + local_median(one - middle) for one in radii])
    sound = np.stack([without_outliers(one, around) for one, around in zip(radii, usual, strict=True)])
    return np.where(np.isfinite(sound), sound, usual)
