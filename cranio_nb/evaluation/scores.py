"""A patch and the truth as masks -> how far apart they are: overlap of voxels, distance of surface voxels.

Frame: masks are volumes on one grid; distances in mm. An empty mask is a possible answer of a method, so it is
measured, not refused: two empty masks agree (Dice 1, distances 0, ratio 1); an empty mask against a filled one does
not (Dice 0, distances inf).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree

from ..errors import InputRefused
from ..grid import Box, box_around
from ..volume import Volume, check_same_grid

BORDER_MM = 10.0
"""Reach of the border Dice around the bone of the defective skull (AutoImplant challenge 2021)."""


@dataclass(frozen=True)
class Score:
    """A patch against the true one.

    Parameters
    ----------
    dice, border_dice : float
        Overlap, 0 to 1; over all voxels, and over those within `BORDER_MM` of bone.
    hd95, assd, rmse : float
        95th percentile, mean and root mean square of the surface distances both ways, mm.
    volume_ratio : float
        Volume of the patch over that of the truth.
    overlap : int
        Patch voxels that are bone already; 0 for a patch that can be built.
    """

    dice: float
    border_dice: float
    hd95: float
    assd: float
    rmse: float
    volume_ratio: float
    overlap: int


def score(patch: Volume, truth: Volume, skull: Volume) -> Score:
    """All voxel measures of a patch.

    Parameters
    ----------
    patch, truth : Volume
        Bool masks (P, R, C) of the designed and the true prosthesis.
    skull : Volume
        Bool mask (P, R, C) of the skull with the hole.

    Returns
    -------
    Score

    Raises
    ------
    InputRefused
        If the three do not share one grid (GridMismatch), or the skull has no bone (NoBone).

    Examples
    --------
    >>> grid = Volume(np.zeros((4, 9, 9), bool), np.eye(4))
    >>> truth, patch, skull = grid.voxels.copy(), grid.voxels.copy(), grid.voxels.copy()
    >>> truth[:, 2:8, :], patch[:, 2:6, :], skull[:, 0, :] = True, True, True
    >>> found = score(grid.with_voxels(patch), grid.with_voxels(truth), grid.with_voxels(skull))
    >>> round(found.dice, 9), round(found.volume_ratio, 3), found.overlap
    (0.8, 0.667, 0)
    """
    # one grid for all three: files round theirs, and a score must not depend on where a mask was stored
    check_same_grid(patch, skull, "patch and skull")
    check_same_grid(truth, skull, "truth and skull")
    patch, truth = skull.with_voxels(patch.voxels), skull.with_voxels(truth.voxels)
    distances = surface_distances(patch, truth)
    return Score(
        dice=dice(patch, truth),
        border_dice=border_dice(patch, truth, skull),
        hd95=_percentile95(distances),
        assd=_mean(distances),
        rmse=_root_mean_square(distances),
        volume_ratio=volume_ratio(patch, truth),
        overlap=overlap(patch, skull),
    )


def dice(patch: Volume, truth: Volume) -> float:
    """Dice similarity, ``2 |A and B| / (|A| + |B|)``.

    Parameters
    ----------
    patch, truth : Volume
        Bool masks (P, R, C) on one grid.

    Returns
    -------
    float
        0 to 1; 1 for two empty masks.

    Examples
    --------
    >>> a, b = (Volume(np.arange(4).reshape(1, 1, 4) < n, np.eye(4)) for n in (1, 3))
    >>> dice(a, b)
    0.5
    """
    check_same_grid(patch, truth, "patch and truth")
    return _dice(patch.voxels, truth.voxels)


def border_dice(patch: Volume, truth: Volume, skull: Volume, *, reach_mm: float = BORDER_MM) -> float:
    """Dice over the voxels within `reach_mm` of any bone of the defective skull.

    Parameters
    ----------
    patch, truth, skull : Volume
        Bool masks (P, R, C) on one grid.
    reach_mm : float
        Between voxel centres.

    Returns
    -------
    float
        0 to 1.

    Raises
    ------
    InputRefused
        GridMismatch, or NoBone if the skull is empty: then there is no border.
    """
    check_same_grid(patch, truth, "patch and truth")
    check_same_grid(patch, skull, "patch and skull")
    if not skull.voxels.any():
        raise InputRefused("NoBone", "The skull mask is empty; the border Dice needs bone.")
    # only voxels of either mask count
    box = _box(patch.voxels, truth.voxels)
    a, b = patch.voxels[box], truth.voxels[box]
    near = _near_bone(skull, np.argwhere(a | b) + [s.start for s in box], reach_mm)
    a, b = a[a | b], b[a | b]
    return _dice(a & near, b & near)


def volume_ratio(patch: Volume, truth: Volume) -> float:
    """Volume of the patch over the volume of the truth.

    Parameters
    ----------
    patch, truth : Volume
        As for `dice`.

    Returns
    -------
    float
        1 for two empty masks, inf where only the truth is empty.
    """
    check_same_grid(patch, truth, "patch and truth")
    # both on one grid: the volume of a voxel cancels
    found, wanted = int(np.count_nonzero(patch.voxels)), int(np.count_nonzero(truth.voxels))
    if wanted == 0:
        return 1.0 if found == 0 else float("inf")
    return found / wanted


def overlap(patch: Volume, skull: Volume) -> int:
    """Number of voxels that are both patch and bone.

    Parameters
    ----------
    patch, skull : Volume
        Bool masks (P, R, C) on one grid.

    Returns
    -------
    int
    """
    check_same_grid(patch, skull, "patch and skull")
    box = _box(patch.voxels)
    return int(np.count_nonzero(patch.voxels[box] & skull.voxels[box]))


def assd(patch: Volume, truth: Volume) -> float:
    """Mean of the `surface_distances`: average symmetric surface distance.

    Parameters
    ----------
    patch, truth : Volume
        As for `dice`.

    Returns
    -------
    float
        mm.
    """
    return _mean(surface_distances(patch, truth))


def surface_distances(patch: Volume, truth: Volume) -> NDArray[np.float64]:
    """Distances between the surface voxels of two masks, from each to the other, stacked.

    Parameters
    ----------
    patch, truth : Volume
        Bool masks (P, R, C) on one grid. Surface voxels are the mask minus its erosion by 6 neighbours; what lies
        outside the volume counts as empty.

    Returns
    -------
    ndarray, shape (N,)
        mm, first from the patch's surface to the truth's, then back. No values if both are empty; inf for every
        surface voxel if one is.
    """
    check_same_grid(patch, truth, "patch and truth")
    box = _box(patch.voxels, truth.voxels)
    # surface voxels of both in mm, within the box that holds both
    a, b = (v.crop(box).to_world(np.argwhere(_surface(v.voxels[box]))) for v in (patch, truth))
    # to a surface without voxels the tree gives inf
    return np.concatenate([cKDTree(b).query(a)[0], cKDTree(a).query(b)[0]])


def _near_bone(skull: Volume, index: NDArray[np.intp], reach: float) -> NDArray[np.bool_]:
    """Whether each voxel of shape (N, 3) has its centre within `reach` mm of the centre of a bone voxel."""
    # a bone voxel is its own nearest; others by the distance to the bone's surface
    near = np.zeros(len(index), bool)
    if not len(index):
        return near
    # only bone in reach of any of the voxels counts
    margin = np.ceil(reach * np.linalg.norm(skull.steps(np.eye(3)), axis=0)).astype(int) + 1
    box = box_around(index, skull.shape, margin)
    bone = np.argwhere(_surface(skull.voxels[box])) + [side.start for side in box]
    if not len(bone):
        return near
    near = _within(skull.to_world(index), skull.to_world(bone), reach)
    return near | skull.voxels[tuple(index.T)]


def _within(points: NDArray, others: NDArray, reach: float) -> NDArray[np.bool_]:
    """Whether each point, shape (N, 3), has one of the others within reach.

    A thinned set of the others settles most points: all of them lie within a cell's diagonal of it.
    """
    # one point of each cell
    cell = reach / 5
    _, some = np.unique(np.floor(others / cell).astype(int), axis=0, return_index=True)
    slack = cell * np.sqrt(3)
    far = cKDTree(others[some]).query(points, distance_upper_bound=reach + slack)[0]
    within = far <= reach
    # the rest is asked exactly
    unsure = np.flatnonzero(~within & np.isfinite(far))
    bound = reach * (1 + 1e-9) + 1e-9  # the tree's bound is exclusive
    within[unsure] = np.isfinite(cKDTree(others).query(points[unsure], distance_upper_bound=bound)[0])
    return within


def _surface(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The mask minus its erosion by 6 neighbours."""
    return mask & ~ndimage.binary_erosion(mask)


def _box(*masks: NDArray[np.bool_]) -> Box:
    """Smallest index box that holds all true voxels of the masks; empty if there are none."""
    return Volume(np.logical_or.reduce(masks), np.eye(4)).box()


def _dice(a: NDArray[np.bool_], b: NDArray[np.bool_]) -> float:
    total = int(np.count_nonzero(a)) + int(np.count_nonzero(b))
    return 2 * int(np.count_nonzero(a & b)) / total if total else 1.0


def _percentile95(distances: NDArray[np.float64]) -> float:
    if not np.isfinite(distances).all():
        return float("inf")
    return float(np.percentile(distances, 95)) if len(distances) else 0.0


def _mean(distances: NDArray[np.float64]) -> float:
    return float(distances.mean()) if len(distances) else 0.0


def _root_mean_square(distances: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.square(distances).mean())) if len(distances) else 0.0
