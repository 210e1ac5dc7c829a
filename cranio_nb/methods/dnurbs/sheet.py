"""A rational tensor-product surface, and the sheet of least energy that springs hold to given points.

Frame: any; lengths in mm. Parameters (v, u) run from 0 to the number of spans each way.

    s(v, u) = sum_ij w_ij p_ij B_i(v) B_j(u) / sum_ij w_ij B_i(v) B_j(u)

with cubic B-splines on clamped uniform knots. The energy is the thin plate under tension

    E = 1/2 int a11 |t_v|^2 + a22 |t_u|^2 + b11 |t_vv|^2 + b12 |t_vu|^2 + b22 |t_uu|^2
        + 1/2 sum_i k_i |d_i - s(v_i, u_i)|^2,    t = s - s0,

of Qin and Terzopoulos 1996, "D-NURBS: a physics-based framework for geometric design", IEEE TVCG 2(1), with a natural
shape s0 that is free of stress, as elastic bodies have one (Terzopoulos et al. 1987); with s0 = 0 it is theirs. With
weights frozen at 1 the surface is linear in its control points, the energy quadratic, and its least found by one
sparse solve.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.interpolate import BSpline

from ...geometry.band import band_of, band_solver

_DEGREE = 3
LOCAL = (_DEGREE + 1) ** 2
"""Control points that move a span."""
_GAUSS = 4  # points a span: exact for products of two cubics
_LEAST_DOUBT = 0.3  # mm off the sheet that no spring is weakened for

VALUE, BY_V, BY_U, BY_VV, BY_VU, BY_UU = (0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)
STRAINS = (BY_V, BY_U, BY_VV, BY_VU, BY_UU)
"""Derivatives in the energy, in the order of `Material.stiffness`."""


@dataclass(frozen=True, eq=False)
class Sheet:
    """A rational surface.

    Parameters
    ----------
    control : ndarray, shape (n, m, 3)
        Control points.
    weights : ndarray, shape (n, m)
        Positive; all alike for a plain B-spline surface.
    """

    control: NDArray[np.float64]
    weights: NDArray[np.float64]

    @property
    def spans(self) -> tuple[int, int]:
        """Number of polynomial pieces along v and u, the ends of the parameters.

        Returns
        -------
        tuple of int
        """
        return self.weights.shape[0] - _DEGREE, self.weights.shape[1] - _DEGREE

    def at(self, v: NDArray[np.float64], u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points of the surface.

        Parameters
        ----------
        v, u : ndarray, shape (k,)
            Parameters, 0 to the number of spans.

        Returns
        -------
        ndarray, shape (k, 3)
            In the frame of the control points, mm.
        """
        # numerator and denominator of the rational surface
        values = tensor(v, u, self.spans, VALUE)
        weights = self.weights.ravel()
        return (values @ (self.control.reshape(-1, 3) * weights[:, None])) / (values @ weights)[:, None]


@dataclass(frozen=True)
class Material:
    """What a sheet is made of.

    Parameters
    ----------
    stiffness : tuple of float
        a11, a22 (tension), b11, b12, b22 (bending).
    """

    stiffness: tuple[float, float, float, float, float]

    @classmethod
    def plate(cls, tension: float, rigidity: float, span: tuple[float, float]) -> Material:
        """The same in every direction of a sheet whose spans measure `span` mm along v and u.

        Parameters
        ----------
        tension : float
            Factor of |grad s|^2 per mm2 of the sheet, mm2.
        rigidity : float
            Factor of |second derivatives|^2 per mm2, mm4.
        span : tuple of float
            mm.

        Returns
        -------
        Material
        """
        # derivatives by parameters are those by mm times the span's length, and an area element is v u
        v, u = span
        bends = (rigidity / v**4, 2 * rigidity / (v * u) ** 2, rigidity / u**4)
        return cls(tuple(v * u * x for x in (tension / v**2, tension / u**2, *bends)))  # type: ignore[arg-type]


