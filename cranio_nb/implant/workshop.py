"""A patch or a mesh -> what a workshop asks: its volume and mass, whether it goes in, room to fit.

Frame: masks as `Volume`s on the bone's grid, meshes in world mm, axes as unit vectors in the world (LPS).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..errors import InputRefused
from ..mesh import Mesh
from ..volume import Volume, same_grid

DENSITIES = {"PMMA": 1.19, "PEEK": 1.31, "Ti-6Al-4V": 4.43}
"""g/cm3 at room temperature, solid material: W. D. Callister, Materials Science and Engineering, appendix B.1
(PMMA is given as 1.17 to 1.20). Bone cement with air or a contrast agent in it differs by some percent."""


@dataclass(frozen=True)
class ImplantData:
    """What an implant weighs.

    Parameters
    ----------
    volume_cm3 : float
        Volume of the mesh.
    mass_g : dict of str to float
        Mass if made solid of each of the `DENSITIES`.
    """

    volume_cm3: float
    mass_g: dict[str, float]


def implant_data(mesh: Mesh) -> ImplantData:
    """Volume and mass of a closed mesh in world mm."""
    volume = mesh.volume / 1000
    return ImplantData(volume, {material: volume * density for material, density in DENSITIES.items()})


def undercut(rim: Mesh, axis: NDArray[np.float64], *, tolerance: float = 5.0) -> float:
    """Share of the rim that holds the implant back when it is moved along an axis.

    Parameters
    ----------
    rim : Mesh
        Rim faces of a prosthesis: those that face bone.
    axis : ndarray, shape (3,)
        The way out, away from the brain; any length.
    tolerance : float
        Degrees by which a wall may lean over without being counted.

    Returns
    -------
    float
        Area of the rim faces that look along the axis, over the area of the rim; 0 to 1, and 0 for an empty rim.
        0 means that it can be put in from outside.
    """
    areas = rim.areas
    if not areas.sum():
        return 0.0
    lean = rim.normals @ _unit(axis)
    return float(areas[lean > np.sin(np.deg2rad(tolerance))].sum() / areas.sum())


def to_trim(patch: Volume, bone: Volume, axis: NDArray[np.float64], *, travel: float = 30.0) -> Volume:
    """The part of a patch that meets bone on its way out along an axis, and must be trimmed to let it in.

    Parameters
    ----------
    patch, bone : Volume
        Bool masks (P, R, C) on one grid.
    axis : ndarray, shape (3,)
        The way out, away from the brain; any length.
    travel : float
        mm that the patch is moved.

    Returns
    -------
    Volume
        Bool mask (P, R, C), part of the patch. Bone's own surface layer is not counted, so that a wall along the
        axis does not catch on its stairs: less than a voxel of undercut goes unseen.
    """
    _check_grid(patch, bone)
    stride = bone.spacing.min()
    step = np.linalg.inv(bone.affine[:3, :3]) @ _unit(axis) * stride
    box = _box_around(patch, np.ceil(np.abs(step) * travel / stride).astype(int) + 2)
    hard = ndimage.binary_erosion(bone.voxels[box])
    here = np.argwhere(patch.voxels[box])
    caught = np.zeros(len(here), bool)
    for n in range(1, int(travel / stride) + 1):
        index = np.rint(here + n * step).astype(int)
        known = ((index >= 0) & (index < hard.shape)).all(axis=1)
        caught[known] |= hard[tuple(index[known].T)]
    trimmed = np.zeros(patch.shape, bool)
    trimmed[box][tuple(here[caught].T)] = True
    return patch.with_voxels(trimmed)


def clearance(patch: Volume, bone: Volume, mm: float) -> Volume:
    """The patch without what lies nearer to bone than a gap.

    Parameters
    ----------
    patch, bone : Volume
        Bool masks (P, R, C) on one grid, with axes at right angles.
    mm : float
        Gap wanted between the faces of the voxels, > 0: 0.25 to 0.4 suits common printers.

    Returns
    -------
    Volume
        Bool mask (P, R, C). The gap is never smaller than `mm`; it comes in whole voxels, so thick slices lose a
        whole slice where bone lies above or below.

    Raises
    ------
    InputRefused
        If the grids differ (GridMismatch) or `mm` is not positive (BadClearance).
    """
    _check_grid(patch, bone)
    if not mm > 0:
        raise InputRefused("BadClearance", f"A clearance of {mm} mm was asked for; it must be above 0.")
    reach = np.ceil(mm / bone.spacing).astype(int)
    box = _box_around(patch, reach + 1)
    steps = np.stack(np.meshgrid(*[np.arange(-r, r + 1) for r in reach], indexing="ij"), axis=-1)
    gap = np.linalg.norm(np.maximum(np.abs(steps) - 1, 0) * bone.spacing, axis=-1)
    near = ndimage.binary_dilation(bone.voxels[box], structure=gap < mm - 1e-6)
    kept = np.zeros(patch.shape, bool)
    kept[box] = patch.voxels[box] & ~near
    return patch.with_voxels(kept)


def _box_around(mask: Volume, margin: NDArray[np.intp]) -> tuple[slice, ...]:
    """Index box of the mask, wider by a margin."""
    index = np.argwhere(mask.voxels)
    if not len(index):
        return (slice(0, 0),) * 3
    lo, hi = np.maximum(index.min(axis=0) - margin, 0), index.max(axis=0) + margin + 1
    return tuple(slice(int(a), int(b)) for a, b in zip(lo, hi, strict=True))


def _unit(axis: NDArray[np.float64]) -> NDArray[np.float64]:
    axis = np.asarray(axis, float)
    length = np.linalg.norm(axis)
    if axis.shape != (3,) or not np.isfinite(length) or length == 0:
        raise InputRefused("BadAxis", f"The axis has shape {axis.shape} and length {length}; give three numbers.")
    return axis / length


def _check_grid(a: Volume, b: Volume) -> None:
    if not same_grid(a, b):
        raise InputRefused("GridMismatch", f"Patch and bone stand on different grids, shapes {a.shape} and {b.shape}.")
