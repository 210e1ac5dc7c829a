"""A patch and the truth -> how far apart they are: overlap of voxels, distance of surfaces.

Frame: masks are `Volume`s on one grid, meshes stand in world mm; distances are in mm unless both meshes were taken
`in_voxels` first. An empty mask is a possible answer of a method, so it is measured, not refused: two empty masks
agree (Dice 1, distances 0, ratio 1); an empty mask against a filled one does not (Dice 0, distances inf).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree

from ..errors import InputRefused
from ..geometry.closest_point import nearest, pseudonormals
from ..mesh import Mesh
from ..prosthesis import INNER, OUTER, DistanceStats, Prosthesis
from ..volume import Volume, same_grid

BORDER = 10.0
"""Reach of the border Dice around the bone of the defective skull, mm (AutoImplant challenge 2021)."""


@dataclass(frozen=True)
class Score:
    """A patch against the true one.

    Parameters
    ----------
    dice, border_dice : float
        Overlap, 0 to 1; over all voxels, and over those within `BORDER` mm of bone.
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

    Raises
    ------
    InputRefused
        If the three do not share one grid (GridMismatch), or the skull has no bone (NoBone).
    """
    # one grid for all three: files round theirs, and a score must not depend on where a mask was stored
    _check_grid(patch, skull)
    _check_grid(truth, skull)
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
    """Dice similarity, 2 |A and B| / (|A| + |B|), 0 to 1; 1 for two empty masks."""
    _check_grid(patch, truth)
    return _dice(patch.voxels, truth.voxels)


def border_dice(patch: Volume, truth: Volume, skull: Volume, *, reach: float = BORDER) -> float:
    """Dice over the voxels within `reach` mm of any bone of the defective skull.

    Parameters
    ----------
    patch, truth, skull : Volume
        Bool masks (P, R, C) on one grid.
    reach : float
        mm between voxel centres.

    Raises
    ------
    InputRefused
        GridMismatch, or NoBone if the skull is empty: then there is no border.
    """
    _check_grid(patch, truth)
    _check_grid(patch, skull)
    if not skull.voxels.any():
        raise InputRefused("NoBone", "The skull mask is empty; the border Dice needs bone.")
    box = _box(patch.voxels, truth.voxels)
    a, b = patch.voxels[box], truth.voxels[box]
    near = _near_bone(skull, np.argwhere(a | b) + [s.start for s in box], reach)
    a, b = a[a | b], b[a | b]
    return _dice(a & near, b & near)


def volume_ratio(patch: Volume, truth: Volume) -> float:
    """Volume of the patch over the volume of the truth; 1 for two empty masks, inf where only the truth is empty."""
    _check_grid(patch, truth)
    found, wanted = int(np.count_nonzero(patch.voxels)), int(np.count_nonzero(truth.voxels))
    if wanted == 0:
        return 1.0 if found == 0 else float("inf")
    return found / wanted


def overlap(patch: Volume, skull: Volume) -> int:
    """Number of voxels that are both patch and bone."""
    _check_grid(patch, skull)
    box = _box(patch.voxels)
    return int(np.count_nonzero(patch.voxels[box] & skull.voxels[box]))


def hd95(patch: Volume, truth: Volume) -> float:
    """95th percentile of the `surface_distances`, mm: the Hausdorff distance without its outliers."""
    return _percentile95(surface_distances(patch, truth))


def assd(patch: Volume, truth: Volume) -> float:
    """Mean of the `surface_distances`, mm: average symmetric surface distance."""
    return _mean(surface_distances(patch, truth))


def rmse(patch: Volume, truth: Volume) -> float:
    """Root mean square of the `surface_distances`, mm."""
    return _root_mean_square(surface_distances(patch, truth))


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
    _check_grid(patch, truth)
    box = _box(patch.voxels, truth.voxels)
    a, b = (v.crop(box).to_world(np.argwhere(_surface(v.voxels[box]))) for v in (patch, truth))
    if not len(a) or not len(b):
        return np.full(len(a) + len(b), np.inf)
    return np.concatenate([cKDTree(b).query(a)[0], cKDTree(a).query(b)[0]])


def surface_distance(nodes: NDArray[np.float64], other: Mesh) -> NDArray[np.float64]:
    """Distance from each node to the nearest place on another surface, one way, as in the paper's Table 3.

    Parameters
    ----------
    nodes : ndarray, shape (N, 3)
        Nodes of the surface to be judged: the top or the inner side of a prosthesis.
    other : Mesh
        The surface taken as the truth, open or closed.

    Returns
    -------
    ndarray, shape (N,)
        Unsigned, exact (to triangles, not to nodes); mm, or voxels where both were taken `in_voxels`.
    """
    return nearest(nodes, other).distance


def signed_distance(nodes: NDArray[np.float64], other: Mesh) -> NDArray[np.float64]:
    """`surface_distance` with a sign: positive where the node lies on the outer side of the other surface.

    For an outer side: positive bulges, negative sinks in. Shape (N,).
    """
    found = nearest(nodes, other)
    side = np.einsum("nd,nd->n", nodes - found.places(other), pseudonormals(other, found))
    return np.copysign(found.distance, side)


def distance_stats(distances: NDArray[np.float64]) -> DistanceStats:
    """A row of Table 3 from distances of shape (N,), N > 0."""
    if not len(distances):
        raise InputRefused("EmptyMesh", "There are no distances to sum up; the surface has no nodes.")
    return DistanceStats(
        float(distances.min()), float(distances.max()), float(distances.mean()), float(distances.std())
    )


def in_voxels(mesh: Mesh, grid: Volume) -> Mesh:
    """The mesh in the (plane, row, col) frame of a grid, where distances count voxels as in the paper."""
    return Mesh(grid.to_voxel(mesh.vertices), mesh.faces)


def thickness(prosthesis: Prosthesis) -> NDArray[np.float64]:
    """Distance in mm from each node of the outer side to the inner side, shape (nodes of the outer surface,)."""
    return surface_distance(prosthesis.surface(OUTER).vertices, prosthesis.surface(INNER))


def thickness_rmse(prosthesis: Prosthesis, truth: Prosthesis) -> float:
    """Root mean square difference of thickness in mm, at each outer node and the true outer node nearest to it."""
    return thickness_error(prosthesis, thickness(prosthesis), truth, thickness(truth))


def thickness_error(
    prosthesis: Prosthesis, values: NDArray[np.float64], truth: Prosthesis, true_values: NDArray[np.float64]
) -> float:
    """`thickness_rmse` from the `thickness` of both, where that is known already."""
    nodes, true_nodes = prosthesis.surface(OUTER).vertices, truth.surface(OUTER).vertices
    if not len(nodes) or not len(true_nodes):
        raise InputRefused("EmptyMesh", "A prosthesis without an outer side has no thickness.")
    _, twin = cKDTree(true_nodes).query(nodes)
    return _root_mean_square(values - true_values[twin])


def _near_bone(skull: Volume, index: NDArray[np.intp], reach: float) -> NDArray[np.bool_]:
    """Whether each voxel of shape (N, 3) has its centre within `reach` mm of the centre of a bone voxel."""
    near = np.zeros(len(index), bool)
    if not len(index):
        return near
    margin = np.ceil(reach * np.linalg.norm(np.linalg.inv(skull.affine[:3, :3]), axis=1)).astype(int) + 1
    lo, hi = np.maximum(index.min(axis=0) - margin, 0), index.max(axis=0) + margin + 1
    box = tuple(slice(a, b) for a, b in zip(lo, hi, strict=True))
    bone = np.argwhere(_surface(skull.voxels[box])) + lo
    if not len(bone):
        return near
    near = _within(skull.to_world(index), skull.to_world(bone), reach)
    return near | skull.voxels[tuple(index.T)]


def _within(points: NDArray, others: NDArray, reach: float) -> NDArray[np.bool_]:
    """Whether each point, shape (N, 3), has one of the others within reach.

    A thinned set of the others settles most points: all of them lie within a cell's diagonal of it.
    """
    cell = reach / 5
    _, some = np.unique(np.floor(others / cell).astype(int), axis=0, return_index=True)
    slack = cell * np.sqrt(3)
    far = cKDTree(others[some]).query(points, distance_upper_bound=reach + slack)[0]
    within = far <= reach
    unsure = np.flatnonzero(~within & np.isfinite(far))
    bound = reach * (1 + 1e-9) + 1e-9  # the tree's bound is exclusive
    within[unsure] = np.isfinite(cKDTree(others).query(points[unsure], distance_upper_bound=bound)[0])
    return within


def _surface(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The mask minus its erosion by 6 neighbours."""
    return mask & ~ndimage.binary_erosion(mask)


def _box(*masks: NDArray[np.bool_]) -> tuple[slice, slice, slice]:
    """Smallest index box that holds all true voxels of the masks; empty if there are none."""
    sides = []
    for axis in range(3):
        across = tuple(a for a in range(3) if a != axis)
        hit = np.flatnonzero(np.any([m.any(axis=across) for m in masks], axis=0))
        sides.append(slice(int(hit[0]), int(hit[-1]) + 1) if len(hit) else slice(0, 0))
    return sides[0], sides[1], sides[2]


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


def _check_grid(a: Volume, b: Volume) -> None:
    if not same_grid(a, b):
        raise InputRefused(
            "GridMismatch",
            f"The masks stand on different grids, shapes {a.shape} and {b.shape}.",
            "Bring them onto one grid first.",
        )
