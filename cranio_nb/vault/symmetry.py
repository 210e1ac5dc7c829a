"""The plane that divides a skull into halves like each other: a bone mask with holes comes in -> the plane goes out.

Frame: world mm (LPS); rays in a chart (v, u) about the top of the head, as on `opening.Sky`.

The outer surface of the vault is seen along rays from inside the head. A mirror plane maps it onto itself but for the
skull's asymmetry: every point is reflected, and compared with the surface where its own ray meets it. Rays that meet
no bone, because a hole is there or on the other side, say nothing. With the plane {x : n (x - c) = s} a point becomes

    q = x - 2 (n (x - c) - s) n,

and the three unknowns (two angles of n, and s) make the distances N (q - surface) along its normals N small in the
sense of Tukey's biweight, which leaves out dents, loose pieces and what else has no partner. This is iterative
closest points (Chen and Medioni 1992, doi 10.1016/0262-8856(92)90066-C) with partners found along rays, on the
reflections alone: there is no rigid motion whose mid-plane would have to be taken.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ..errors import InputRefused
from ..volume import Volume

Array = NDArray[np.float64]

_STEP = np.radians(2.0)  # between rays: 2.6 mm on the vault
_SKY = np.radians(105.0)  # from the top of the head down to which the surface is compared
_NEAR, _FAR = 25.0, 140.0  # mm from the eye between which the vault lies
_STRIDE, _HALVINGS = 0.75, 20  # mm between samples of a ray; the edge between two is found to 1e-6 mm
_HALF = 0.5 - 1e-6  # of a blended mask is bone; so a ray midway between bone and none is in bone despite rounding
_RIM = 2  # rays beside a hole that are left out: its edge is bevelled or worn
_YAWS, _ROLLS = np.radians(np.arange(-36, 37, 6)), np.radians(np.arange(-24, 25, 8))
_FARTHEST = 6.0  # mm: a pair further apart counts as no pair when starts are compared
_CUT = 4.685 * 1.4826  # Tukey's constant for residuals in units of their median
_LEAST_CUT = 0.5  # mm
_TOL, _MAX_STEPS = 1e-8, 100  # mm, and 100 mm times radians: so still that the plane hinges on no rounding
_SETTLED = 5e-3  # the same, but for `converged`: far below what a skull's own asymmetry leaves open
_LEAST_PAIRS = 0.25  # part of the sky's rays that must have a partner


@dataclass(frozen=True, eq=False)
class SymmetryPlane:
    """The symmetry plane of a skull.

    Parameters
    ----------
    point : ndarray, shape (3,)
        The point of the plane nearest to the eye, world mm.
    normal : ndarray, shape (3,)
        Unit normal, world, pointing along the scan's columns (to the patient's left).
    angle : float
        Radians between the plane and the mid-plane of the scan.
    offset : float
        Signed distance in mm from the middle of the scan to the plane, along the normal.
    residual : float
        Median distance in mm of the mirrored outer surface from the surface itself: how asymmetric the skull is.
    n_iter : int
    converged : bool
    """

    point: Array
    normal: Array
    angle: float
    offset: float
    residual: float
    n_iter: int
    converged: bool

    @property
    def matrix(self) -> Array:
        """The reflection as a (4, 4) map of the world."""
        flip = np.eye(4)
        flip[:3, :3] -= 2 * np.outer(self.normal, self.normal)
        flip[:3, 3] = 2 * (self.normal @ self.point) * self.normal
        return flip

    def distance(self, points: Array) -> Array:
        """Signed distance in mm of world points (..., 3), positive on the normal's side."""
        return (points - self.point) @ self.normal

    def mirror(self, points: Array) -> Array:
        """Mirror images of world points, shape (..., 3)."""
        return points - 2 * self.distance(points)[..., None] * self.normal

    def mirrored(self, volume: Volume) -> Volume:
        """The mirror image of a volume: the same voxels, standing elsewhere in the world. Nothing is resampled."""
        return Volume(volume.voxels, self.matrix @ volume.affine)

    def record(self) -> dict[str, Any]:
        """Everything about the plane for a design's record; JSON-able, angles in degrees."""
        return {
            "point": self.point.tolist(),
            "normal": self.normal.tolist(),
            "angle_deg": float(np.degrees(self.angle)),
            "offset_mm": self.offset,
            "residual_mm": self.residual,
            "n_iter": self.n_iter,
            "converged": self.converged,
        }


@dataclass(frozen=True, eq=False)
class OuterSurface:
    """The outer surface of the vault along rays on an azimuthal-equidistant chart; nan where it is not seen.

    `axes` rows: left, back, up; `radius` (M, M) mm; `points` and outward `normals` (M, M, 3).
    """

    eye: Array
    axes: Array
    radius: Array
    points: Array
    normals: Array

    @cached_property
    def interior(self) -> Array:
        """1 on rays that see the surface with all their neighbours, else 0, shape (M, M)."""
        return ndimage.binary_erosion(np.isfinite(self.normals).all(axis=-1), np.ones((3, 3))).astype(float)

    def locate(self, away: Array) -> Array:
        """Fractional chart indices (v, u) of directions of any length (n, 3), shape (2, n)."""
        x, y, z = (away @ self.axes.T).T
        flat = np.hypot(x, y)
        scale = np.arctan2(flat, z) / np.maximum(flat, 1e-12) / _STEP
        return np.stack([y * scale, x * scale]) + (len(self.radius) - 1) / 2


