"""The plane that divides a skull into halves like each other: a bone mask with holes comes in -> the plane goes out.

Frame: world mm (LPS); offsets count from the head's centre.

The outer surface of the vault is measured along rays from inside the head. A mirror plane maps it onto itself but for
the skull's asymmetry: every point is reflected, and compared with the surface where its own ray meets it. Rays that
meet no bone, because a hole is there or on the other side, say nothing. With the plane {x : n (x - c) = s} a point
becomes

    q = x - 2 (n (x - c) - s) n,

and the three unknowns (two angles of n, and s) make the distances N (q - surface) along its normals N small in the
sense of Tukey's biweight, which leaves out dents, loose pieces and what else has no partner. This is iterative
closest points (Chen and Medioni 1992, doi 10.1016/0262-8856(92)90066-C) with partners found along rays, on the
reflections alone: there is no rigid motion whose mid-plane would have to be taken.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..errors import InputRefused
from ..geometry.robust import TUKEY_CUT, spread, tukey_weights, weighted_fit
from ..volume import Volume
from .outer_surface import COMPARED_RAD, OuterSurface, measure_outer_surface

Array = NDArray[np.float64]

_YAWS, _ROLLS = np.radians(np.arange(-36, 37, 6)), np.radians(np.arange(-24, 25, 8))
_FARTHEST_MM = 6.0  # a pair further apart counts as no pair when starts are compared
_LEAST_CUT_MM = 0.5
_TOL, _MAX_STEPS = 1e-8, 100  # mm, and 100 mm times radians: so still that the plane hinges on no rounding
_SETTLED = 5e-3  # the same, but for `converged`: far below what a skull's own asymmetry leaves open
_LEAST_PAIRS = 0.25  # part of the rays that must have a partner


@dataclass(frozen=True, eq=False)
class SymmetryPlane:
    """The symmetry plane of a skull.

    Parameters
    ----------
    point : ndarray, shape (3,)
        The point of the plane nearest to the head's centre, world mm.
    normal : ndarray, shape (3,)
        Unit normal, world, pointing along the scan's columns (to the patient's left).
    angle_rad : float
        Radians between the plane and the mid-plane of the scan.
    offset_mm : float
        Signed distance in mm from the middle of the scan to the plane, along the normal.
    residual_mm : float
        Median distance in mm of the mirrored outer surface from the surface itself: how asymmetric the skull is.
    n_iter : int
    converged : bool
    """

    point: Array
    normal: Array
    angle_rad: float
    offset_mm: float
    residual_mm: float
    n_iter: int
    converged: bool

    @property
    def matrix(self) -> Array:
        """The reflection as a map of the world.

        Returns
        -------
        ndarray, shape (4, 4)
            World mm -> world mm.
        """
        flip = np.eye(4)
        flip[:3, :3] -= 2 * np.outer(self.normal, self.normal)
        flip[:3, 3] = 2 * (self.normal @ self.point) * self.normal
        return flip

    def distance(self, points: Array) -> Array:
        """Signed distance of points from the plane.

        Parameters
        ----------
        points : ndarray, shape (..., 3)
            World mm.

        Returns
        -------
        ndarray, shape (...)
            mm, positive on the normal's side.
        """
        return (points - self.point) @ self.normal

    def mirror(self, points: Array) -> Array:
        """Mirror images of points.

        Parameters
        ----------
        points : ndarray, shape (..., 3)
            As for `distance`.

        Returns
        -------
        ndarray, shape (..., 3)
            World mm.
        """
        return points - 2 * self.distance(points)[..., None] * self.normal

    def mirrored(self, volume: Volume) -> Volume:
        """The mirror image of a volume.

        Parameters
        ----------
        volume : Volume

        Returns
        -------
        Volume
            The same voxels elsewhere in the world; nothing is resampled.
        """
        return Volume(volume.voxels, self.matrix @ volume.affine)

    def record(self) -> dict[str, Any]:
        """The plane for a design's record.

        Returns
        -------
        dict
            JSON-able; angles in degrees.
        """
        return {
            "point": self.point.tolist(),
            "normal": self.normal.tolist(),
            "angle_deg": float(np.degrees(self.angle_rad)),
            "offset_mm": self.offset_mm,
            "residual_mm": self.residual_mm,
            "n_iter": self.n_iter,
            "converged": self.converged,
        }


def find_symmetry_plane(bone: Volume, centre: Array, axes: Array | None = None) -> SymmetryPlane:
    """Find the symmetry plane of a skull, whole or with holes.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull, planes rising to the top of the head. The head may be turned on its grid by about
        35 degrees (nodding counts for nothing, as it stays in the plane).
    centre, axes
        As for `measure_outer_surface`.

    Returns
    -------
    SymmetryPlane

    Raises
    ------
    InputRefused
        ``NoSymmetry`` when too little of the vault has a counterpart on the other side.
    """
    surface = measure_outer_surface(bone, centre, axes)
    offsets = surface.offsets
    _check_pairs(len(offsets), surface)  # no more than there are rays that meet bone
    # from the best of many planes, steps until it is still
    normal, shift = _best_start(surface, offsets[::3])
    n_iter, moved = 0, np.inf
    while moved > _TOL and n_iter < _MAX_STEPS:
        normal, shift, moved = _step(surface, offsets, normal, shift)
        n_iter += 1
    distances = surface.distances(_reflected(offsets, normal, shift))[0]
    paired = np.isfinite(distances)
    _check_pairs(int(paired.sum()), surface)
    # the plane's place in the scan
    point, left = surface.grid.centre + shift * normal, surface.grid.axes[0]
    return SymmetryPlane(
        point=point,
        normal=normal,
        angle_rad=float(np.arctan2(np.linalg.norm(np.cross(normal, left)), normal @ left)),
        offset_mm=float((point - bone.to_world((np.array(bone.shape) - 1) / 2)) @ normal),
        residual_mm=float(np.median(np.abs(distances[paired]))),
        n_iter=n_iter,
        converged=bool(moved <= _SETTLED),
    )


def mirror_residuals(surface: OuterSurface, plane: SymmetryPlane) -> Array:
    """Signed distance of the mirror image of each ray's point from the surface.

    Parameters
    ----------
    surface : OuterSurface
    plane : SymmetryPlane
        Any; `find_symmetry_plane` gives the one that makes these small.

    Returns
    -------
    ndarray, shape (n, n)
        mm; nan where the ray or its mirror image meets no bone.
    """
    out = np.full(surface.radius.shape, np.nan)
    mirrored = plane.mirror(surface.grid.centre + surface.offsets)
    out[surface.known] = surface.distances(mirrored - surface.grid.centre)[0]
    return out


def _check_pairs(n_paired: int, surface: OuterSurface) -> None:
    """Refuse a skull whose rays have too few partners on the other side."""
    if n_paired < _LEAST_PAIRS * np.count_nonzero(surface.grid.polar <= COMPARED_RAD):
        raise InputRefused(
            "NoSymmetry",
            f"{n_paired} of the vault's rays have a counterpart on the other side; more of the skull is wanted.",
            "Use a scan of the whole vault, or a method that needs no symmetry.",
        )


def _reflected(offsets: Array, normal: Array, shift: float) -> Array:
    """Mirror images of points (k, 3)."""
    return offsets - 2 * (offsets @ normal - shift)[:, None] * normal


def _best_start(surface: OuterSurface, offsets: Array) -> tuple[Array, float]:
    """The best of many planes turned about the up and the back axis, each in the middle between the two sides."""
    best = (np.inf, surface.grid.axes[0], 0.0)
    for yaw in _YAWS:
        for roll in _ROLLS:
            turned = np.array([np.cos(yaw) * np.cos(roll), np.sin(yaw) * np.cos(roll), np.sin(roll)])
            normal = turned @ surface.grid.axes
            shift = float(np.quantile(offsets @ normal, [0.02, 0.98]).mean())
            # how far apart pairs lie along their rays, on average
            away = _reflected(offsets, normal, shift)
            radius = ndimage.map_coordinates(surface.radius, surface.grid.locate(away), order=1, cval=np.nan)
            apart = np.abs(np.linalg.norm(away, axis=1) - radius)
            cost = float(np.nan_to_num(np.minimum(apart, _FARTHEST_MM), nan=_FARTHEST_MM).mean())
            best = min(best, (cost, normal, shift), key=lambda entry: entry[0])
    return best[1], best[2]


def _step(surface: OuterSurface, offsets: Array, normal: Array, shift: float) -> tuple[Array, float, float]:
    """One Gauss-Newton step with Tukey's weights; also how far it moved the plane (mm, and 100 mm times radians)."""
    away = _reflected(offsets, normal, shift)
    distance, normals = surface.distances(away)
    # pairs fade out towards the rim of what is known: one that came and went would keep the steps from settling
    fade = ndimage.map_coordinates(surface.interior, surface.grid.locate(away), order=1)
    paired = fade > 0
    distance, normals, fade, x = distance[paired], normals[paired], fade[paired], offsets[paired]
    # slopes of the distances in s and in the two turns of n
    across = np.linalg.svd(normal[None])[2][1:]
    lean, height = normals @ normal, x @ normal - shift
    turns = [-2 * ((x @ e) * lean + height * (normals @ e)) for e in across]
    slopes = np.stack([2 * lean, *turns], axis=1)
    # the step, and the plane after it
    cut = max(TUKEY_CUT * spread(distance), _LEAST_CUT_MM)
    move = weighted_fit(slopes, -distance, np.sqrt(tukey_weights(distance, cut) * fade))
    turned = normal + move[1:] @ across
    return turned / np.linalg.norm(turned), shift + move[0], float(np.abs(move * [1, 100, 100]).max())
