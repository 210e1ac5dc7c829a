"""Bone -> a coarse, smooth surface, to be the surroundings in pictures.

Frame: world mm (LPS).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage.measure import marching_cubes

from ..geometry.slice_distance import plane_distances
from ..grid import move_affine
from ..mesh import Mesh
from ..volume import Volume

_COARSE_MM = 1.3  # voxels of the surface
_BONE_SHARE = 0.4  # of a coarse voxel, from which it is inside
_FAR_PX = 8  # distances beyond this do not matter


def skull_surface(bone: Volume, floor_mm: float = -np.inf) -> Mesh:
    """Coarse, smooth surface of the bone above a height, for surroundings in pictures (never for measures).

    Parameters
    ----------
    bone : Volume
        Bool mask.
    floor_mm : float
        World z below which bone is left out: the face does not belong in a picture of the vault.

    Returns
    -------
    Mesh
        World mm, normals outward; empty where there is no bone.

    Examples
    --------
    >>> bone = np.zeros((20, 20, 20), bool)
    >>> bone[5:15, 5:15, 5:15] = True
    >>> skull_surface(Volume(bone, np.eye(4))).vertices.mean(axis=0).round(1).tolist()
    [9.5, 9.5, 9.5]
    """
    part = _above(bone, floor_mm)
    if not part.voxels.any():
        return Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.intp))
    # a rim of "no bone" around the field closes the surface where bone reaches the edge of the image
    field = _field(part)
    padded = np.pad(field.voxels, 1, constant_values=-1)
    vertices, faces, _, _ = marching_cubes(padded, 0.0, method="lorensen")
    mesh = Mesh(field.to_world(vertices - 1), faces.astype(np.intp))
    return mesh if mesh.volume > 0 else Mesh(mesh.vertices, mesh.faces[:, ::-1].copy())


def _above(bone: Volume, floor_mm: float) -> Volume:
    """The box of the bone, cut off at a height; planes of the package's volumes rise to the top of the head."""
    planes, rows, cols = bone.box()
    if planes.stop == 0:
        return bone
    # heights of the planes' middles: planes may lean, when the gantry was tilted
    middle = [(s.start + s.stop) / 2 for s in (rows, cols)]
    heights = bone.to_world([[k, *middle] for k in range(planes.start, planes.stop)])[:, 2]
    low = planes.start + int(np.count_nonzero(heights < floor_mm))
    return bone.crop((slice(low, planes.stop), rows, cols))


def _field(part: Volume) -> Volume:
    """Smooth field on voxels of about 1.3 mm, positive in bone: slice outlines are joined by signed distances."""
    # share of bone in blocks of whole voxels, as near to the coarse size as these allow
    block = np.maximum(1, np.rint(_COARSE_MM / part.spacing)).astype(int)
    share = _bone_in_blocks(part.voxels, block) / np.float32(block.prod())
    affine = move_affine(part.affine, (block - 1) / 2, block)  # coarse voxels in the middle of their blocks
    # planes farther apart than that: distances to their outlines, drawn out linearly between them
    split = max(1, round(float(part.spacing[0] * block[0]) / _COARSE_MM))
    field = share - np.float32(_BONE_SHARE)
    if split > 1:
        distances = plane_distances(share > _BONE_SHARE, _FAR_PX).astype(np.float32)
        n_planes = len(distances)
        field = ndimage.zoom(distances, (((n_planes - 1) * split + 1) / n_planes, 1, 1), order=1)
        affine = move_affine(affine, (0, 0, 0), (1 / split, 1, 1))
    sigma = (0.7, 0.7, 0.7) if split == 1 else (0.8 * split, 1.3, 1.3)
    return Volume(ndimage.gaussian_filter(field, sigma), affine)


def _bone_in_blocks(mask: NDArray[np.bool_], block: NDArray[np.intp]) -> NDArray[np.uint16]:
    """Number of bone voxels in each block; there is none beyond the mask."""
    count = mask.astype(np.uint16)
    for axis, n in enumerate(block):
        # the first of every n layers, and the others added to them
        first, *others = (count[(slice(None),) * axis + (slice(k, None, n),)] for k in range(n))
        count = first.copy()
        for other in others:
            count[(slice(None),) * axis + (slice(other.shape[axis]),)] += other
    return count