def find_symmetry_plane(bone: Volume, centre: Array) -> SymmetryPlane:
    """Find the symmetry plane of a skull, whole or with holes.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull, planes rising to the top of the head. The head may be turned on its grid by about
        35 degrees (nodding counts for nothing, as it stays in the plane).
    centre : ndarray, shape (3,)
        World mm of a point inside the cranial cavity.

    Raises
    ------
    InputRefused
        ``NoSymmetry`` when too little of the vault has a counterpart on the other side.
    """
    surface = measure_outer_surface(bone, np.asarray(centre, float))
    seen = np.isfinite(surface.normals).all(axis=-1)
    points = surface.points[seen] - surface.eye
    normal, shift = _start(surface, points[::3])
    n_iter, moved = 0, np.inf
    while moved > _TOL and n_iter < _MAX_STEPS:
        normal, shift, moved = _step(surface, points, normal, shift)
        n_iter += 1
    distances = _distances(surface, _reflected(points, normal, shift))[0]
    paired = np.isfinite(distances)
    if paired.sum() < _LEAST_PAIRS * np.count_nonzero(_polar(len(surface.radius)) <= _SKY):
        raise InputRefused(
            "NoSymmetry",
            f"{paired.sum()} of the vault's rays have a counterpart on the other side; more of the skull is wanted.",
            "Use a scan of the whole vault, or a method that needs no symmetry.",
        )
    return _described(
        bone, surface, normal, shift, float(np.median(np.abs(distances[paired]))), n_iter, moved <= _SETTLED
    )


def residuals(surface: OuterSurface, plane: SymmetryPlane) -> Array:
    """Signed distance in mm of the mirror image of each ray's point from the surface, shape (M, M).

    nan where the ray or its mirror image meets no bone. Any plane may be asked about; `find` gives the one that makes
    these small.
    """
    seen = np.isfinite(surface.normals).all(axis=-1)
    out = np.full(surface.radius.shape, np.nan)
    out[seen] = _distances(surface, plane.mirror(surface.points[seen]) - surface.eye)[0]
    return out


def _described(
    bone: Volume, surface: OuterSurface, normal: Array, shift: float, residual: float, n_iter: int, converged: bool
) -> SymmetryPlane:
    """The plane with its place in the scan."""
    point = surface.eye + shift * normal
    angle = np.arctan2(np.linalg.norm(np.cross(normal, surface.axes[0])), normal @ surface.axes[0])
    middle = bone.to_world((np.array(bone.shape) - 1) / 2)
    return SymmetryPlane(
        point, normal, float(angle), float((point - middle) @ normal), residual, n_iter, bool(converged)
    )


def measure_outer_surface(bone: Volume, eye: Array) -> OuterSurface:
    """See the outer surface from the eye (world mm), smoothed over neighbouring rays, without the edges of holes."""
    axes = _axes(bone)
    half = int(np.ceil(_SKY / _STEP)) + _RIM + 2
    polar = _polar(2 * half + 1)
    v, u = np.mgrid[-half : half + 1, -half : half + 1] * _STEP
    scale = np.sinc(polar / np.pi)  # sin(angle) / angle
    directions = np.stack([u * scale, v * scale, np.cos(polar)], axis=-1) @ axes
    raw = np.full(polar.shape, np.nan)
    inside = polar <= _SKY + (_RIM + 1) * _STEP
    raw[inside] = _outermost(bone, eye, directions[inside])
    radius = _blurred(raw)
    points = eye + directions * radius[..., None]
    normals = np.cross(np.gradient(points, axis=1), np.gradient(points, axis=0))
    normals *= np.sign(np.einsum("vui,vui->vu", normals, directions))[..., None]
    return OuterSurface(eye, axes, radius, points, normals / np.linalg.norm(normals, axis=-1, keepdims=True))


def _axes(bone: Volume) -> Array:
    """Orthonormal left, back and up of the grid, as rows; a gantry tilt is taken out of up."""
    up, back, left = bone.affine[:3, :3].T
    left = left / np.linalg.norm(left)
    back = back - (back @ left) * left
    back = back / np.linalg.norm(back)
    normal = np.cross(left, back)
    return np.stack([left, back, normal * np.sign(normal @ up)])


def _polar(n: int) -> Array:
    """Angle of each ray of an (n, n) chart from its middle, radians."""
    v, u = np.mgrid[:n, :n] - (n - 1) / 2
    return np.hypot(v, u) * _STEP


