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
    splines : dict
        (times by v, times by u) -> products of the B-splines at the Gauss points, sparse, shape (k, n m).
    natural : dict
        (times by v, times by u) -> the natural shape at the Gauss points, shape (k, 3), mm.
    at_springs : dict
        (0, 0) -> products of the B-splines at the springs.
    """

    weight: NDArray[np.float64]
    splines: dict[Pair, sparse.csr_array]
    natural: dict[Pair, NDArray[np.float64]]
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
    weight, splines = _gauss_products(natural.spans)
    shape = derivatives(natural, rational_basis(natural.weights, splines))
    at_springs = spline_products(springs.v, springs.u, natural.spans, (VALUE,))
    return Quadrature(weight, splines, shape, at_springs)


@lru_cache(maxsize=4)
def _gauss_products(spans: tuple[int, int]) -> tuple[NDArray[np.float64], dict[Pair, sparse.csr_array]]:
    """Weights of the Gauss points of all spans, and the products of the B-splines there."""
    (v, by_v), (u, by_u) = (gauss(n) for n in spans)
    return np.outer(by_v, by_u).ravel(), spline_products(np.repeat(v, len(u)), np.tile(u, len(v)), spans)


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
    shape, springs = derivatives(sheet, rational_basis(sheet.weights, sums.splines)), setting.springs
    elastic = sum(
        factor * float(sums.weight @ ((shape[d] - sums.natural[d]) ** 2).sum(axis=1))
        for factor, d in zip(setting.material.stiffness, STRAINS, strict=True)
    )
    pulled = float(springs.strength @ (stretched(sheet, springs, sums) ** 2).sum(axis=1))
    held = dynamics.hold * float(((sheet.weights - 1) ** 2).sum()) if dynamics.free_weights else 0.0
    return (elastic + pulled + held) / 2


def stretched(sheet: Sheet, springs: Springs, sums: Quadrature) -> NDArray[np.float64]:
    """How far each spring is stretched.

    Parameters
    ----------
    sheet : Sheet
    springs : Springs
    sums : Quadrature
        Of a setting with these springs.

    Returns
    -------
    ndarray, shape (k, 3)
        From its place on the sheet to where it pulls, mm.
    """
    return springs.points - derivatives(sheet, rational_basis(sheet.weights, sums.at_springs))[VALUE]
