"""A real intact CT or bone mask -> the same with a hole in its vault, and the exact bone that was taken.

Frames: voxel index on the input's own grid, in any axis order; world mm, DICOM LPS, with z to the head's top.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from .case import Case
from .defect import Cutter, plan_cutters
from .head import lengths

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

HALO = 250.0
"""HU from which a voxel may hold bone; such voxels are emptied, and their neighbours are checked."""
_STEP = 0.5  # mm along rays
_BREAK = 12.0  # mm without bone that end the vault along a ray; a frontal sinus is narrower
_RAYS = 97  # rays across the cutter's map, in each direction


def cut_case(
    voxels: NDArray,
    affine: ArrayLike,
    defect: str,
    seed: int = 0,
    *,
    is_mask: bool,
    diameter: float | None = None,
    threshold: float = 400.0,
    soft_hu: float = 45.0,
    noise: float = 12.0,
) -> Case:
    """Virtual craniectomy: open the vault of an intact skull.

    Parameters
    ----------
    voxels : ndarray, shape (P, R, C)
        HU, or a mask (bone where not 0). Not modified.
    affine : array_like, shape (4, 4)
        Voxel index -> world mm (LPS).
    defect : str
        A key of `DEFECTS`.
    seed : int
        Chooses side, place, size and rim; the same seed gives the same case.
    is_mask : bool
        Whether `voxels` is a mask.
    diameter : float, optional
        Mean diameter in mm of every hole.
    threshold : float
        HU from which a voxel counts as bone in the truth.
    soft_hu, noise : float
        Mean and standard deviation in HU of the tissue that fills the hole of a CT.

    Returns
    -------
    Case
        `hu` is None for a mask.

    Raises
    ------
    ValueError
        If there is no skull to open, or the defect is unknown or does not fit.

    Notes
    -----
    The truth `implant` is what counted as bone before (HU >= `threshold`, or the mask) and has its voxel centre
    inside the cutter. In a CT every voxel inside the cutter that can hold bone (HU >= `HALO`, or next to such a
    voxel) becomes soft tissue, and at the cut it is blended over one voxel's width. Only the vault is cut: along each
    ray, from the first bone to the first break of 12 mm.
    """
    affine, rng = np.asarray(affine, float), np.random.default_rng(seed)
    solid = voxels != 0 if is_mask else voxels >= threshold
    vault = _find_vault(_main_parts(solid), affine)
    cutters = plan_cutters(defect, rng, vault.radius, diameter=diameter)
    parts = np.zeros(voxels.shape, np.float32)
    for cutter in cutters:
        vault.add_part(cutter, parts)
    implant = solid & (parts > 0.5)
    if not implant.any():
        raise ValueError(f"The defect {defect!r} meets no bone in this scan; try another defect or seed.")
    hu = None if is_mask else _fill(voxels, parts, soft_hu, noise, rng)
    parameters = {"diameter": diameter, "threshold": threshold, "soft_hu": soft_hu, "noise": noise}
    parameters["centre"] = vault.centre.tolist()
    return Case(hu, affine, solid & ~implant, implant, defect, seed, parameters)


@dataclass(frozen=True, eq=False)
class _Vault:
    """The skull, and a centre about 80 mm under its top (world mm) from which rays reach its vault."""

    bone: Mask
    affine: Array
    centre: Array

    def radius(self, direction: Array) -> float:
        """Distance in mm to the outer skull: the median over a small cone about the direction."""
        spread = np.array([[0, 0], [0.06, 0], [-0.06, 0], [0, 0.06], [0, -0.06]])
        rays = direction + spread @ _across(direction)
        outer = self.walls(rays / lengths(rays)[:, None])[1]
        if np.isnan(outer).all():
            raise ValueError("There is no bone where the defect is wanted; the skull may end there or be open already.")
        return float(np.nanmedian(outer))

    def walls(self, directions: Array) -> tuple[Array, Array]:
        """Radii (n,) in mm where rays (n, 3) enter and leave the vault; NaN where they meet none."""
        radii = np.arange(35.0, 150.0, _STEP)
        inverse = np.linalg.inv(self.affine[:3, :3])
        start = inverse @ (self.centre - self.affine[:3, 3])
        hit = np.empty((len(directions), radii.size), bool)
        for some in np.array_split(np.arange(len(directions)), 1 + len(directions) // 100):
            steps = directions[some] @ inverse.T
            hit[some] = self._bone_at(np.rint(start + radii[:, None] * steps[:, None]).astype(int))
        return _first_run(hit, radii)

    def add_part(self, cutter: Cutter, parts: NDArray[np.float32]) -> None:
        """Raise `parts` to each voxel's share of the cutter inside the vault."""
        index = self._near(cutter)
        p = index @ self.affine[:3, :3].T + self.affine[:3, 3] - self.centre
        inner, outer = self._walls_at(cutter, p)
        length = lengths(p)
        seen = (length >= inner - 1.0) & (length <= outer + 1.5)
        p, index, inner, outer = p[seen], index[seen], inner[seen], outer[seen]
        width = lengths(cutter.rim_normal(p) @ self.affine[:3, :3])
        part = np.clip(0.5 + cutter.distance(p, inner, outer) / width, 0, 1)
        at = tuple(index.T)
        parts[at] = np.maximum(parts[at], part)

    def _bone_at(self, index: NDArray[np.intp]) -> Mask:
        """Bone at voxel indices (..., 3); none outside the volume."""
        plane, row, col = (np.clip(index[..., i], 0, n - 1) for i, n in enumerate(self.bone.shape))
        inside = ((index >= 0) & (index < self.bone.shape)).all(-1)
        return self.bone[plane, row, col] & inside

    def _near(self, cutter: Cutter) -> NDArray[np.intp]:
        """Indices (n, 3) of the voxels in the cutter's cone, with a margin of a few mm, 30 to 150 mm away."""
        blocks = []
        rows, cols = np.arange(self.bone.shape[1])[:, None], np.arange(self.bone.shape[2])
        for plane in range(self.bone.shape[0]):
            start = self.affine[:3, :3] @ [plane, 0, 0] + self.affine[:3, 3] - self.centre
            xyz = [start[i] + self.affine[i, 1] * rows + self.affine[i, 2] * cols for i in range(3)]
            away = np.sqrt(xyz[0] ** 2 + xyz[1] ** 2 + xyz[2] ** 2)
            along = np.einsum("irc,i->rc", xyz, cutter.axes[2])
            found = np.argwhere((away > 30) & (away < 150) & (along > cutter.reach * away - 3))
            blocks.append(np.insert(found, 0, plane, axis=1))
        return np.concatenate(blocks)

    def _walls_at(self, cutter: Cutter, p: Array) -> tuple[Array, Array]:
        """Inner and outer radius along the rays to p (n, 3), read from a map over the cutter's cone."""
        local = p @ cutter.axes.T / lengths(p)[:, None]
        flat = local[:, :2] / np.sqrt((1 + local[:, 2:]) / 2)  # equal-area chart: its length is the chord
        half = float(np.abs(flat).max()) + 1e-6
        u, v = np.meshgrid(*[np.linspace(-half, half, _RAYS)] * 2, indexing="ij")
        chord = np.minimum(np.hypot(u, v), 1.99)
        scale = np.sqrt(1 - chord**2 / 4)
        rays = np.stack([u * scale, v * scale, 1 - chord**2 / 2], axis=-1).reshape(-1, 3)
        walls = self.walls(rays / lengths(rays)[:, None] @ cutter.axes)
        at = ((flat + half) / (2 * half) * (_RAYS - 1)).T
        inner, outer = (ndimage.map_coordinates(_smooth(w.reshape(u.shape)), at, order=1) for w in walls)
        return inner, outer


