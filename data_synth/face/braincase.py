"""Seed -> the braincase: closed-form outer and inner surface with the marks a real vault has.

Frame: head mm. To the dome of `HeadShape` are added smooth bumps, thin temples, a thick brow, the protuberance at the
back, and sutures. The floor inside the skull is another surface; see `base_map`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..head import HeadShape, head_shape, lengths
from .pose import rigid

Array = NDArray[np.float64]

# x, y, z of the direction, narrowness, mm added to the outer surface and to the thickness; x > 0 stands for both sides
_BUMPS = (
    (1.0, -0.15, 0.12, 10.0, -2.0, -2.6),  # thin temporal squama
    (0.85, -0.75, 0.1, 12.0, -5.0, -1.0),  # narrow behind the orbits
    (0.0, -1.0, 0.06, 45.0, 4.0, 6.5),  # brow, thick enough for a sinus
    (0.0, 1.0, -0.15, 40.0, 3.0, 4.0),  # protuberance at the back
    (0.4, 0.6, -0.7, 9.0, 0.0, -2.5),  # thin floor beside it
    (0.75, 0.4, 0.65, 8.0, 3.0, 0.3),  # parietal eminences
    (0.35, -0.75, 0.6, 9.0, 2.0, 0.2),  # frontal eminences
    (0.0, 0.25, 1.0, 7.0, 4.0, 0.6),  # high vertex
)
# normal and offset in mm of each suture's plane, the half space in which it runs, and the waves' height in mm
_SUTURES = (
    ((0.0, 0.986, -0.164), -34.5, (0.0, 0.0, 1.0), 4.0, 1.2),  # coronal
    ((1.0, 0.0, 0.0), 0.0, (0.0, 0.4, 0.917), 73.0, 1.0),  # sagittal
    ((-0.653, 0.397, -0.645), 0.0, (0.6, 0.8, 0.0), 52.0, 2.0),  # lambdoid, left
    ((0.653, 0.397, -0.645), 0.0, (-0.6, 0.8, 0.0), 52.0, 2.0),  # lambdoid, right
    ((0.5, 0.25, 0.83), 53.5, (1.0, -0.1, 0.0), 54.0, 0.4),  # squamous, left
    ((-0.5, 0.25, 0.83), 53.5, (-1.0, -0.1, 0.0), 54.0, 0.4),  # squamous, right
)


@dataclass(frozen=True, eq=False)
class Braincase(HeadShape):
    """The dome with its bumps, posed in the world.

    Parameters
    ----------
    bumps : ndarray, shape (K, 6)
        Unit direction (3), narrowness, mm on the outer surface, mm on the thickness. A bump's height at the
        direction d is its mm times exp(narrowness (d . direction - 1)).
    rotation : ndarray, shape (3, 3)
        Head frame -> world, about `centre`.
    """

    bumps: Array | None = None
    rotation: Array | None = None

    def outer_radius(self, directions: ArrayLike) -> Array:
        """As for `HeadShape`, with the bumps; directions in the head's frame."""
        return super().outer_radius(directions) + self._bump(directions)[0]

    def bone_thickness(self, directions: ArrayLike) -> Array:
        """As for `HeadShape`, with the bumps; directions in the head's frame."""
        return super().bone_thickness(directions) + self._bump(directions)[1]

    def gradients(self, offsets: ArrayLike) -> tuple[Array, Array]:
        """As for `HeadShape`, with the bumps; offsets in head mm."""
        p = np.asarray(offsets, float)
        length = lengths(p)[..., None]
        d = p / length
        weights = self._weights(d) * self._marks[:, 3]
        slopes = [(weights * self._marks[:, column]) @ self._marks[:, :3] for column in (4, 5)]
        tangent = [(s - np.einsum("...i,...i->...", s, d)[..., None] * d) / length for s in slopes]
        outer, inner = super().gradients(p)
        return outer - tangent[0], inner - tangent[0] + tangent[1]

    def surfaces(self, offsets: ArrayLike) -> tuple[Array, Array]:
        """Depth below the outer surface and thickness, both along the ray.

        Parameters
        ----------
        offsets : array_like, shape (..., 3)
            Points from the centre, head mm; not zero.

        Returns
        -------
        tuple of ndarray, shape (...)
            mm.
        """
        p = np.asarray(offsets, float)
        length = lengths(p)
        d = p / length[..., None]
        outer, thick = self._bump(d)
        return HeadShape.outer_radius(self, d) + outer - length, HeadShape.bone_thickness(self, d) + thick

    def slope(self, offsets: ArrayLike) -> Array:
        """How much longer a ray from the centre is than the way across the bone.

        Parameters
        ----------
        offsets : array_like
            As for `surfaces`.

        Returns
        -------
        ndarray, shape (...)
            Length of the outer surface's gradient, at least 1.
        """
        return lengths(self.gradients(offsets)[0])

    def upright(self, affine: Array) -> Array:
        """The affine of a scan as if the head had not been posed, shape (4, 4)."""
        return affine if self.rotation is None else rigid(self.rotation.T, self.centre) @ affine

    def suture_distance(self, offsets: Array) -> Array:
        """Distance from the nearest suture.

        Parameters
        ----------
        offsets : ndarray, shape (..., 3)
            Points from the centre, head mm, in the bone.

        Returns
        -------
        ndarray, shape (...)
            mm, to first order.
        """
        x, y, z = np.moveaxis(offsets, -1, 0)
        waves = np.sin(1.1 * np.sqrt((0.9 * x) ** 2 + y**2 + (1.1 * z) ** 2) + 0.8 * y + 0.9 * z)
        nearest = np.full(x.shape, np.inf)
        for (a, b, c), offset, (u, v, w), start, height in _SUTURES:
            across = np.abs(a * x + b * y + c * z - offset + height * waves)
            nearest = np.minimum(nearest, across + np.maximum(start - (u * x + v * y + w * z), 0))
        return nearest

    def _bump(self, directions: ArrayLike) -> tuple[Array, Array]:
        weights = self._weights(np.asarray(directions, float))
        outer, thickness = (np.einsum("...k,k->...", weights, self._marks[:, column]) for column in (4, 5))
        return outer, thickness

    def _weights(self, d: Array) -> Array:
        return np.exp((np.einsum("...i,ki->...k", d, self._marks[:, :3]) - 1) * self._marks[:, 3])

    @property
    def _marks(self) -> Array:
        return np.zeros((0, 6)) if self.bumps is None else self.bumps


