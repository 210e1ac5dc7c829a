"""How much bone lies across an opening: thin bone by partial volume, told from a hole that is soft all through.

Frames: rays in the world (LPS), lengths in mm, attenuation in HU.

A wall thinner than a voxel, or a dome that a thick slice cuts flat, falls below any threshold, but what it attenuates
is not lost: the excess over its surroundings, summed along a ray across it, is that of the bone. So

    t = integral of (HU - m) ds / (B - m), over samples with HU > m + 100,

m the medium in the head (brain, or air in a dry skull) and B the median HU of its bone, is the thickness of the bone
in mm. Where a piece was cut out, t is 0. A mask gives the same with 0 and 1 for m and B, blended between its voxels.

In a dry skull m is air, and a hole may be closed by skin, gel or plastic that is denser: a ray that meets a layer of
soft tissue and nothing denser meets no bone. Thin bone blurred with air passes the same HU, but on its flanks only.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..grid import box_around
from ..volume import Volume

Array = NDArray[np.float64]

_BELOW_MM, _STEP_MM = 12.0, 0.75  # the expected outer surface, and between samples
_MARGIN_HU = 100.0  # above the medium up to which soft tissue and noise count for nothing
SOFT_HU = 150.0
"""About water: fat has -100 HU, clotted blood, the densest soft tissue, less than 100."""
_LAYER_MM = 3.0  # of soft tissue: thinner than any scalp, wider than the flanks of a blurred wall
_INSIDE_MM = np.array([5.0, 15.0, 25.0, 35.0])  # from the head's centre, where the medium is measured


@dataclass(frozen=True, eq=False)
class Material:
    """The voxels that show how much bone there is, and their scale.

    Parameters
    ----------
    volume : Volume
        HU, or a bool mask.
    medium, bone, margin : float
        Value of what fills the head, of bone, and up to which the medium may rise by itself.
    """

    volume: Volume
    medium: float
    bone: float
    margin: float

    @classmethod
    def of(cls, bone: Volume, ct: Volume | None, centre: Array, directions: Array) -> Material:
        """The scale of a scan.

        Parameters
        ----------
        bone : Volume
            Bool mask.
        ct : Volume or None
            HU on the same grid.
        centre : ndarray, shape (3,)
            Inside the cavity, world mm.
        directions : ndarray, shape (n, 3)
            Unit vectors, world.

        Returns
        -------
        Material
        """
        if ct is None or ct.voxels.dtype == bool:
            return cls(bone, 0.0, 1.0, 0.0)
        inside = ct.at(centre + directions[::7] * _INSIDE_MM[:, None, None], outside=np.nan)
        part = np.s_[:: max(1, ct.shape[0] // 64), ::4, ::4]
        return cls(ct, float(np.nanmedian(inside)), float(np.median(ct.voxels[part][bone.voxels[part]])), _MARGIN_HU)

    def thickness(self, centre: Array, directions: Array, radius: Array, *, above_mm: float) -> Array:
        """Bone across each ray about a radius.

        Parameters
        ----------
        centre : ndarray, shape (3,)
            Where the rays start, world mm.
        directions : ndarray, shape (n, 3)
            Unit vectors, world.
        radius : ndarray, shape (n,)
            Where the outer surface is expected, mm.
        above_mm : float
            How far above it bone may lie: what is fixed to the scalp lies higher.

        Returns
        -------
        ndarray, shape (n,)
            mm.
        """
        depths = np.arange(-_BELOW_MM, above_mm, _STEP_MM)
        points = centre + directions[:, None] * (radius[:, None] + depths)[..., None]
        index = self.volume.to_voxel(points)
        # only the box around the rays is turned into floats
        box = box_around(index.reshape(-1, 3), self.volume.shape, margin=1)
        start = np.array([side.start for side in box])
        values = ndimage.map_coordinates(
            self.volume.voxels[box].astype(np.float32),
            np.moveaxis(index - start, -1, 0),
            order=1,
            mode="constant",
            cval=self.medium,
        )
        excess = np.minimum(values, self.bone) - self.medium  # metal counts no more than bone
        thickness = np.where(excess > self.margin, excess, 0.0).sum(axis=1) * _STEP_MM / (self.bone - self.medium)
        if self.volume.voxels.dtype == bool:
            return thickness
        # soft tissue is no bone, also where the head is full of air
        layer_mm = (np.abs(values) < SOFT_HU).sum(axis=1) * _STEP_MM
        return np.where((values.max(axis=1) < SOFT_HU) & (layer_mm >= _LAYER_MM), 0.0, thickness)
