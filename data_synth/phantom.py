"""Size, defect, seed -> a head CT in HU with a hole in its skull, and the exact missing bone.

Frames: voxel (plane, row, col), planes up, rows to the back, columns to the patient's left; world mm, DICOM LPS.
A voxel at a surface holds a blend of the tissues on both sides (partial volume), worked out from the signed distance
of its centre to the closed-form surface, over the width the voxel has along the surface's normal.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .case import Case
from .defect import Cutter, plan_cutters
from .head import HeadShape, head_shape, lengths

Array = NDArray[np.float64]

AIR, BRAIN, SOFT, CORTICAL, DIPLOE, METAL, PLATE = -1000.0, 35.0, 50.0, 1200.0, 650.0, 3071.0, 550.0
"""HU of the tissues."""
_TEXTURE = 90.0  # standard deviation of the diploe's HU: a few voxels fall below a bone threshold of 400
_NECK = (56.0, 66.0, 8.0)  # half axes across and along, and how far back it lies, in mm
_NECK_TOP = -15.0  # mm from the centre; the neck starts inside the head


@dataclass(frozen=True)
class Size:
    """Grid of a phantom.

    Parameters
    ----------
    shape : tuple of int
        Planes, rows, columns.
    spacing : tuple of float
        mm along (plane, row, col).
    thickness_scale : float
        Factor on the skull's thickness, so that a coarse grid still shows 3 to 4 voxels of bone.
    """

    shape: tuple[int, int, int]
    spacing: tuple[float, float, float]
    thickness_scale: float = 1.0


SIZES = {
    "tiny": Size((44, 128, 128), (3.0, 1.75, 1.75), 1.35),
    "class": Size((64, 256, 256), (2.5, 0.9, 0.9)),
    "full": Size((68, 512, 512), (2.5, 0.45, 0.45)),
}
"""Named grids; "full" has the size of the 2011 paper's scan."""


def phantom_case(
    size: str = "tiny",
    defect: str = "unilateral",
    seed: int = 0,
    *,
    diameter: float | None = None,
    noise: float = 12.0,
    couch: bool = False,
    metal: bool = False,
    tilt_deg: float = 0.0,
) -> Case:
    """A head CT with a named defect.

    Parameters
    ----------
    size : {"tiny", "class", "full"}
        Grid; see `SIZES`.
    defect : str
        A key of `DEFECTS`.
    seed : int
        The same seed gives the same bytes. Head and defect do not depend on the options below.
    diameter : float, optional
        Mean diameter of every hole in mm, instead of the seed's choice.
    noise : float
        Standard deviation of the scanner's noise in HU.
    couch : bool
        Whether a curved plate lies behind the head.
    metal : bool
        Whether a metal clip with streaks lies near the defect.
    tilt_deg : float
        Lean of the planes about the x axis (gantry tilt); the affine then has a shear.

    Returns
    -------
    Case
        CT, defective skull and missing bone on one grid, with the closed-form head.

    Raises
    ------
    ValueError
        If the size or the defect is unknown, or the diameter does not fit.
    """
    if size not in SIZES:
        raise ValueError(f"There is no size named {size!r}; choose one of {', '.join(SIZES)}.")
    grid, rng = SIZES[size], np.random.default_rng(seed)
    affine = leaning(_upright_affine(grid), tilt_deg)
    head = head_shape(rng, _head_centre(grid), thickness_scale=grid.thickness_scale)
    cutters = plan_cutters(defect, rng, lambda d: float(head.outer_radius(d)), diameter=diameter)
    head = replace(head, cutters=cutters)
    hu, bone, implant = scan(head, affine, grid.shape, seed=seed, noise=noise, couch=couch, metal=metal)
    parameters = {"size": size, "noise": noise, "couch": couch, "metal": metal, "tilt_deg": tilt_deg}
    return Case(hu, affine, bone, implant, defect, seed, parameters | {"diameter": diameter}, head)


def leaning(affine: ArrayLike, tilt_deg: float) -> Array:
    """The same grid with its planes turned by `tilt_deg` about x, each about its own first voxel.

    Parameters
    ----------
    affine : array_like, shape (4, 4)
        Voxel -> world mm.
    tilt_deg : float
        Positive raises the rows at the back.

    Returns
    -------
    ndarray, shape (4, 4)
        Voxel -> world mm.
    """
    affine, angle = np.array(affine, float), np.deg2rad(tilt_deg)
    c, s = np.cos(angle), np.sin(angle)
    affine[:3, 1:3] = np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ affine[:3, 1:3]
    return affine