def braincase(
    rng: np.random.Generator,
    centre: ArrayLike,
    rotation: Array,
    *,
    asymmetry: float = 1.0,
    thickness_scale: float = 1.0,
) -> Braincase:
    """An adult braincase, a little different for every state of `rng`.

    Parameters
    ----------
    rng, centre, thickness_scale
        As for `head_shape`.
    rotation : ndarray, shape (3, 3)
        Head frame -> world.
    asymmetry : float
        Factor on what makes left and right differ; 0 gives mirror images.

    Returns
    -------
    Braincase
        Without cutters.
    """
    dome = head_shape(rng, centre, thickness_scale=thickness_scale)
    odd_shape = np.array([1, 1, 1, 0, 0, 0, 0, 1])
    odd_thickness = np.array([0, 0, 0, 0, 1, 0, 1])
    shape = dome.shape * np.where(odd_shape, asymmetry, 1.0)
    thickness = dome.thickness * np.where(odd_thickness, asymmetry, 1.0)
    marks = np.array(_BUMPS)
    marks[:, 4:] *= rng.uniform(0.8, 1.15, (len(marks), 1))
    marks[:, :3] /= lengths(marks[:, :3])[:, None]
    mirrored = marks[marks[:, 0] > 0] * [-1, 1, 1, 1, 1, 1]
    mirrored[:, 4:] *= 1 + 0.15 * asymmetry * rng.uniform(-1, 1, (len(mirrored), 1))
    bumps = np.concatenate([marks, mirrored])
    height = np.array([[1.0, 1.0, 1.0], [1.0, 1.0, rng.uniform(0.8, 1.0)]])
    plain = replace(dome, half_axes=dome.half_axes * height, shape=shape, thickness=thickness)
    return Braincase(**vars(plain), bumps=bumps, rotation=rotation)
