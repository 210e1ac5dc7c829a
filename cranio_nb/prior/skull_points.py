"""Points of a skull's inside and outside along rays: a bone mask comes in -> points go out.

Frames: mean head (see `mean_frame`); world mm (LPS).

The endocranium is sampled down to the skull base, whose fossae and ridges fix the tilt that the smooth vault leaves
open; the outside is sampled on the vault only.
"""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass

import numpy as np
from numpy.typing import NDArray

from ..grid import inside_grid
from ..vault.head_frame import head_or_grid_axes
from ..vault.orientation import head_centre
from ..volume import Volume
from .mean_frame import MeanFrame, even_directions

Array = NDArray[np.float64]

_ENDOCRANIUM_DEG, _VAULT_DEG = 125.0, 95.0  # from the vertex down to which the inside and the outside are sampled
_NEAR_MM, _FAR_MM, _SAMPLE_MM = 20.0, 135.0, 0.75  # along a ray, and between samples: the inside begins nearer


@dataclass(frozen=True, eq=False)
class SkullPoints:
    """Points of a skull.

    Parameters
    ----------
    outer, inner : ndarray, shape (n, 3)
        Of the outer vault and of the endocranium; mm along `axes` from `centre`, or of the mean frame.
    centre : ndarray, shape (3,)
        World mm.
    axes : ndarray, shape (3, 3)
        Columns: unit vectors of the head's left, back and up, world.
    """

    _: KW_ONLY
    outer: Array
    inner: Array
    centre: Array
    axes: Array

    def moved(self, matrix: Array, shift: Array) -> SkullPoints:
        """The points p as matrix @ p + shift.

        Parameters
        ----------
        matrix : ndarray, shape (3, 3)
        shift : ndarray, shape (3,)
            mm.

        Returns
        -------
        SkullPoints
        """
        outer, inner = (points @ matrix.T + shift for points in (self.outer, self.inner))
        return SkullPoints(outer=outer, inner=inner, centre=self.centre, axes=self.axes)

    def every_other(self) -> SkullPoints:
        """Half of the points.

        Returns
        -------
        SkullPoints
        """
        return SkullPoints(outer=self.outer[::2], inner=self.inner[::2], centre=self.centre, axes=self.axes)


def sample_surface(bone: Volume, axes: Array) -> SkullPoints:
    """Points of a skull along rays from inside it.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    axes : ndarray, shape (3, 3)
        Rows: the head's left, back and up, orthonormal, world; from `vault.head_frame.head_or_grid_axes`.

    Returns
    -------
    SkullPoints

    Raises
    ------
    InputRefused
        ``NoVault`` when the mask holds no skull vault.
    """
    centre, directions = head_centre(bone, axes), even_directions(4)
    radii = measure_outline(bone, MeanFrame(axes.T, centre), directions)
    outer, inner = ((directions * radius[:, None])[np.isfinite(radius)] for radius in radii)
    return SkullPoints(outer=outer, inner=inner, centre=centre, axes=axes.T)


def vault_in_image(bone: Volume) -> float:
    """Share of the vault that lies inside the image, open or closed.

    Parameters
    ----------
    bone : Volume
        Bool mask.

    Returns
    -------
    float
        0 to 1: 1 for a whole head.

    Raises
    ------
    InputRefused
        ``NoVault``.

    Notes
    -----
    On a ray without bone the vault is taken to lie where it does on most others.
    """
    axes, directions = head_or_grid_axes(bone), even_directions(4)
    centre = head_centre(bone, axes)
    outer = measure_outline(bone, MeanFrame(axes.T, centre), directions)[0]
    on_vault = directions[:, 2] > np.cos(np.radians(_VAULT_DEG))
    expected = np.where(np.isfinite(outer), outer, np.nanmedian(outer))[on_vault]
    points = centre + (directions[on_vault] @ axes) * expected[:, None]
    return float(inside_grid(bone.to_voxel(points), bone.shape).mean())


def measure_outline(bone: Volume, frame: MeanFrame, directions: Array) -> tuple[Array, Array]:
    """Last and first bone along rays of the mean frame.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    frame : MeanFrame
    directions : ndarray, shape (n, 3)
        Unit vectors, mean frame.

    Returns
    -------
    outer, inner : ndarray, shape (n,)
        mm of the mean frame; nan for none. The outer radius is looked for on the vault only, the inner one down to the
        skull base.
    """
    # bone or none at even steps along each ray
    stretch, lengths = frame.stretch(directions), np.arange(_NEAR_MM, _FAR_MM, _SAMPLE_MM)
    steps = bone.steps(directions @ frame.matrix.T / stretch[:, None])
    hit = bone.at_index(bone.to_voxel(frame.origin) + steps[:, None, :] * lengths[:, None], outside=False)
    # its first and its last place
    first, last = lengths[hit.argmax(axis=1)], lengths[len(lengths) - 1 - hit[:, ::-1].argmax(axis=1)]
    polar = np.degrees(np.arccos(np.clip(directions[:, 2], -1, 1)))
    met = hit.any(axis=1)
    return (
        np.where(met & (polar < _VAULT_DEG), last / stretch, np.nan),
        np.where(met & (polar < _ENDOCRANIUM_DEG), first / stretch, np.nan),
    )
