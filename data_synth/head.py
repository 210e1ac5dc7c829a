"""Coefficients -> a head whose outer skull, inner skull and scalp are known in closed form.

Frame: world mm, DICOM LPS (x to the patient's left, y to the back, z to the head's top). All surfaces are radii
r(d) about `HeadShape.centre`, so a point p is inside one exactly when |p - centre| < r((p - centre) / |p - centre|).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .defect import Cutter

Array = NDArray[np.float64]

# Monomials x^i y^j z^k of a unit direction; the odd powers of x make left and right differ.
SHAPE_TERMS = ((1, 0, 0), (1, 1, 0), (1, 0, 1), (0, 0, 1), (0, 1, 1), (2, 1, 0), (0, 3, 0), (1, 2, 1))
THICKNESS_TERMS = ((0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 1, 0), (1, 0, 0), (0, 2, 1), (1, 1, 1))
_EXPONENT = 2.25  # of the superellipsoid: a head is a little boxier than an ellipsoid; its curvature stays continuous
_FORAMEN = np.array([0.0, 0.27, -1.0]) / np.hypot(0.27, 1.0)


@dataclass(frozen=True, eq=False)
class HeadShape:
    """A closed skull about a centre, its scalp, and the defects cut into it.

    Parameters
    ----------
    centre : ndarray, shape (3,)
        World mm; about the height of the skull base.
    half_axes : ndarray, shape (2, 3)
        Half axes in mm along (x, y, z), for negative (row 0) and positive (row 1) coordinates.
    shape : ndarray, shape (8,)
        Relative size of each of `SHAPE_TERMS`.
    thickness : ndarray, shape (7,)
        mm of each of `THICKNESS_TERMS`; thickness is measured along the ray from the centre.
    scalp : float
        Thickness of the scalp in mm, along the ray.
    foramen : float
        Half angle in radians of the round opening in the skull base (0 for none).
    cutters : tuple of Cutter
        Defects; the complete skull ignores them.
    """

    centre: Array
    half_axes: Array
    shape: Array
    thickness: Array
    scalp: float = 6.0
    foramen: float = 0.3
    cutters: tuple[Cutter, ...] = ()

    def upright(self, affine: Array) -> Array:
        """The affine of a scan in which the head stands upright, shape (4, 4): this head always does."""
        return affine

    def outer_radius(self, directions: ArrayLike) -> Array:
        """Distance of the outer skull surface from the centre along rays.

        Parameters
        ----------
        directions : array_like, shape (..., 3)
            Unit vectors.

        Returns
        -------
        ndarray, shape (...)
            mm.
        """
        x = np.asarray(directions, float)
        return (1 + polynomial(self.shape, SHAPE_TERMS, x)) / self.norm(x)

    def inner_radius(self, directions: ArrayLike) -> Array:
        """Distance of the inner skull surface from the centre along rays; all else as for `outer_radius`."""
        return self.outer_radius(directions) - self.bone_thickness(directions)

    def skin_radius(self, directions: ArrayLike) -> Array:
        """Distance of the scalp from the centre along rays; all else as for `outer_radius`."""
        return self.outer_radius(directions) + self.scalp

    def bone_thickness(self, directions: ArrayLike) -> Array:
        """Thickness of the skull along rays from the centre; all else as for `outer_radius`."""
        return polynomial(self.thickness, THICKNESS_TERMS, np.asarray(directions, float))

    def norm(self, offsets: ArrayLike) -> Array:
        """Superellipsoid norm of offsets from the centre.

        Parameters
        ----------
        offsets : array_like, shape (..., 3)
            Points minus the centre, mm.

        Returns
        -------
        ndarray, shape (...)
            1 on the smooth body of the head, less inside.
        """
        x = np.asarray(offsets, float)
        return np.power(_powers(x / self._axes_of(x)) @ np.ones(3), 1 / _EXPONENT)

    def gradients(self, offsets: ArrayLike) -> tuple[Array, Array]:
        """Gradients of |p| - r(p / |p|) for the outer and the inner surface.

        Parameters
        ----------
        offsets : array_like, shape (..., 3)
            Points minus the centre, mm; not zero.

        Returns
        -------
        outer, inner : ndarray, shape (..., 3)
            On a surface they are its normals, outward, not of unit length.
        """
        p = np.asarray(offsets, float)
        length = lengths(p)[..., None]
        d = p / length
        outer, thickness = self._outer_slope(d), polynomial_gradient(self.thickness, THICKNESS_TERMS, d)
        return d - _across(outer, d) / length, d - _across(outer - thickness, d) / length

    def foramen_distance(self, offsets: ArrayLike) -> Array:
        """Signed distance from the cone of the foramen.

        Parameters
        ----------
        offsets
            As for `norm`.

        Returns
        -------
        ndarray, shape (...)
            mm, positive inside the cone.
        """
        p = np.asarray(offsets, float)
        length = lengths(p)
        cosine = p @ _FORAMEN / np.maximum(length, 1e-9)
        return (self.foramen - np.arccos(np.clip(cosine, -1, 1))) * length if self.foramen else -length - 1.0

    def inside_bone(self, offsets: ArrayLike) -> NDArray[np.bool_]:
        """Whether points lie in the complete skull, without its defects.

        Parameters
        ----------
        offsets : array_like, shape (..., 3)
            Points minus the centre, mm; not zero.

        Returns
        -------
        ndarray of bool, shape (...)
        """
        p = np.asarray(offsets, float)
        length = lengths(p)
        d = p / length[..., None]
        outer = self.outer_radius(d)
        shell = (length < outer) & (length >= outer - self.bone_thickness(d))
        return shell & (self.foramen_distance(p) <= 0)

    def _outer_slope(self, d: Array) -> Array:
        """Gradient of (1 + h(x)) / N(x) at unit directions, before it is made tangential."""
        axes = self._axes_of(d)
        n = self.norm(d)[..., None]
        dn = np.sign(d) * _powers(d / axes) / np.where(d == 0, 1, np.abs(d)) * n ** (1 - _EXPONENT)
        h = polynomial(self.shape, SHAPE_TERMS, d)[..., None]
        return polynomial_gradient(self.shape, SHAPE_TERMS, d) / n - (1 + h) * dn / n**2

    def _axes_of(self, x: Array) -> Array:
        """Half axes that hold on each point's side."""
        return np.where(x < 0, self.half_axes[0], self.half_axes[1])