@dataclass(frozen=True, eq=False)
class Springs:
    """Springs between points in space and places on the sheet.

    Parameters
    ----------
    points : ndarray, shape (k, 3)
        Where they pull to.
    v, u : ndarray, shape (k,)
        Parameters of the places they pull.
    strength : ndarray, shape (k,)
        Each spring's constant.
    """

    points: NDArray[np.float64]
    v: NDArray[np.float64]
    u: NDArray[np.float64]
    strength: NDArray[np.float64]


def basis(x: NDArray[np.float64], spans: int, derivative: int = 0) -> sparse.csr_array:
    """Cubic B-splines on clamped uniform knots, or a derivative of them.

    Parameters
    ----------
    x : ndarray, shape (k,)
        Between 0 and `spans`.
    spans : int
        Number of polynomial pieces.
    derivative : int
        0, 1 or 2.

    Returns
    -------
    sparse array, shape (k, spans + 3)
        Four entries side by side in each row, zeros among them.
    """
    # clamped: the end knots repeat, so that the sheet ends at its outer control points
    knots = np.concatenate([np.zeros(_DEGREE), np.arange(spans + 1.0), np.full(_DEGREE, spans)])
    lower = BSpline.design_matrix(x, knots[derivative : len(knots) - derivative], _DEGREE - derivative)
    values = lower.data.reshape(len(x), -1)
    first = lower.indices.reshape(values.shape)[:, :1]
    # B'_i = p (B_i / (t_i+p - t_i) - B_i+1 / (t_i+p+1 - t_i+1)) of one degree less, as often as asked
    for degree in range(_DEGREE - derivative + 1, _DEGREE + 1):
        own = knots[_DEGREE - degree : len(knots) - _DEGREE + degree]
        width = own[degree + 1 : -1] - own[1 : -degree - 1]
        slope = degree * values / width[first + np.arange(degree)]
        values = np.pad(slope, ((0, 0), (1, 0))) - np.pad(slope, ((0, 0), (0, 1)))
    columns = first + np.arange(_DEGREE + 1)
    rows = np.arange(0, columns.size + 1, _DEGREE + 1)
    return sparse.csr_array((values.ravel(), columns.ravel(), rows), shape=(len(x), spans + _DEGREE))


def tensor(
    v: NDArray[np.float64], u: NDArray[np.float64], spans: tuple[int, int], derivative: tuple[int, int]
) -> sparse.csr_array:
    """Products of the B-splines along v and u at scattered parameters.

    Parameters
    ----------
    v, u : ndarray, shape (k,)
        Parameters.
    spans : tuple of int
        Along v and u.
    derivative : tuple of int
        How often to differentiate along each.

    Returns
    -------
    sparse array, shape (k, n m)
        `LOCAL` entries in each row, zeros among them: the same columns for all places of a span, whatever the
        derivative.
    """
    # row by row the outer product of two sparse rows
    along_v, along_u = (basis(x, n, d) for x, n, d in zip((v, u), spans, derivative, strict=True))
    (at_v, at_u), (by_v, by_u) = (
        [getattr(part, name).reshape(len(v), _DEGREE + 1) for part in (along_v, along_u)]
        for name in ("indices", "data")
    )
    columns = at_v[:, :, None] * along_u.shape[1] + at_u[:, None, :]
    values = by_v[:, :, None] * by_u[:, None, :]
    rows = np.arange(0, columns.size + 1, LOCAL)
    return sparse.csr_array(
        (values.ravel(), columns.ravel(), rows), shape=(len(v), along_v.shape[1] * along_u.shape[1])
    )


def scale_rows(matrix: sparse.csr_array, by: NDArray) -> sparse.csr_array:
    """A diagonal matrix times another.

    Parameters
    ----------
    matrix : sparse array, shape (n, m)
    by : ndarray, shape (n,)

    Returns
    -------
    sparse array, shape (n, m)

    Examples
    --------
    >>> scale_rows(sparse.csr_array([[1.0, 2.0], [0.0, 3.0]]), np.array([10.0, 100.0])).toarray().tolist()
    [[10.0, 20.0], [0.0, 300.0]]
    """
    each = np.repeat(by, np.diff(matrix.indptr))
    return sparse.csr_array((matrix.data * each, matrix.indices, matrix.indptr), matrix.shape)


