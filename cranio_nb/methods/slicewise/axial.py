"""One opening in the planes of the scan, as the paper: gap ends by skeleton and hull, each slice filled by itself.

Frame: slice (row, col) px.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ...curves import Points
from ...opening import Opening
from ...stages import feature_extraction, prosthesis_volume
from ...vault import slicing
from ...volume import Volume
from . import inflate
from .slices import Settings, SlicedDesign, SliceResult

_BESIDE = 2  # planes below and above the opening that are tried too
_NEAR = 3.0  # mm around the opening where a dent of a closed ring is part of it
_ISLAND = 4.0  # mm2: smaller pieces of a dent are dropped


def bridge(
    bone: Volume, opening: Opening, *, skip_px: float, reach_px: float, settings: Settings
) -> tuple[SlicedDesign, NDArray[np.bool_]]:
    """Slices and patch of one opening along the planes of the scan.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    opening : Opening
    skip_px, reach_px : float
        As for `feature_extraction.find_gap_ends`.
    settings : Settings
        In px.

    Returns
    -------
    made : SlicedDesign
    voxels : ndarray of bool, shape (P, R, C)
    """
    # an opening's sheet is coarse: its rim may lie a plane or two beyond it
    first, end = opening.planes
    planes = range(max(first - _BESIDE, 0), min(end + _BESIDE, bone.shape[0]))
    at = slice(planes.start, planes.stop)
    # stages 2 and 3 of the paper for every plane: gap ends, then both balloons of each gap
    ends = by_skeleton(bone.voxels[at], opening.sheet.voxels[at], skip_px=skip_px, reach_px=reach_px)
    balloons = inflate.inflate(ends, bone.to_voxel(opening.head_centre)[1:], settings)
    results = inflate.carry(within_image(balloons, (bone.shape[1], bone.shape[2])))
    # stage 4: what lies between the curves and off the bone
    px = float(bone.spacing[1:].mean())
    voxels = np.zeros(bone.shape, bool)
    voxels[at] = _filled(results, bone.voxels[at], opening.sheet.voxels[at], px)
    return SlicedDesign(opening, slicing.axial_frames(bone, planes), px, results), voxels


def by_skeleton(
    bone: NDArray[np.bool_], opening: NDArray[np.bool_], *, skip_px: float, reach_px: float
) -> list[SliceResult]:
    """Gap ends of every slice by skeleton and hull.

    Parameters
    ----------
    bone, opening : ndarray of bool, shape (P, R, C)
        Slices of the skull, and where the opening crosses them.
    skip_px, reach_px : float
        As for `feature_extraction.find_gap_ends`.

    Returns
    -------
    list of SliceResult
        One for each slice.
    """
    results = []
    for plane in range(len(bone)):
        try:
            # a ring without a gap is a partial loss: its dent is filled up to the hull (Fig. 6)
            features = feature_extraction.extract_features(bone[plane])
            if features.closed:
                results.append(SliceResult(plane, "hull", "closed ring"))
                continue
            # else a balloon is to bridge from end to end; what cannot be fitted leaves its slice to the neighbours
            ends = feature_extraction.find_gap_ends(features, opening[plane], skip_px=skip_px, reach_px=reach_px)
            results.append(SliceResult(plane, "balloon", ends=ends))
        except feature_extraction.SliceProblem as problem:
            results.append(SliceResult(plane, "skipped", problem.message))
    return results


def within_image(slices: Sequence[SliceResult], shape: tuple[int, int]) -> list[SliceResult]:
    """Take back balloons that ran out of the image: they bridge nothing.

    It happens where an end's tangent stands upright on the chord: the start curve, eq. (3), has the slope tan(theta).

    Parameters
    ----------
    slices : sequence of SliceResult
    shape : tuple of int
        Rows and columns of a slice.

    Returns
    -------
    list of SliceResult
        Those slices with the status "skipped".
    """
    reason = "its balloon ran out of the image"
    return [SliceResult(s.plane, "skipped", reason) if _leaves(s.curves, shape) else s for s in slices]


def _leaves(curves: Points, shape: tuple[int, int]) -> bool:
    """Whether curves go beyond the pixels of a slice."""
    return bool(((curves < -0.5) | (curves > np.array(shape) - 0.5)).any())


def _filled(
    results: tuple[SliceResult, ...], bone: NDArray[np.bool_], opening: NDArray[np.bool_], px: float
) -> NDArray[np.bool_]:
    """Every slice filled between its curves, or up to its hull, shape (P, R, C)."""
    voxels = np.zeros(bone.shape, bool)
    # a hull spans every dent of the skull: only dents by the opening are wanted
    near = ndimage.binary_dilation(opening.any(axis=0), iterations=int(np.ceil(_NEAR / px)))
    for s in results:
        if s.status == "hull":
            voxels[s.plane] = prosthesis_volume.fill_partial_loss(
                bone[s.plane], min_area_px=_ISLAND / px**2, region=near
            )
        elif s.curves.size:
            voxels[s.plane] = prosthesis_volume.fill_gap(s.curves[0], s.curves[1], bone[s.plane])
    return voxels