def scan(
    head: HeadShape,
    affine: ArrayLike,
    shape: tuple[int, int, int],
    *,
    positions: ArrayLike | None = None,
    seed: int = 0,
    noise: float = 12.0,
    couch: bool = False,
    metal: bool = False,
) -> tuple[NDArray[np.int16], NDArray[np.bool_], NDArray[np.bool_]]:
    """Sample a head on a grid.

    Parameters
    ----------
    head : HeadShape
        With its cutters.
    affine : array_like, shape (4, 4)
        Voxel (plane, row, col) -> world mm; may be sheared.
    shape : tuple of int
        Planes, rows, columns.
    positions : array_like, shape (P,), optional
        mm of each plane from plane 0 along the affine's plane direction, for uneven spacing.
    seed, noise, couch, metal
        As in `phantom_case`.

    Returns
    -------
    hu : ndarray of int16, shape (P, R, C)
    bone, implant : ndarray of bool, shape (P, R, C)
        The skull that is left and the bone that is missing, by voxel centres.
    """
    affine, rng = np.asarray(affine, float), np.random.default_rng([seed, 1])
    index = np.arange(shape[0]) if positions is None else np.asarray(positions) / np.linalg.norm(affine[:3, 0])
    hu = np.empty(shape, np.int16)
    bone, implant = np.zeros(shape, bool), np.zeros(shape, bool)
    bounds, clip = _shell_bounds(head, affine), _clip_place(head) if metal else None
    for k, at in enumerate(index):
        values, whole, removed = _render_plane(head, _offsets(head, affine, at, shape[1:]), affine, bounds, rng)
        if couch:
            values = _add_couch(values, _offsets(head, affine, at, shape[1:]))
        if clip is not None:
            values = _add_metal(values, _offsets(head, affine, at, shape[1:]) - clip)
        values += noise * rng.standard_normal(shape[1:], dtype=np.float32)
        hu[k] = np.rint(np.clip(values, -1024, 3071))
        bone[k], implant[k] = whole & ~removed, whole & removed
    return hu, bone, implant


def _upright_affine(grid: Size) -> Array:
    """Planes up, rows back, columns left, with a plain but unsymmetric origin."""
    dz, dy, dx = grid.spacing
    affine = np.array([[0, 0, dx, -104.25], [0, dy, 0, -141.5], [dz, 0, 0, -862.75], [0, 0, 0, 1.0]])
    return affine


def _head_centre(grid: Size) -> Array:
    """Where the head lies: the vertex 9 mm under the top plane, a little aside of the middle, more space behind."""
    start, steps = _upright_affine(grid)[:3, 3], np.array(grid.spacing[::-1])
    extent = steps * (np.array(grid.shape[::-1]) - 1)
    return start + extent * [0.5, 0.5, 1.0] + [2.3, -6.1, -100.4]


def _offsets(head: HeadShape, affine: Array, plane: float, shape: tuple[int, ...]) -> Array:
    """Offsets (R, C, 3) of a plane's voxel centres from the head's centre, in mm."""
    rows, cols = np.arange(shape[0]), np.arange(shape[1])
    start = affine[:3, 3] + plane * affine[:3, 0] - head.centre
    components = [start[i] + affine[i, 1] * rows[:, None] + affine[i, 2] * cols for i in range(3)]
    return np.moveaxis(np.array(components), 0, -1)


def _shell_bounds(head: HeadShape, affine: Array) -> tuple[float, float]:
    """Norms between which all of the skull and the scalp lie, with a voxel to spare: elsewhere all is plain."""
    z, turn = np.linspace(-1, 1, 81)[:, None], np.linspace(0, 2 * np.pi, 120)
    flat = np.sqrt(1 - z**2)
    d = np.stack(np.broadcast_arrays(flat * np.cos(turn), flat * np.sin(turn), z), axis=-1)
    spare, norm = 1.0 + 0.5 * np.linalg.norm(affine[:3, :3], axis=0).max(), head.norm(d)
    low, high = (head.inner_radius(d) - spare) * norm, (head.skin_radius(d) + spare) * norm
    return float(low.min()), float(high.max())


def _render_plane(
    head: HeadShape, p: Array, affine: Array, bounds: tuple[float, float], rng: np.random.Generator
) -> tuple[NDArray[np.float32], NDArray[np.bool_], NDArray[np.bool_]]:
    """HU without scanner noise, complete skull and removed bone of one plane."""
    steps, norm = affine[:3, :3], head.norm(p)
    deep, high = bounds
    values = np.where(norm < deep, BRAIN, AIR + (SOFT - AIR) * _neck(p, steps)).astype(np.float32)
    shell = (norm >= deep) & (norm < high)
    whole, removed = np.zeros(norm.shape, bool), np.zeros(norm.shape, bool)
    if shell.any():
        values[shell], whole[shell], removed[shell] = _render_shell(head, p[shell], steps, values[shell], rng)
    return values, whole, removed