def _outermost(bone: Volume, eye: Array, directions: Array) -> Array:
    """Radius in mm where rays (n, 3) leave the outermost bone; nan where they meet none.

    Bone is where the mask, blended between its voxels, exceeds a half. This has no leaps from voxel to voxel, so that
    a rounding of the affine moves no edge.
    """
    start, step = bone.to_voxel(eye), directions @ np.linalg.inv(bone.affine[:3, :3]).T

    def in_bone(rays: NDArray[np.intp], length: Array | float) -> NDArray[np.bool_]:
        at = start[:, None] + length * step[rays].T
        return ndimage.map_coordinates(bone.voxels, at, order=1, mode="grid-constant", output=float) > _HALF

    # the outermost sample in bone
    radius = np.full(len(directions), np.nan)
    for length in np.arange(_FAR, _NEAR, -_STRIDE):
        open_rays = np.flatnonzero(np.isnan(radius))
        radius[open_rays[in_bone(open_rays, length)]] = length
    # the edge between it and the next one outwards, by bisection
    found = np.flatnonzero(np.isfinite(radius))
    for halving in range(1, _HALVINGS + 1):
        further = radius[found] + _STRIDE / 2**halving
        radius[found] = np.where(in_bone(found, further), further, radius[found])
    return radius


def _blurred(radius: Array) -> Array:
    """Radii averaged with their neighbours that are known; nan within `_RIM` rays of those that are not."""
    known = np.isfinite(radius)
    weight = ndimage.gaussian_filter(known.astype(float), 1.0, truncate=_RIM)
    value = ndimage.gaussian_filter(np.where(known, radius, 0.0), 1.0, truncate=_RIM)
    return np.where(ndimage.binary_erosion(known, iterations=_RIM), value / np.maximum(weight, 1e-9), np.nan)


def _reflected(points: Array, normal: Array, shift: float) -> Array:
    """Mirror images of points (n, 3) seen from the eye."""
    return points - 2 * (points @ normal - shift)[:, None] * normal


def _distances(surface: OuterSurface, away: Array) -> tuple[Array, Array]:
    """Signed distance (n,) of points (n, 3) seen from the eye from the surface, nan where unseen; its normals."""
    at = surface.locate(away)
    radius, *normal = (
        ndimage.map_coordinates(field, at, order=1, cval=np.nan)
        for field in (surface.radius, *np.moveaxis(surface.normals, -1, 0))
    )
    normals = np.stack(normal, axis=-1)
    length = np.linalg.norm(away, axis=1)
    lean = np.einsum("ni,ni->n", normals, away) / length
    return (length - radius) * lean, normals


def _start(surface: OuterSurface, points: Array) -> tuple[Array, float]:
    """The best of many planes turned about the up and the back axis, each in the middle between the two sides."""
    best = (np.inf, surface.axes[0], 0.0)
    for yaw in _YAWS:
        for roll in _ROLLS:
            turned = np.array([np.cos(yaw) * np.cos(roll), np.sin(yaw) * np.cos(roll), np.sin(roll)])
            normal = turned @ surface.axes
            shift = float(np.quantile(points @ normal, [0.02, 0.98]).mean())
            away = _reflected(points, normal, shift)
            radius = ndimage.map_coordinates(surface.radius, surface.locate(away), order=1, cval=np.nan)
            apart = np.abs(np.linalg.norm(away, axis=1) - radius)
            cost = float(np.nan_to_num(np.minimum(apart, _FARTHEST), nan=_FARTHEST).mean())
            best = min(best, (cost, normal, shift), key=lambda entry: entry[0])
    return best[1], best[2]


def _step(surface: OuterSurface, points: Array, normal: Array, shift: float) -> tuple[Array, float, float]:
    """One Gauss-Newton step with Tukey's weights; also how far it moved the plane (mm, and 100 mm times radians)."""
    across = np.linalg.svd(normal[None])[2][1:]
    height = points @ normal - shift
    away = _reflected(points, normal, shift)
    distance, normals = _distances(surface, away)
    # pairs fade out towards the rim of what is seen: one that came and went would keep the steps from settling
    fade = ndimage.map_coordinates(surface.interior, surface.locate(away), order=1)
    paired = fade > 0
    distance, normals, fade = distance[paired], normals[paired], fade[paired]
    height, x = height[paired], points[paired]
    lean = normals @ normal
    turns = [-2 * ((x @ e) * lean + height * (normals @ e)) for e in across]
    slopes = np.stack([2 * lean, *turns], axis=1)
    cut = max(_CUT * float(np.median(np.abs(distance))), _LEAST_CUT)
    weight = np.maximum(1 - (distance / cut) ** 2, 0.0) * np.sqrt(fade)  # the root of the biweight
    move = np.linalg.lstsq(slopes * weight[:, None], -distance * weight, rcond=None)[0]
    turned = normal + move[1:] @ across
    return turned / np.linalg.norm(turned), shift + move[0], float(np.abs(move * [1, 100, 100]).max())