def head_shape(rng: np.random.Generator, centre: ArrayLike, *, thickness_scale: float = 1.0) -> HeadShape:
    """An adult head, a little different for every state of `rng`.

    Parameters
    ----------
    rng : Generator
        Source of the variation.
    centre : array_like, shape (3,)
        World mm.
    thickness_scale : float
        Factor on the skull's thickness (4 to 9 mm at 1), for coarse grids.

    Returns
    -------
    HeadShape
        Without defects.
    """
    half_axes = np.array([[69.0, 89.0, 54.0], [69.0, 95.0, 87.0]]) * (1 + 0.02 * rng.uniform(-1, 1, (1, 3)))
    shape = np.array([0.012, 0.015, 0.012, 0.02, 0.03, 0.06, -0.015, 0.012])
    shape = shape * rng.choice([-1.0, 1.0], 8) ** (np.array(SHAPE_TERMS)[:, 0] % 2) * rng.uniform(0.6, 1.2, 8)
    thickness = np.array([6.4, -1.3, 0.9, 0.5, 0.3, 0.6, 0.4]) * rng.uniform(0.8, 1.2, 7)
    thickness[0] = 6.4 * rng.uniform(0.97, 1.06)
    return HeadShape(np.asarray(centre, float), half_axes, shape, thickness * thickness_scale)


def lengths(p: Array) -> Array:
    """Lengths of vectors; much faster than `numpy.linalg.norm` on many short ones.

    Parameters
    ----------
    p : ndarray, shape (..., 3)

    Returns
    -------
    ndarray, shape (...)
    """
    return np.sqrt(np.einsum("...i,...i->...", p, p))


def polynomial(coefficients: Array, terms: tuple[tuple[int, int, int], ...], x: Array) -> Array:
    """Sum of coefficient times monomial.

    Parameters
    ----------
    coefficients : ndarray, shape (n,)
    terms : tuple of tuple of int
        n powers (i, j, k) of x^i y^j z^k.
    x : ndarray, shape (..., 3)

    Returns
    -------
    ndarray, shape (...)
    """
    total = np.zeros(x.shape[:-1])
    for coefficient, powers in zip(coefficients, terms, strict=True):
        total += _monomial(float(coefficient), powers, x)
    return total


def polynomial_gradient(coefficients: Array, terms: tuple[tuple[int, int, int], ...], x: Array) -> Array:
    """Gradient of `polynomial`.

    Parameters
    ----------
    coefficients, terms, x
        As for `polynomial`.

    Returns
    -------
    ndarray, shape (..., 3)
    """
    gradient = np.zeros(x.shape)
    for coefficient, powers in zip(coefficients, terms, strict=True):
        for axis in np.flatnonzero(powers):
            lower = tuple(n - (i == axis) for i, n in enumerate(powers))
            gradient[..., axis] += _monomial(float(coefficient) * powers[axis], lower, x)
    return gradient


def _monomial(coefficient: float, powers: tuple[int, ...], x: Array) -> Array:
    value = np.full(x.shape[:-1], coefficient)
    for axis, power in enumerate(powers):
        for _ in range(power):
            value *= x[..., axis]
    return value


def _powers(x: Array) -> Array:
    """|x| to the 2.25, by square roots, which are much faster than a power."""
    return x * x * np.sqrt(np.sqrt(np.abs(x)))


def _across(v: Array, d: Array) -> Array:
    """The part of v at right angles to d."""
    return v - np.einsum("...i,...i->...", v, d)[..., None] * d