def gauss(spans: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Gauss points of all spans and their weights.

    Parameters
    ----------
    spans : int
        Number of polynomial pieces.

    Returns
    -------
    x, weight : ndarray, shape (4 spans,)
    """
    x, w = np.polynomial.legendre.leggauss(_GAUSS)
    return (np.arange(spans)[:, None] + (x + 1) / 2).ravel(), np.tile(w / 2, spans)


def stiffness(spans: tuple[int, int], material: Material) -> sparse.csr_array:
    """K of a sheet whose weights are all alike: E = 1/2 sum over coordinates of p K p.

    The integrals over (v, u) fall apart into products of integrals along v and along u.

    Parameters
    ----------
    spans : tuple of int
        Along v and u.
    material : Material

    Returns
    -------
    sparse array, shape (n m, n m)
    """
    # int B^(d) B^(d) dv times int B^(e) B^(e) du: a Kronecker product for each strain
    grams = [_grams(n) for n in spans]
    total = sparse.csr_array((grams[0][0].shape[0] * grams[1][0].shape[0],) * 2)
    for factor, (d, e) in zip(material.stiffness, STRAINS, strict=True):
        total = total + factor * sparse.kron(grams[0][d], grams[1][e])
    return sparse.csr_array(total)


@lru_cache(maxsize=8)
def _grams(spans: int) -> list[sparse.csr_array]:
    """Integrals of the products of B-splines, of their first and of their second derivatives."""
    # Gauss quadrature, exact for these polynomials
    x, w = gauss(spans)
    parts = [basis(x, spans, d) for d in range(3)]
    return [sparse.csr_array(part.T @ sparse.diags_array(w) @ part) for part in parts]


def settle(springs: Springs, natural: Sheet, material: Material, *, rounds: int = 0) -> tuple[Sheet, Springs]:
    """The sheet of least energy with weights frozen at 1.

    Parameters
    ----------
    springs : Springs
        Enough to hold the sheet: not all of them on one line when there is no tension.
    natural : Sheet
        The shape without stress; weights all 1.
    material : Material
    rounds : int
        How often springs that stay far off the sheet are weakened and the sheet settles anew: a spring keeps half its
        strength at three standard deviations, these taken from the median.

    Returns
    -------
    sheet : Sheet
    springs : Springs
        With their last strengths.
    """
    # unknown is the change t = s - s0: no bending at t = 0
    places = tensor(springs.v, springs.u, natural.spans, VALUE)
    bent, rest = stiffness(natural.spans, material), natural.control.reshape(-1, 3)
    pulled, strength = springs.points - places @ rest, springs.strength
    change = _solved(places, strength, bent, pulled)
    # Cauchy's weights: a spring to a suture or a ridge is weakened, never cut
    for _ in range(rounds):
        off = np.linalg.norm(pulled - places @ change, axis=1)
        limit = max(3 * 1.4826 * float(np.median(off)), _LEAST_DOUBT)
        strength = springs.strength / (1 + (off / limit) ** 2)
        change = _solved(places, strength, bent, pulled)
    # the natural shape plus what the springs change of it
    control = (rest + change).reshape(natural.control.shape)
    return Sheet(control, np.ones_like(natural.weights)), replace(springs, strength=strength)


def flat(spans: tuple[int, int]) -> Sheet:
    """A sheet shrunk to one point: the natural shape of one that wants to be plane.

    Parameters
    ----------
    spans : tuple of int
        Along v and u.

    Returns
    -------
    Sheet
        All control points in one, weights 1.
    """
    shape = (spans[0] + _DEGREE, spans[1] + _DEGREE)
    return Sheet(np.zeros((*shape, 3)), np.ones(shape))


def _solved(
    places: sparse.csr_array, strength: NDArray, bent: sparse.csr_array, pulled: NDArray
) -> NDArray[np.float64]:
    """Control points, shape (n m, 3), that balance springs and bending."""
    # (K + P^T k P) t = P^T k d: the energy's slope is zero
    pull = scale_rows(places, strength).T
    return band_solver(band_of(bent + pull @ places))(pull @ pulled)
