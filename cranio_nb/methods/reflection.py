"""The classical reference: the skull's other side, mirrored into the hole.

Bone mask in, pieces out. The 2011 paper (doi 10.5220/0003356601370142) measures its prostheses against a
reflection: the skull is mirrored at its symmetry plane, bone is taken off, the piece in the hole is kept.

Idea. `find_symmetry_plane` gives the plane x -> x - 2 (n (x - p)) n. The mirrored skull is the same voxels under
another affine, so nothing is resampled: both skulls are measured along the same rays from inside the head, between
voxels, about the opening, and the prosthesis lies between the mirrored radii, in the hole, off the bone. Where the
mirror image has no bone either, because the defect crosses the plane or has a partner, there is nothing to copy.

Faithful: mirror, subtract, keep the piece in the hole. Ours: the plane is found and not clicked, the surface is smooth
between voxels, the edge ends with the bone's own surface, the part that cannot be copied is refused or left out. Also
ours is `fit_rim`, which the preset "paper" turns off: no head is symmetric, so the mirrored radii m leave a step at the
rim. The difference d = r - m to the bone's own radii r is known around the hole; with

    sum over known rays (g - d)^2 + s^4 sum (laplacian g)^2 + s^4 / l^2 sum |grad g|^2 -> min

(s = 2 mm or two voxels, l = 10 mm) it is continued across the hole like a plate under tension: with its slope at
first, which the tension takes away further in than l, where the rim knows nothing any more; and m + g meets the rim.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, sparse
from scipy.sparse.linalg import splu

from ..errors import InputRefused
from ..geometry import voxel_pieces
from ..opening import Opening
from ..options import Option
from ..vault import radius_measurement, radius_voxels, symmetry
from ..vault.ray_grid import RadiusMap, filled_from_nearest
from ..vault.symmetry import SymmetryPlane
from ..volume import Volume
from .piece import Piece

_TOLERATED = 0.03  # part of a hole without a mirror image that is filled from beside it
_TIP = 2.0  # mm: narrower ends of a possible part are left out
_RING = 15.0  # mm of bone around the hole that the mirror image is fitted to
_COARSE = 2.0  # mm between the points the difference is solved at: it is smooth
_SMOOTH = 2.0  # mm, or two voxels: shorter waves of the difference are noise
_TENSION = 10.0  # mm over which the slope of the difference at the rim goes on into the hole
_OUTLIER = 1.0  # mm: a difference larger than its surroundings by this counts half


@dataclass(frozen=True, eq=False)
class MirroredDesign:
    """What the method did for one opening; for pictures and lessons.

    Parameters
    ----------
    opening : Opening
    plane : SymmetryPlane
    radius_map, mirrored : RadiusMap
        The skull and its mirror image along the same rays; `mirrored.hole` is where the image lacks bone.
    outer, inner : ndarray, shape (M, M)
        Radii of the prosthesis in mm; nan where it has none.
    """

    opening: Opening
    plane: SymmetryPlane
    radius_map: RadiusMap
    mirrored: RadiusMap
    outer: NDArray[np.float64]
    inner: NDArray[np.float64]

    @property
    def lost(self) -> float:
        """Part of the hole that has no mirror image, 0 to 1.

        Returns
        -------
        float
        """
        return float((self.radius_map.hole & self.mirrored.hole).sum() / self.radius_map.hole.sum())


PRESETS = {"paper": {"fit_rim": False}}
"""The paper mirrors and does not bend."""


def pieces(
    bone: Volume,
    openings: Sequence[Opening],
    *,
    partial: Annotated[bool, Option("Leave open what the other side lacks too, instead of refusing.")] = False,
    fit_rim: Annotated[bool, Option("Bend the mirrored surfaces to meet the bone around the hole.")] = True,
) -> Iterator[Piece]:
    """Close each opening by mirroring the other side of the skull.

    Parameters
    ----------
    bone, openings
        As for `methods.design.design`.
    partial : bool
        Where the other side lacks bone too, leave that part (or that whole opening) open instead of refusing.
    fit_rim : bool
        Bend the mirrored surfaces smoothly to meet the bone around the hole, nowhere thinner than sound bone near it.

    Yields
    ------
    Piece
        The record's `symmetry` describes the plane, its `openings` what part of the hole has no mirror image.
        `working` holds a `MirroredDesign`.

    Raises
    ------
    InputRefused
        ``MirrorMissing`` where the mirrored side is missing too; ``NoSymmetry`` when no plane is found.
    """
    # one plane for the whole skull, then each opening mirrored across it
    plane = symmetry.find_symmetry_plane(bone, openings[0].head_centre, openings[0].head_axes)
    made = [_mirrored(bone, opening, plane, fit_rim) for opening in openings]
    if not partial:
        _check_whole(made)
    # with `partial` an opening may stay open, but not all of them
    solids = [_solid(part, bone) for part in made]
    if not any(voxels.any() for voxels in solids):
        raise _missing(made, "no part of it can be copied", "Use a method that needs no symmetry.")
    for part, voxels in zip(made, solids, strict=True):
        record = {"symmetry": plane.record(), "openings": [{"without_mirror_image": part.lost}]}
        yield Piece(voxels, (part,), record)


def _solid(part: MirroredDesign, bone: Volume) -> NDArray[np.bool_]:
    """The voxels between the mirrored radii; none where nothing can be copied."""
    if not np.isfinite(part.outer).any():
        return np.zeros(bone.shape, bool)
    between = radius_voxels.voxels_between(part.radius_map, bone, outer=part.outer, inner=part.inner)
    return voxel_pieces.keep_solid_piece(between, part.opening.sheet, bone)


def _check_whole(made: list[MirroredDesign]) -> None:
    """Refuse openings that have too little to copy from."""
    short = [part for part in made if part.lost > _TOLERATED]
    if short:
        remedy = "Ask for the possible part (partial), or use a method that needs no symmetry."
        raise _missing(short, "it crosses the symmetry plane or has a partner there", remedy)


def _missing(made: list[MirroredDesign], why: str, remedy: str) -> InputRefused:
    """The refusal of openings whose mirrored side is missing too."""
    parts = ", ".join(f"{100 * part.lost:.0f} %" for part in made)
    return InputRefused(
        "MirrorMissing",
        f"The mirrored side of the hole lacks bone too ({parts} of it; at most {100 * _TOLERATED:.0f} % is wanted):"
        f" {why}.",
        remedy,
    )


def _mirrored(bone: Volume, opening: Opening, plane: SymmetryPlane, fit_rim: bool) -> MirroredDesign:
    """Radii of the mirror image across one hole, nan where it has none to give."""
    # the mirrored skull on the same rays; where it lacks bone its nearest radius stands in
    radius_map = radius_measurement.measure_around(bone, opening)
    image = radius_measurement.measure_along(radius_map, plane.mirrored(bone))
    known = np.isfinite(image.outer) & ~image.hole
    outer, inner = (filled_from_nearest(np.where(known, r, np.nan)) for r in (image.outer, image.inner))
    if fit_rim:
        # d = r - m is known on the bone: continued across the hole, it makes m meet the rim
        finest = max(_SMOOTH, 2 * float(bone.spacing.max()))
        outer = outer + _difference(radius_map, np.where(known, radius_map.outer - outer, np.nan), finest)
        inner = inner + _difference(radius_map, np.where(known, radius_map.inner - inner, np.nan), finest)
        outer, inner = radius_voxels.thickened(radius_map, outer=outer, inner=inner)
    made = MirroredDesign(opening, plane, radius_map, image, outer, inner)
    # what has no mirror image stays open; narrow tips that this leaves would break off
    keep = radius_map.hole
    if made.lost > _TOLERATED:
        keep = ndimage.binary_opening(keep & ~image.hole, iterations=max(1, round(_TIP / radius_map.step_mm)))
    return replace(made, outer=np.where(keep, outer, np.nan), inner=np.where(keep, inner, np.nan))


def _difference(radius_map: RadiusMap, difference: NDArray[np.float64], smooth: float) -> NDArray[np.float64]:
    """What the mirror image lacks to the bone around the hole, continued smoothly across it, shape (M, M), mm.

    Waves shorter than `smooth` mm are taken for noise.
    """
    # d is smooth: a grid of some mm resolves it, and keeps the system small
    every = max(1, round(_COARSE / radius_map.step_mm))
    step = every * radius_map.step_mm
    away = ndimage.distance_transform_edt(~radius_map.hole)[::every, ::every] * radius_map.step_mm
    area = away <= _RING
    target = difference[::every, ::every]
    known = area & (away > 0) & np.isfinite(target)
    # energy = smooth^4 (L^2 + L / tension^2) per cell: a plate under tension (see the module's text)
    bend = _laplacian(area)
    energy = (smooth / step) ** 4 * (bend @ bend + (step / _TENSION) ** 2 * bend)
    # Cauchy's weights drop places where the mirror image meets a ridge or a sinus
    data, weight = np.where(known, target, 0.0)[area], known[area].astype(float)
    for _ in range(5):
        solved = splu((energy + sparse.diags_array(weight)).tocsc()).solve(weight * data)
        weight = known[area] / (1 + ((data - solved) / _OUTLIER) ** 2)
    # back to all rays, linear between the nodes
    coarse = np.full(area.shape, np.nan)
    coarse[area] = solved
    v, u = np.indices(difference.shape) / every
    return ndimage.map_coordinates(filled_from_nearest(coarse), [v, u], order=1, mode="nearest")


def _laplacian(area: NDArray[np.bool_]) -> sparse.csr_array:
    """Graph Laplacian of the points of a grid that lie in an area, each joined to its four neighbours there."""
    # neighbours along rows and along columns, both in the area
    index = np.cumsum(area).reshape(area.shape) - 1
    pairs = [
        np.stack([index[a][area[a] & area[b]], index[b][area[a] & area[b]]])
        for a, b in ((np.s_[1:], np.s_[:-1]), (np.s_[:, 1:], np.s_[:, :-1]))
    ]
    # degree minus adjacency
    i, j = np.concatenate(pairs, axis=1)
    n = int(area.sum())
    links = sparse.csr_array((np.ones(len(i)), (i, j)), shape=(n, n))
    links = links + links.T
    return (sparse.diags_array(links.sum(axis=1)) - links).tocsr()
