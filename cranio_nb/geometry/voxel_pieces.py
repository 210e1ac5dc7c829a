"""Connected pieces of voxels: the one of a patch that fills an opening, and those that reach the edge of a slice."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..volume import Volume

SAME_SLICE: NDArray[np.bool_] = np.pad(ndimage.generate_binary_structure(2, 1)[None], ((1, 1), (0, 0), (0, 0)))
"""For `scipy.ndimage.label`: neighbours share an edge within their slice."""


def keep_main_piece(patch: NDArray[np.bool_], opening: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Keep the piece of a patch that fills most of the opening.

    Parameters
    ----------
    patch : ndarray of bool, shape (P, R, C)
        Pieces are connected by faces.
    opening : ndarray of bool, shape (P, R, C)
        The opening's coarse sheet, on the same grid.

    Returns
    -------
    ndarray of bool, shape (P, R, C)
        One piece; the largest, where none lies in the opening; nothing, where the patch is empty.

    Examples
    --------
    >>> patch = np.array([[[1, 1, 1, 0, 1, 1]]], bool)
    >>> opening = np.array([[[0, 0, 0, 0, 1, 1]]], bool)
    >>> keep_main_piece(patch, opening).astype(int)
    array([[[0, 0, 0, 0, 1, 1]]])
    """
    # work in the patch's bounding box: patches are small in their grids
    box = tuple(_span(np.asarray(patch.any(axis=others))) for others in ((1, 2), (0, 2), (0, 1)))
    labels, n_parts = ndimage.label(patch[box])
    if n_parts <= 1:
        return patch

    # the piece with most voxels in the opening, else the largest
    votes = np.bincount(labels[opening[box]], minlength=n_parts + 1)
    votes[0] = 0
    best = int(np.argmax(votes)) if votes.any() else int(np.bincount(labels.ravel())[1:].argmax()) + 1
    out = np.zeros(patch.shape, bool)
    out[box] = labels == best
    return out


def keep_solid_piece(
    patch: NDArray[np.bool_], opening: Volume, bone: Volume, *, min_thickness_mm: float = 1.0
) -> NDArray[np.bool_]:
    """Keep the piece of a patch that fills most of the opening, without slivers and enclosed pores.

    Parameters
    ----------
    patch : ndarray of bool, shape (P, R, C)
    opening : Volume
        The opening's coarse sheet, on the patch's grid.
    bone : Volume
        Bool mask on the same grid.
    min_thickness_mm : float
        What is thinner is a film or a sliver, and goes.

    Returns
    -------
    ndarray of bool, shape (P, R, C)
        Free of bone; nothing, where no piece reaches the opening.

    Examples
    --------
    A cube with a pore in its middle, and a film beside it that is half a millimetre thick:

    >>> patch, opening = np.zeros((2, 20, 20, 20), bool)
    >>> patch[2:12, 2:12, 2:12] = True
    >>> patch[7, 7, 7] = False
    >>> patch[12, 2:12, 2:18] = True
    >>> opening[6:9, 6:9, 6:9] = True
    >>> grid = np.diag([0.5, 0.5, 0.5, 1])
    >>> bone = Volume(np.zeros_like(patch), grid)
    >>> kept = keep_solid_piece(patch, Volume(opening, grid), bone)
    >>> bool(kept[7, 7, 7]), bool(kept[12, 7, 17])
    (True, False)
    """
    solid = np.zeros_like(patch)
    for box in ndimage.find_objects(patch.view(np.uint8)):
        # an opening by a cube removes what the cube does not fit into
        cube = np.ones(np.maximum(np.round(min_thickness_mm / bone.spacing), 1).astype(int), bool)
        wide = ndimage.binary_opening(patch[box], cube)
        if (wide & opening.voxels[box]).any():
            piece = keep_main_piece(wide, opening.voxels[box])
            solid[box] = ndimage.binary_fill_holes(piece) & ~bone.voxels[box]
    return solid


def _span(hit: NDArray[np.bool_]) -> slice:
    """From the first to the last hit."""
    at = np.flatnonzero(hit)
    return slice(int(at[0]), int(at[-1]) + 1) if len(at) else slice(0, 0)


def edge_labels(labels: NDArray[np.integer]) -> NDArray[np.integer]:
    """Labels of what reaches the edge of its slice, and so lies outside: no holes.

    Parameters
    ----------
    labels : ndarray of int, shape (P, R, C)
        As of `scipy.ndimage.label`.

    Returns
    -------
    ndarray of int, shape (n,)
        In order, each once.

    Examples
    --------
    >>> edge_labels(np.array([[[1, 0, 0], [0, 2, 3], [0, 0, 0]]]))
    array([0, 1, 3])
    """
    edges = (labels[:, 0], labels[:, -1], labels[:, :, 0], labels[:, :, -1])
    return np.unique(np.concatenate([edge.ravel() for edge in edges]))
