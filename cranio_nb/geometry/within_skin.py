"""A thresholded CT -> what of it lies within the skin of the head: couch, holders, frames and tubes are left out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..volume import Volume
from .voxel_pieces import SAME_SLICE, edge_labels
from .voxel_runs import find_pieces

AIR_HU = -300.0
"""HU below which a voxel holds mostly air."""
_COARSE_MM = 3.0  # between the voxels among which the skin is sought
_AIR_GAP_MM = 6.0  # width of the gaps through which the air around the head is followed; sinuses open through less
_WEDGE_MM = 24.0  # as far it is followed on through narrower gaps
_SHELL_MM = 12.0  # below the surface it is followed without end: between the head and a shell, far from every sinus
_BAR_MM = 24.0  # width of the bars and plates that are taken off the head; the head itself is wider everywhere
_TUBE_MM = 60.0  # what air goes round in a slice and is wider than this is a head
_MARGIN_MM = 3.0  # beyond the skin, which the coarse voxels miss by as much
_LEAST_SOFT = 0.5  # of what lies within the skin; a dry skull is full of air
_LEAST_BONE = 0.2  # of all bone that lies within the skin, else what was found is not a head


def within_skin(mask: NDArray[np.bool_], ct: Volume) -> NDArray[np.bool_]:
    """Take off the head what stands in the air around it: couch, head holder, frames, also where they touch it.

    Parameters
    ----------
    mask : ndarray of bool, shape (P, R, C)
        Thresholded CT.
    ct : Volume
        HU: shows where skin ends and air begins.

    Returns
    -------
    ndarray of bool, shape (P, R, C)
        `mask` within the skin; all of it where no head in its skin is seen (a dry skull).

    Notes
    -----
    Around the head is the air that is met from the edges of the slices through gaps of some width. What remains is
    opened (an erosion, then a dilation) by a box wider than bars and plates and narrower than any part of the head.
    Of a body that stands mostly outside what is left, nothing is kept: a shell may lie on the skin over a long way.

    Examples
    --------
    A head of 80 mm, and a plate of 3 mm on which it lies:

    >>> hu = np.full((40, 60, 60), -1000)
    >>> hu[:, 20:40, 20:40], hu[:, 22:38, 22:38], hu[:, 40] = 40, 900, 900
    >>> kept = within_skin(hu >= 400, Volume(hu, np.diag([4.0, 4, 4, 1])))
    >>> bool(kept[:, 22:38, 22:38].all()), int(kept[:, 42:].sum())
    (True, 0)
    """
    every = np.maximum(1, _COARSE_MM // ct.spacing).astype(int)
    coarse = tuple(slice(None, None, n) for n in every)
    air, bone = ct.voxels[coarse] < AIR_HU, mask[coarse]
    head = _inside_air(air, ct.spacing * every)
    if not head.any() or air[head].mean() > 1 - _LEAST_SOFT or not (bone & ~head).any():
        return mask
    if np.count_nonzero(bone & head) < _LEAST_BONE * np.count_nonzero(bone):
        return mask
    for axis, (n, length) in enumerate(zip(every, mask.shape, strict=True)):
        head = head.repeat(n, axis).take(range(length), axis)
    return _drop_bodies_outside(mask, head)


def _inside_air(air: NDArray[np.bool_], spacing: NDArray[np.float64]) -> NDArray[np.bool_]:
    """What the air around the head encloses, without bars and plates narrower than `_BAR_MM`."""
    labels, _ = ndimage.label(~_dilate(~air, _AIR_GAP_MM, spacing))
    around = np.isin(labels, np.setdiff1d(edge_labels(labels), 0))
    around = _dilate(around, _AIR_GAP_MM, spacing) & air | _air_in_tubes(air, spacing)
    # on behind a shell, and into the wedge between the head and what it touches, not up to the sinuses
    behind = ndimage.binary_propagation(around, mask=air & _dilate(around, 2 * _SHELL_MM, spacing))
    body = ~ndimage.binary_dilation(behind, iterations=int(_WEDGE_MM / spacing.min()), mask=air)
    return _dilate(_dilate(_erode(body, _BAR_MM, spacing), _BAR_MM, spacing) & body, 2 * _MARGIN_MM, spacing)


def _air_in_tubes(air: NDArray[np.bool_], spacing: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Air of a slice that goes round a head without reaching the edge of the image: the head lies in a tube."""
    labels, _ = ndimage.label(air, SAME_SLICE)
    rings, at_edge = np.zeros_like(air), set(edge_labels(labels))
    for label, box in enumerate(ndimage.find_objects(labels), 1):
        wide = all((side.stop - side.start) * step >= _TUBE_MM for side, step in zip(box[1:], spacing[1:], strict=True))
        if wide and label not in at_edge:
            ring = labels[box][0] == label
            enclosed = ndimage.binary_fill_holes(ring) & ~ring
            if enclosed.sum() * np.prod(spacing[1:]) >= _TUBE_MM**2:
                rings[box][0] |= ring
    return rings


def _drop_bodies_outside(mask: NDArray[np.bool_], head: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """`mask` within the head, without the bodies of which more stands outside: of a shell that touches skin nothing."""
    bodies = find_pieces(mask)
    inside = mask & head
    every = bodies.places(np.ones(bodies.n_pieces, bool))
    body = np.repeat(bodies.piece, bodies.length)
    n_inside = np.bincount(body[head.ravel()[every]], minlength=bodies.n_pieces)
    device = 2 * n_inside < bodies.sizes
    inside.ravel()[bodies.places(device)] = False
    return inside


def _erode(mask: NDArray[np.bool_], width_mm: float, spacing: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Erosion by a box. The first and last slice go on beyond the image, for the scan ends within the body."""
    mode = ["nearest", "constant", "constant"]
    return ndimage.minimum_filter(mask.view(np.uint8), _box(width_mm, spacing), mode=mode).view(bool)


def _dilate(mask: NDArray[np.bool_], width_mm: float, spacing: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Dilation by the same box."""
    return ndimage.maximum_filter(mask.view(np.uint8), _box(width_mm, spacing), mode="nearest").view(bool)


def _box(width_mm: float, spacing: NDArray[np.float64]) -> list[int]:
    """Voxels along each axis of a box with a voxel in its middle."""
    return [2 * int(width_mm / 2 / step_mm) + 1 for step_mm in spacing]
