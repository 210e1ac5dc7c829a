"""Stage 4, fill: the two curves across the gap of a slice come in -> the pixels of the patch go out.

Frame: slice (row, col) px.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage.draw import polygon
from skimage.morphology import convex_hull_image

from ..curves import Points
from ..volume import Volume

_EIGHT = np.ones((3, 3), bool)


def between(outer: Points, inner: Points, shape: tuple[int, int]) -> NDArray[np.bool_]:
    """Pixels between the outer and the inner curve.

    Parameters
    ----------
    outer, inner : ndarray, shape (n, 2)
        Curves that run across the gap in the same sense, slice (row, col).
    shape : tuple of int
        Rows and columns of the slice.

    Returns
    -------
    ndarray of bool, shape `shape`
    """
    outline = np.concatenate([outer, inner[::-1]])
    region = np.zeros(shape, bool)
    region[polygon(outline[:, 0], outline[:, 1], shape)] = True
    return region


def patch(outer: Points, inner: Points, bone: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The patch of a slice: between the curves, off the bone, and reaching from one curve to the other (Fig. 5b).

    Parameters
    ----------
    outer, inner : ndarray, shape (n, 2)
        Curves across the gap, slice (row, col).
    bone : ndarray of bool, shape (R, C)
    """
    region = between(outer, inner, (bone.shape[0], bone.shape[1])) & ~bone
    region = ndimage.binary_opening(region)  # slivers where a curve grazes the bone's surface
    labels, n_parts = ndimage.label(region, _EIGHT)
    if n_parts <= 1:
        return region
    keep = np.intersect1d(_labels_on(outer, labels), _labels_on(inner, labels))
    return np.isin(labels, keep[keep > 0])


def partial_loss(bone: NDArray[np.bool_], *, min_area: float, region: NDArray[np.bool_] | None = None) -> NDArray:
    """The patch of a closed ring with a dent: convex hull minus bone, without islands and the cavity (Fig. 6).

    Parameters
    ----------
    bone : ndarray of bool, shape (R, C)
        A closed ring.
    min_area : float
        Islands of fewer pixels are dropped.
    region : ndarray of bool, shape (R, C), optional
        Where the opening is; other dents of the skull are natural and stay.
    """
    missing = convex_hull_image(bone) & ~bone
    labels, n_parts = ndimage.label(missing, _EIGHT)
    sizes = np.bincount(labels.ravel(), minlength=n_parts + 1)
    sizes[0] = 0
    keep = sizes >= min_area
    keep[np.argmax(sizes)] = False
    if region is not None:
        keep &= np.bincount(labels[region], minlength=n_parts + 1) > 0
    return keep[labels]


def _labels_on(curve: Points, labels: NDArray) -> NDArray:
    """Labels met within a pixel of a curve."""
    dense = np.concatenate([curve, (curve[1:] + curve[:-1]) / 2])
    near = np.rint(dense[:, None] + np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])).astype(int).reshape(-1, 2)
    near = near[((near >= 0) & (near < labels.shape)).all(axis=1)]
    return np.unique(labels[tuple(near.T)])


def main_piece(patch: NDArray[np.bool_], opening: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The piece of a patch that fills most of the opening.

    Parameters
    ----------
    patch, opening : ndarray of bool, shape (P, R, C)
        The opening is the opening's coarse sheet.
    """
    box = tuple(_span(np.asarray(patch.any(axis=others))) for others in ((1, 2), (0, 2), (0, 1)))
    labels, n_parts = ndimage.label(patch[box])
    if n_parts <= 1:
        return patch
    votes = np.bincount(labels[opening[box]], minlength=n_parts + 1)
    votes[0] = 0
    best = int(np.argmax(votes)) if votes.any() else int(np.bincount(labels.ravel())[1:].argmax()) + 1
    out = np.zeros(patch.shape, bool)
    out[box] = labels == best
    return out


def _span(hit: NDArray[np.bool_]) -> slice:
    """From the first to the last hit."""
    at = np.flatnonzero(hit)
    return slice(int(at[0]), int(at[-1]) + 1) if len(at) else slice(0, 0)


def solid_piece(patch: NDArray[np.bool_], opening: Volume, bone: Volume, *, thinnest: float = 1.0) -> NDArray[np.bool_]:
    """The piece of a patch that fills most of the opening, without slivers and enclosed pores.

    Parameters
    ----------
    patch : ndarray of bool, shape (P, R, C)
    opening : Volume
        The opening's coarse sheet.
    bone : Volume
        Bool mask on the same grid.
    thinnest : float
        mm: what is thinner is a film or a sliver.

    Returns
    -------
    ndarray of bool, shape (P, R, C)
        Nothing, where no piece reaches the opening.
    """
    solid = np.zeros_like(patch)
    for box in ndimage.find_objects(patch.view(np.uint8)):
        cube = np.ones(np.maximum(np.round(thinnest / bone.spacing), 1).astype(int), bool)
        wide = ndimage.binary_opening(patch[box], cube)
        if (wide & opening.voxels[box]).any():
            solid[box] = ndimage.binary_fill_holes(main_piece(wide, opening.voxels[box])) & ~bone.voxels[box]
    return solid
