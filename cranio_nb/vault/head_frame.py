"""How a head lies in its scan, read off the bone alone: top, face side and midline, whatever the header says.

Frame: mm along the grid's own left, back and up (`orientation.head_axes`); the result in the world (LPS).

Rays run from the middle of the cranial cavity in all directions.

- *Face.* Behind the vault lies nothing but scalp; behind the base in front lie sinuses, orbits, nose and jaws. The
  bone met well behind the first wall, summed over all rays as vectors, points to the face.
- *Midline.* The plane through that direction in which the head is most nearly its own mirror image.
- *Nod and front.* From the face, the orbits and the shape of the cavity, in that plane (`nod`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InputRefused
from ..volume import Volume
from .cavity import cavity_ball, coarse_bone
from .cavity_walls import Walls, measure_walls
from .midline import find_midline
from .nod import find_nod
from .orientation import head_axes

Array = NDArray[np.float64]

_STRAIGHT_DEG = 35.0  # of rotation that the symmetry plane and the mean head are found in spite of
SURE = 0.5
"""Least confidence at which the axes are used."""

_FACE_MM = 0.1  # mean deep bone, as a vector, below which no face is in sight
_BROW_SURE = 4.0  # of the same sum
_ASYMMETRY_MM = 1.5  # mean misfit up to which a midline is a midline
_END = np.cos(np.radians(30.0))  # rays so near to straight up or down
_FORAMEN = 0.05  # share of them that leave through the foramen magnum
_NO_FACE = "No face is in sight; the scan's own axes are used."
_TURNED_OVER = "No face is in sight; the end called base is closed and the end called top is open, as a base is."
_AGREE = "Face, midline and cavity agree on how the head lies."
_DISAGREE = "A face is in sight, but the signs of how the head lies disagree."
_SPREAD_DEG = 12.0  # median distance of the three from their median at which they count half


@dataclass(frozen=True, eq=False)
class HeadFrame:
    """How a head lies.

    Parameters
    ----------
    centre : ndarray, shape (3,)
        In the middle of the cavity, on the midline; world mm.
    axes, grid_axes : ndarray, shape (3, 3)
        Rows: the head's left, back and up; orthonormal, world. By the bone, and by the scan.
    confidence : float
        0 to 1: how far the axes can be trusted. 0 where no face is in sight; the axes are then those of the grid.
    asymmetry : float
        Mean distance in mm of the mirrored bone from the bone.
    spread : float
        How far the three estimates of the nod lie apart, degrees (median distance from their median).
    reason : str
        One sentence: what the frame rests on.
    """

    centre: Array
    axes: Array
    grid_axes: Array
    confidence: float
    asymmetry: float
    spread: float
    reason: str

    @property
    def trusted_axes(self) -> Array:
        """The head's axes by the bone where it shows them, else by the scan.

        Returns
        -------
        ndarray, shape (3, 3)
        """
        return self.axes if self.confidence >= SURE else self.grid_axes

    @property
    def ray_axes(self) -> Array:
        """The axes of the grid where the head lies straight enough on it, else its own, where the bone shows them.

        What is measured along rays about the vertex bears a turned head, but moves a little with the axes it is
        measured in, and those of the grid do not change when a hole is cut.

        Returns
        -------
        ndarray, shape (3, 3)
        """
        axes = self.trusted_axes
        # the angle of the rotation from one to the other follows from its trace
        turn_deg = np.degrees(np.arccos(np.clip((np.trace(axes @ self.grid_axes.T) - 1) / 2, -1, 1)))
        return axes if turn_deg > _STRAIGHT_DEG else self.grid_axes

    @property
    def tilt_deg(self) -> float:
        """Angle between the head's top and that of the scan.

        Returns
        -------
        float
            Degrees.
        """
        return float(np.degrees(np.arccos(np.clip(self.axes[2] @ self.grid_axes[2], -1, 1))))


def find_head_frame(bone: Volume) -> HeadFrame:
    """Find how a head lies.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull, without couch and holder; the head may lie in any way.

    Returns
    -------
    HeadFrame

    Raises
    ------
    InputRefused
        ``NoVault`` when the bone encloses no cranial cavity.

    Notes
    -----
    Mean angles and spreads were measured on 30 adult skulls, laid on each other by their endocranium: the nod's
    standard deviation is 5 degrees.
    """
    # a point in the cavity, and from there the face
    grid_axes = head_axes(bone)
    local = _on_own_axes(bone, grid_axes)
    coarse = coarse_bone(local)
    centre, _ = cavity_ball(coarse)
    walls = measure_walls(local, centre)
    if np.linalg.norm(walls.face) < _FACE_MM:
        return _without_face(walls, bone.to_world(local.to_voxel(centre)), grid_axes)
    # the midline, and in it the nod, from a point on it
    normal, shift, asymmetry = find_midline(coarse, centre, walls.face)
    centre = centre + shift * normal
    axes, spread, brow = find_nod(measure_walls(local, centre), normal)
    # the weakest of the three signs decides
    agreement = [1.5 - spread / _SPREAD_DEG, 2 - asymmetry / _ASYMMETRY_MM, brow / _BROW_SURE]
    confidence = float(np.clip(agreement, 0, 1).min())
    reason = _AGREE if confidence >= SURE else _DISAGREE
    return HeadFrame(
        bone.to_world(local.to_voxel(centre)), axes @ grid_axes, grid_axes, confidence, asymmetry, spread, reason
    )


def _without_face(walls: Walls, centre: Array, grid_axes: Array) -> HeadFrame:
    """The scan's own axes, turned over where bone closes the end called base and not the one called top."""
    open_ends = [np.isnan(walls.first)[side * walls.directions[:, 2] > _END].mean() for side in (1, -1)]
    if open_ends[1] > 0 or open_ends[0] < _FORAMEN:
        return HeadFrame(centre, grid_axes, grid_axes, 0.0, np.nan, np.nan, _NO_FACE)
    turned = grid_axes * np.array([[1.0], [-1.0], [-1.0]])
    return HeadFrame(centre, turned, grid_axes, SURE, np.nan, np.nan, _TURNED_OVER)


def _on_own_axes(bone: Volume, grid_axes: Array) -> Volume:
    """The same voxels with their axes along the coordinates and at the origin, whatever the header turns and shifts."""
    affine = np.pad(np.round(grid_axes @ bone.edges.T, 9), (0, 1))
    affine[3, 3] = 1.0
    return Volume(bone.voxels, affine)


def head_or_grid_axes(bone: Volume) -> Array:
    """The axes that rays are laid along, found from the bone: `HeadFrame.ray_axes`.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.

    Returns
    -------
    ndarray, shape (3, 3)
        Rows: left, back and up, orthonormal, world; those of the grid where the bone encloses no cavity.
    """
    try:
        return find_head_frame(bone).ray_axes
    except InputRefused:
        return head_axes(bone)