def _render_shell(
    head: HeadShape, p: Array, steps: Array, outside: NDArray[np.float32], rng: np.random.Generator
) -> tuple[Array, NDArray[np.bool_], NDArray[np.bool_]]:
    """The same for points (n, 3) at the skull and the scalp; `outside` is the HU beyond the scalp."""
    length = lengths(p)
    d = p / length[:, None]
    outer, thickness = head.outer_radius(d), head.bone_thickness(d)
    inner = outer - thickness
    slopes = head.gradients(p)
    in_skin, in_outer = (_part(r - length, slopes[0], steps) for r in (outer + head.scalp, outer))
    in_inner = _part(inner - length, slopes[1], steps)
    foramen = head.foramen_distance(p)
    kept = 1 - _ramp(foramen, steps[:, 1:])
    cut, removed = _cut_parts(head.cutters, p, inner, outer, steps)
    diploe = np.minimum(length - inner, outer - length) - 0.3 * thickness
    spongy = _part(diploe, slopes[0], steps)
    mineral = CORTICAL + spongy * (DIPLOE - CORTICAL + _TEXTURE * rng.standard_normal(length.size))
    soft = BRAIN * in_inner + SOFT * (1 - in_inner)
    bone = in_outer * (1 - in_inner) * kept * (1 - cut)
    values = outside + in_skin * (soft - outside) + bone * (mineral - soft)
    whole = (length < outer) & (length >= inner) & (foramen <= 0)
    return values, whole, removed


def _cut_parts(
    cutters: tuple[Cutter, ...], p: Array, inner: Array, outer: Array, steps: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """Part of each voxel, shape (n,), inside a cutter, and whether its centre is."""
    cut, removed = np.zeros(len(p)), np.zeros(len(p), bool)
    length = lengths(p)
    for cutter in cutters:
        near = np.flatnonzero(p @ cutter.axes[2] > cutter.reach * length - 6.0)
        distance = cutter.distance(p[near], inner[near], outer[near])
        cut[near] = np.maximum(cut[near], _part(distance, cutter.rim_normal(p[near]), steps))
        removed[near] |= distance > 0
    return cut, removed


def _part(distance: Array, slope: Array, steps: Array) -> Array:
    """Part of a voxel behind a surface: 0 to 1 as its centre crosses it.

    `distance` (n,) is a level function whose gradient has the length and direction of `slope` (n, 3). The ramp is as
    wide as the voxel looks along the normal: the root of the squared sum of its steps' shares.
    """
    size = lengths(slope)
    width = lengths(slope @ steps) / size
    return np.clip(0.5 + distance / (size * width), 0, 1)


def _ramp(distance: Array, steps: Array) -> Array:
    """The same for a signed distance whose normal lies about in the given steps' plane."""
    return np.clip(0.5 + distance / np.linalg.norm(steps, axis=0).mean(), 0, 1)


def _neck(p: Array, steps: Array) -> Array:
    """Part of each voxel inside the neck and face, a plain column of soft tissue."""
    if p[..., 2].min() > _NECK_TOP:
        return np.zeros(p.shape[:-1])
    across, along, back = _NECK
    distance = (1 - np.hypot(p[..., 0] / across, (p[..., 1] - back) / along)) * min(across, along)
    return np.where(p[..., 2] < _NECK_TOP, _ramp(distance, steps[:, 1:]), 0)


def _clip_place(head: HeadShape) -> Array:
    """Offset of the metal clip from the centre: inside the skull, behind the rim of the first defect."""
    cutter = head.cutters[0]
    d = cutter.axes[2] + 0.9 * cutter.half_angles[0] * cutter.axes[0]
    d /= np.linalg.norm(d)
    return d * (head.inner_radius(d) - 6.0)


def _add_metal(values: NDArray[np.float32], p: Array) -> NDArray[np.float32]:
    """A bright ball of 2.5 mm radius at p = 0, with bright and dark streaks in the planes that meet it."""
    streaks = np.zeros(values.shape)
    if np.abs(p[..., 2]).min() < 2.5:
        around, away = np.arctan2(p[..., 1], p[..., 0]), np.hypot(p[..., 0], p[..., 1])
        streaks = 350 * np.cos(9 * around + 0.7) * np.exp(-away / 30.0)
    ball = lengths(p) < 2.5
    return np.where(ball, METAL, values + streaks).astype(np.float32)


def _add_couch(values: NDArray[np.float32], p: Array) -> NDArray[np.float32]:
    """A curved plate, 2.5 mm thick, behind the head: an arc about a point 200 mm in front of the centre."""
    away = np.hypot(p[..., 0], p[..., 1] + 200.0)
    shell = (np.abs(away - 311.0) < 1.25) & (p[..., 1] > 0)
    return np.where(shell, np.maximum(values, PLATE), values).astype(np.float32)