def _find_vault(bone: Mask, affine: Array) -> _Vault:
    """Find the middle of the vault's outline 20 to 60 mm under the vertex, and go 80 mm under it."""
    points = np.argwhere(bone)[::7] @ affine[:3, :3].T + affine[:3, 3]
    top = np.quantile(points[:, 2], 0.9995)
    band = points[(points[:, 2] < top - 20) & (points[:, 2] > top - 60), :2]
    if len(band) < 50:
        raise ValueError("No vault was found: there is less than 20 mm of skull below its top.")
    middle = (np.quantile(band, 0.01, axis=0) + np.quantile(band, 0.99, axis=0)) / 2
    return _Vault(bone, affine, np.r_[middle, top - 80.0])


def _main_parts(solid: Mask) -> Mask:
    """The large connected pieces: a sawn skull has two, a table or a head holder is smaller."""
    boxes = ndimage.find_objects(solid.view(np.uint8))
    if not boxes:
        raise ValueError("There is no bone in this scan.")
    box = boxes[0]
    labels, _ = ndimage.label(solid[box])
    sizes = np.bincount(labels[solid[box]])[1:]
    kept = np.zeros(solid.shape, bool)
    kept[box] = np.r_[False, sizes > 0.2 * sizes.max()][labels]
    return kept


def _across(direction: Array) -> Array:
    """Two unit vectors at right angles to a direction, as rows."""
    first = np.cross(np.eye(3)[int(np.argmin(np.abs(direction)))], direction)
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(direction, first)])


def _first_run(hit: Mask, radii: Array) -> tuple[Array, Array]:
    """First hit of each ray, and its last hit before a break."""
    gap = int(_BREAK / _STEP)
    inner = np.where(hit.any(1), radii[hit.argmax(1)], np.nan)
    closed = ndimage.binary_closing(np.pad(hit, ((0, 0), (gap, gap))), np.ones((1, gap)))[:, gap:-gap]
    after = ~closed & (np.cumsum(closed, axis=1) > 0)
    last = np.where(after.any(1), after.argmax(1), radii.size)
    outer = np.where(hit.any(1), radii[last - 1], np.nan)
    return inner, outer


def _smooth(wall: Array) -> Array:
    """A wall's map with its holes filled by the nearest ray and single stray rays removed."""
    missing = np.isnan(wall)
    if missing.all():
        return np.full(wall.shape, 75.0)
    nearest = ndimage.distance_transform_edt(missing, return_distances=False, return_indices=True)
    return ndimage.median_filter(wall[tuple(nearest)], 5)


def _fill(
    voxels: NDArray, parts: NDArray[np.float32], soft_hu: float, noise: float, rng: np.random.Generator
) -> NDArray[np.int16]:
    """HU with the cut bone replaced by soft tissue; voxels darker than that tissue stay as they are."""
    halo = ndimage.binary_dilation((voxels >= HALO) & (parts > 0), np.ones((3, 3, 3)))
    at = np.nonzero(halo & (parts > 0))
    before = voxels[at].astype(float)
    soft = np.minimum(before, soft_hu + noise * rng.standard_normal(before.size))
    hu = np.array(voxels, np.int16)
    hu[at] = np.rint(before + parts[at] * (soft - before))
    return hu
