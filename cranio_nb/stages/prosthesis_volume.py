"""Stage 4, prosthesis volume: the two curves across the gap of a slice come in -> the pixels of the patch go out.

Frame: slice (row, col) px. Source: VISAPP 2011, section 2, Figs. 5 and 6. Slice upon slice the patches make the
prosthesis volume.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from skimage.draw import polygon
from skimage.morphology import convex_hull_image

from ..curves import Points

_EIGHT = np.ones((3, 3), bool)  # pixels that share a corner are neighbours
_CROSS = np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])  # a pixel and the four beside it


def pixels_between(outer: Points, inner: Points, shape: tuple[int, int]) -> NDArray[np.bool_]:
    """Pixels between the outer and the inner curve.

    Parameters
    ----------
    outer, inner : ndarray, shape (n, 2)
        Curves that run across the gap in the same sense, slice (row, col) px.
    shape : tuple of int
        Rows and columns of the slice.

    Returns
    -------
    ndarray of bool, shape `shape`
        True for pixels whose centre lies in the polygon along the outer curve and back along the inner one.

    Examples
    --------
    Between two lines of 10 px, 4 px apart, lie 4 x 10 pixels:

    >>> outer, inner = np.array([[1.5, 0.5], [1.5, 10.5]]), np.array([[5.5, 0.5], [5.5, 10.5]])
    >>> int(pixels_between(outer, inner, (8, 12)).sum())
    40
    """
    # one polygon, out along the outer curve and back along the inner one
    outline = np.concatenate([outer, inner[::-1]])
    region = np.zeros(shape, bool)
    region[polygon(outline[:, 0], outline[:, 1], shape)] = True
    return region


def fill_gap(outer: Points, inner: Points, bone: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Fill the gap of a slice: the pixels between the curves that are not bone.

    Only pieces that reach from one curve to the other are kept, and slivers where a curve grazes the bone's surface
    are not.

    Parameters
    ----------
    outer, inner : ndarray, shape (n, 2)
        Curves across the gap in the same sense, slice (row, col) px.
    bone : ndarray of bool, shape (R, C)
        The bone of the slice.

    Returns
    -------
    ndarray of bool, shape (R, C)
        The patch; it shares no pixel with the bone.

    Notes
    -----
    Section 2, Fig. 5 (b): "filling the region between the obtained curves and take the difference between this region
    and the bone".

    Examples
    --------
    A plate 6 px thick with a gap of 10 px, bridged along its two faces, gets 6 x 10 pixels back but for the four at the
    corners, which go with the slivers:

    >>> bone = np.zeros((20, 40), bool)
    >>> bone[7:13] = True
    >>> bone[:, 15:25] = False
    >>> across = np.array([12.0, 28.0])
    >>> outer, inner = (np.stack([np.full(2, row), across], axis=1) for row in (6.5, 12.5))
    >>> int(fill_gap(outer, inner, bone).sum())
    56
    """
    # between the curves and off the bone
    region = pixels_between(outer, inner, (bone.shape[0], bone.shape[1])) & ~bone
    region = ndimage.binary_opening(region)  # no slivers
    labels, n_parts = ndimage.label(region, _EIGHT)
    if n_parts <= 1:
        return region
    # pieces that both curves pass: the others lie beside the gap
    keep = np.intersect1d(_labels_along(outer, labels), _labels_along(inner, labels))
    return np.isin(labels, keep[keep > 0])


def fill_partial_loss(
    bone: NDArray[np.bool_], *, min_area_px: float, region: NDArray[np.bool_] | None = None
) -> NDArray[np.bool_]:
    """Fill the dent of a slice whose bone is still a closed ring.

    Parameters
    ----------
    bone : ndarray of bool, shape (R, C)
        A closed ring.
    min_area_px : float
        Islands of fewer pixels are dropped.
    region : ndarray of bool, shape (R, C), optional
        Where the opening is. Other dents of the skull are natural and stay; all are filled when not given.

    Returns
    -------
    ndarray of bool, shape (R, C)
        As for `fill_gap`.

    Notes
    -----
    Section 2, Fig. 6: "the difference between the segmented bone and its convex hull. Then we discard small islands and
    the biggest region", which is the cavity of the head.

    Examples
    --------
    A square ring with 3 x 4 pixels gone from its outer face:

    >>> ring = np.pad(np.zeros((20, 20), bool), 6, constant_values=True)
    >>> ring[0:3, 14:18] = False
    >>> int(fill_partial_loss(ring, min_area_px=4).sum())
    12
    """
    # convex hull minus bone: the cavity, the dents, and steps of the pixels along the outer face
    missing = convex_hull_image(bone) & ~bone
    labels, n_parts = ndimage.label(missing, _EIGHT)
    sizes = np.bincount(labels.ravel(), minlength=n_parts + 1)
    sizes[0] = 0  # what is not missing

    # without the small islands and without the biggest region
    keep = sizes >= min_area_px
    keep[np.argmax(sizes)] = False
    if region is not None:
        keep &= np.bincount(labels[region], minlength=n_parts + 1) > 0
    return keep[labels]


def _labels_along(curve: Points, labels: NDArray) -> NDArray:
    """Labels that lie within a pixel of a curve."""
    # the curve's points and midpoints, and the pixels around each
    dense = np.concatenate([curve, (curve[1:] + curve[:-1]) / 2])
    near = np.rint(dense[:, None] + _CROSS).astype(int).reshape(-1, 2)
    near = near[((near >= 0) & (near < labels.shape)).all(axis=1)]
    return np.unique(labels[tuple(near.T)])
