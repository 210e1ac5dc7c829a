"""What acts on a sheet, and its energy: springs, material and natural shape come in -> a number goes out.

Frame: as in `sheet`. The integrals of the energy are sums over Gauss points; what they need of the B-splines depends on
the spans alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from .sheet import STRAINS, VALUE, Material, Sheet, Springs, gauss
from .sheet_derivatives import Pair, derivatives, rational_basis, spline_products
from .span_sums import Places, sorted_places


@dataclass(frozen=True)
class Dynamics:
    """How a sheet moves.

    Parameters
    ----------
    dt : float
        Time of a step.
    mass, damping : float
        mu and gamma, per unit of parameter area.
    free_weights : bool
        Whether weights move too.
    hold : float
        Constant of the springs that hold each free weight at 1.
    """

    dt: float = 1.0
    mass: float = 1.0
    damping: float = 1.0
    free_weights: bool = False
    hold: float = 1.0


@dataclass(frozen=True, eq=False)
class Setting:
    """What acts on a sheet.

    Parameters
    ----------
    springs : Springs
    natural : Sheet
        The shape without stress, of as many spans.
    material : Material
    """

    springs: Springs
    natural: Sheet
    material: Material


@dataclass(frozen=True, eq=False)
class Quadrature:
    """What the sums of the energy need of a setting, whatever the sheet's place.

    Parameters
    ----------
    weight : ndarray, shape (k,)
        Of the Gauss points.
    inside : Places
        The Gauss points.
    splines : dict
        (times by v, times by u) -> products of the B-splines at the Gauss points, sparse, shape (k, n m).
    natural : dict
        (times by v, times by u) -> the natural shape at the Gauss points, shape (k, 3), mm.
    springs : Springs
        Sorted by span.
    pulled : Places
        Where the springs pull.
    at_springs : dict
        (0, 0) -> products of the B-splines there.
    """

    weight: NDArray[np.float64]
    inside: Places
    splines: dict[Pair, sparse.csr_array]
    natural: dict[Pair, NDArray[np.float64]]
    springs: Springs
    pulled: Places
    at_springs: dict[Pair, sparse.csr_array]


@lru_cache(maxsize=4)  # a motion asks for it at its start and again when it goes on
def quadrature(setting: Setting) -> Quadrature:
    """Prepare the sums of the energy over the Gauss points of all spans and over the springs.

    Parameters
    ----------
    setting : Setting

    Returns
    -------
    Quadrature
    """
    natural, springs = setting.natural, setting.springs
    weight, inside, splines = _gauss_products(natural.spans)
    shape = derivatives(natural, rational_basis(natural.weights, splines))
    # the springs, sorted as their places are
    pulled = sorted_places(springs.v, springs.u, natural.spans)
    springs = Springs(*(part[pulled.order] for part in (springs.points, springs.v, springs.u, springs.strength)))
    at_springs = spline_products(springs.v, springs.u, natural.spans, (VALUE,))
    return Quadrature(weight, inside, splines, shape, springs, pulled, at_springs)


@lru_cache(maxsize=4)
def _gauss_products(spans: tuple[int, int]) -> tuple[NDArray[np.float64], Places, dict[Pair, sparse.csr_array]]:
    """Weights of the Gauss points of all spans, the points, and the products of the B-splines there."""
    (v, by_v), (u, by_u) = (gauss(n) for n in spans)
    v, u = np.repeat(v, len(u)), np.tile(u, len(v))
    inside = sorted_places(v, u, spans)
    splines = spline_products(v[inside.order], u[inside.order], spans)
    return np.outer(by_v, by_u).ravel()[inside.order], inside, splines


def potential(sheet: Sheet, setting: Setting, dynamics: Dynamics, sums: Quadrature) -> float:
    """Elastic energy of a sheet and of the springs.

    Parameters
    ----------
    sheet : Sheet
    setting : Setting
    dynamics : Dynamics
    sums : Quadrature
        Of the setting.

    Returns
    -------
    float
    """
    # where the Gauss points and the places of the springs lie
    shape = derivatives(sheet, rational_basis(sheet.weights, sums.splines))
    pulled = derivatives(sheet, rational_basis(sheet.weights, sums.at_springs))[VALUE]
    elastic = sum(
        factor * float(sums.weight @ ((shape[d] - sums.natural[d]) ** 2).sum(axis=1))
        for factor, d in zip(setting.material.stiffness, STRAINS, strict=True)
    )
    stretched = float(sums.springs.strength @ ((sums.springs.points - pulled) ** 2).sum(axis=1))
    held = dynamics.hold * float(((sheet.weights - 1) ** 2).sum()) if dynamics.free_weights else 0.0
    return (elastic + stretched + held) / 2
