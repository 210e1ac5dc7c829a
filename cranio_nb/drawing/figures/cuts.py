"""A scan and a patch -> the scan as a clinic shows it: an axial, a coronal and a sagittal cut through one place.

Frames: pictures in mm of the world (LPS). The axial cut is seen from the feet and the coronal one from the front, so
that the patient's left is to the right; the sagittal one is seen from the left, the face to the left.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from ...volume import Volume
from ..palette import GUIDE, PATCH, PROSTHESIS, WHITE, rgb_shares
from .axes import Figure, name_sides, scale_bar, show_pixels

CUTS = {
    "axial": ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    "coronal": ((1.0, 0.0, 0.0), (0.0, 0.0, -1.0)),
    "sagittal": ((0.0, 1.0, 0.0), (0.0, 0.0, -1.0)),
}
"""Name of each cut -> directions to the right and down in its picture, LPS."""
_WINDOW_HU = (-200.0, 1300.0)  # black and white: soft tissue dark grey, compact bone white
_BONE_GREY = 0.75  # of bone where the scan is a mask
_CLEAR = 0.3  # of the scan that is seen through the patch
_OPEN_MM = 15.0  # left free of the lines around the place


def cut_figure(
    scan: Volume, patch: Volume | None, name: str, place: ArrayLike, corners: ArrayLike, *, px_mm: float = 0.5
) -> Figure:
    """A cut of a scan with a patch, and where the two other cuts lie.

    Parameters
    ----------
    scan : Volume
        HU, or a bool mask of bone.
    patch : Volume or None
        Bool mask.
    name : str
        One of `CUTS`.
    place : array_like, shape (3,)
        World mm that all cuts run through.
    corners : array_like, shape (2, 3)
        Lowest and highest x, y, z that are shown, world mm.
    px_mm : float
        Size of a pixel.

    Returns
    -------
    Figure
        In pixels: x to the right, y down.
    """
    right, down = np.array(CUTS[name])
    points = _pixels(right, down, np.asarray(place, float), np.asarray(corners, float), px_mm)
    rgb = np.repeat(_grey(scan, points)[..., None], 3, axis=2)
    if patch is not None:
        _paint(rgb, patch.at(points, outside=False))
    figure, ax = show_pixels(rgb)
    # where the two other cuts lie, left open around the place itself
    x, y = (np.asarray(place, float) - points[0, 0]) @ np.stack([right, down], axis=1) / px_mm
    gap, (n_rows, n_cols) = _OPEN_MM / px_mm, rgb.shape[:2]
    ax.hlines([y, y], [0, min(x + gap, n_cols)], [max(x - gap, 0), n_cols - 1], colors=GUIDE, lw=0.8)
    ax.vlines([x, x], [0, min(y + gap, n_rows)], [max(y - gap, 0), n_rows - 1], colors=GUIDE, lw=0.8)
    name_sides(ax, np.stack([right, down]), colour=WHITE)
    scale_bar(ax, 50.0 / px_mm, "50 mm", colour=WHITE)
    return figure


def _pixels(
    right: NDArray[np.float64],
    down: NDArray[np.float64],
    place: NDArray[np.float64],
    corners: NDArray[np.float64],
    px_mm: float,
) -> NDArray[np.float64]:
    """Middles of the pixels of a cut, shape (R, C, 3), world mm."""
    # the upper left corner: each way begins at its lowest or highest place, the third axis stays at `place`
    low, high = corners
    way = right + down
    first = np.where(way == 0, place, np.where(way > 0, low, high))
    rows, cols = (px_mm * (np.arange(int(np.ceil(abs(to @ (high - low)) / px_mm))) + 0.5) for to in (down, right))
    return first + rows[:, None, None] * down + cols[None, :, None] * right


def _grey(scan: Volume, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """A scan as shares of white; black outside of it."""
    if scan.voxels.dtype == bool:
        return _BONE_GREY * scan.at(points, outside=False)
    black, white = _WINDOW_HU
    at = np.moveaxis(scan.to_voxel(points), -1, 0)
    hu = ndimage.map_coordinates(scan.voxels, at, np.float32, order=1, mode="constant", cval=black)
    return np.clip((hu - black) / (white - black), 0, 1)


def _paint(rgb: NDArray[np.float64], patch: NDArray[np.bool_]) -> None:
    """Paint the patch over a cut, clear inside and solid along its edge."""
    rgb[patch] = _CLEAR * rgb[patch] + (1 - _CLEAR) * rgb_shares(PATCH)
    rgb[patch & ~ndimage.binary_erosion(patch, iterations=2)] = rgb_shares(PROSTHESIS)
