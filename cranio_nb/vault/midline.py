"""The midline of a head that may lie in any way: bone in blocks and the way to the face come in -> a plane goes out.

Frame: world mm of the mask given.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, optimize

from ..volume import Volume

Array = NDArray[np.float64]

_HEAD_MM, _FARTHEST_MM, _POINTS = 105.0, 12.0, 1500  # about the centre; distance that counts at most; compared


@dataclass(frozen=True, eq=False)
class _Mirror:
    """Points of a head about its centre (n, 3), and how far each place is from bone."""

    points: Array
    start: Array
    field: Volume

    @classmethod
    def of(cls, coarse: Volume, centre: Array) -> _Mirror:
        points = coarse.to_world(np.argwhere(coarse.voxels)) - centre
        points = points[np.linalg.norm(points, axis=1) < _HEAD_MM]
        apart = ndimage.distance_transform_edt(~coarse.voxels, sampling=coarse.spacing)
        field = coarse.with_voxels(np.minimum(apart, _FARTHEST_MM))
        return cls(points[:: max(1, len(points) // _POINTS)], coarse.to_voxel(centre), field)

    def misfit(self, normal: Array, shift: float) -> float:
        """Mean distance in mm of the mirrored points from bone."""
        mirrored = self.points - 2 * (self.points @ normal - shift)[:, None] * normal
        away = self.field.at_index(self.start + self.field.steps(mirrored), outside=np.nan)
        seen = np.isfinite(away)
        return float(away[seen].mean()) if seen.mean() > 0.5 else _FARTHEST_MM


def find_midline(coarse: Volume, centre: Array, face: Array) -> tuple[Array, float, float]:
    """The plane through the face in which a head is most nearly its own mirror image.

    Parameters
    ----------
    coarse : Volume
        Bool mask of the skull in blocks, from `cavity.coarse_bone`.
    centre : ndarray, shape (3,)
        In the middle of the cavity, world mm.
    face : ndarray, shape (3,)
        Points to the face, any length, world.

    Returns
    -------
    normal : ndarray, shape (3,)
        Unit vector, world; to either side.
    shift : float
        Signed distance of the plane from the centre along the normal, mm.
    asymmetry : float
        Mean distance of the mirrored bone from the bone, mm.
    """
    # the best of planes some degrees and 8 mm apart
    mirror = _Mirror.of(coarse, centre)
    _, normal, shift = min(
        ((mirror.misfit(n, s), n, s) for n in _normals_beside(face) for s in (-8.0, 0.0, 8.0)),
        key=lambda plane: plane[0],
    )
    # from there by Nelder and Mead's simplex: two turns and the shift
    sides = np.linalg.svd(normal[None])[2][1:]

    def moved(x: Array) -> Array:
        turned = normal + x[0] / 50 * sides[0] + x[1] / 50 * sides[1]  # mm at 50 mm
        return np.asarray(turned / np.linalg.norm(turned))

    simplex = np.array([[0, 0, shift], [4, 0, shift], [0, 4, shift], [0, 0, shift + 3]], float)
    found = optimize.minimize(
        lambda x: mirror.misfit(moved(x), x[2]),
        simplex[0],
        method="Nelder-Mead",
        options={"initial_simplex": simplex, "xatol": 0.2, "fatol": 0.005, "maxiter": 80},
    )
    return moved(found.x), float(found.x[2]), float(found.fun)


def _normals_beside(face: Array) -> list[Array]:
    """Unit vectors within 20 degrees of right angles to the face, 6 to 10 degrees apart."""
    forward = face / np.linalg.norm(face)
    across = np.linalg.svd(forward[None])[2][1:]
    turns, leans = np.radians(np.arange(0, 180, 6)), np.radians([-20, -10, 0, 10, 20])
    return [
        np.cos(lean) * (np.cos(turn) * across[0] + np.sin(turn) * across[1]) + np.sin(lean) * forward
        for turn in turns
        for lean in leans
    ]
