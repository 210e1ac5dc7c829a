"""A sheet in motion: springs and a sheet at any place come in -> the sheet as it moves towards rest.

Frame: as in `sheet`.

The generalised coordinates q are the control points and, where they are free, the weights. With J = ds/dq, so that
s = J q, Lagrange's equations of Qin and Terzopoulos 1996 are

    M q'' + D q' + K q = f + g,    M = mu int J^T J,   D = gamma int J^T J,
    K = int a11 J_v^T J_v + a22 J_u^T J_u + b11 J_vv^T J_vv + b12 J_vu^T J_vu + b22 J_uu^T J_uu,

where f are the springs, and the integrals are sums over Gauss points. A step is implicit in the velocities, the
elastic forces and the springs. Ours: a natural shape, whose derivatives are taken off the sheet's own; g, the force
that comes from the change of J in time, is left out (it vanishes with frozen weights, and at rest); weak springs hold
free weights at 1, because a common factor of all weights changes nothing; and a step that would raise the energy or
make a weight negative starts anew at rest with half the time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import spsolve

from .sheet import BY_U, BY_UU, BY_V, BY_VU, BY_VV, STRAINS, VALUE, Material, Sheet, Springs, gauss, tensor

Pair = tuple[int, int]

_LIGHTEST = 0.05  # a weight may not fall below
_SHORTEST = 1e-6  # part of its time to which a step is shortened before the sheet counts as being at rest


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
class Motion:
    """A sheet on its way.

    Parameters
    ----------
    sheet : Sheet
        Now.
    velocity : ndarray, shape (q,)
        Of the coordinates.
    energy : float
        Elastic energy, springs and motion; never rises.
    moved : float
        Farthest way of a control point in the last step.
    n_iter : int
        Steps so far.
    converged : bool
        Whether the sheet has come to rest.
    """

    sheet: Sheet
    velocity: NDArray[np.float64]
    energy: float
    moved: float = float("inf")
    n_iter: int = 0
    converged: bool = False


def start(sheet: Sheet, setting: Setting, dynamics: Dynamics) -> Motion:
    """The motion of a sheet at its beginning, without speed.

    Parameters
    ----------
    sheet : Sheet
        Where it begins.
    setting : Setting
    dynamics : Dynamics

    Returns
    -------
    Motion
    """
    still = np.zeros(len(_coordinates(sheet, dynamics.free_weights)))
    return Motion(sheet, still, potential(sheet, setting, dynamics))


def relax(
    motion: Motion,
    setting: Setting,
    dynamics: Dynamics,
    *,
    tol: float = 1e-3,
    max_iter: int = 100,
    iter_callback: Callable[[Motion], None] | None = None,
) -> Motion:
    """Let a sheet go until it rests.

    Parameters
    ----------
    motion : Motion
        From `start`, or an earlier one to go on with.
    setting, dynamics
        What acts on it.
    tol : float
        Rest is when no control point moves farther than this in a step, nor would under the forces that are left: a
        heavy sheet is slow at first and where it turns back.
    max_iter : int
        Steps at most.
    iter_callback : callable, optional
        Called with the motion after each step, for drawing.

    Returns
    -------
    Motion
        `converged` says whether it came to rest.
    """
    for _ in range(max_iter):
        motion = step(motion, setting, dynamics)
        rests = motion.moved <= tol and (motion.moved == 0 or _left(motion.sheet, setting, dynamics) <= tol)
        motion = replace(motion, converged=rests)
        if iter_callback is not None:
            iter_callback(motion)
        if motion.converged:
            break
    return motion


def step(motion: Motion, setting: Setting, dynamics: Dynamics) -> Motion:
    """One step of the motion, shortened where it must be.

    Parameters
    ----------
    motion : Motion
    setting, dynamics
        What acts on it.

    Returns
    -------
    Motion
    """
    sheet, free = motion.sheet, dynamics.free_weights
    matter, elastic, force = _forces(sheet, setting, dynamics)
    q, velocity, dt = _coordinates(sheet, free), motion.velocity, dynamics.dt
    while dt > _SHORTEST * dynamics.dt:
        inertia = (dynamics.mass / dt**2 + dynamics.damping / dt) * matter
        push = force + (dynamics.mass / dt) * (matter @ velocity)
        change = spsolve(sparse.csc_array(inertia + elastic), push, permc_spec="MMD_AT_PLUS_A")
        new = _with_coordinates(sheet, q + change, free)
        if new.weights.min() > _LIGHTEST:
            speed = change / dt
            energy = potential(new, setting, dynamics) + dynamics.mass / 2 * float(speed @ (matter @ speed))
            if energy <= motion.energy * (1 + 1e-12):
                moved = float(np.linalg.norm(new.control - sheet.control, axis=-1).max())
                return Motion(new, speed, energy, moved, motion.n_iter + 1)
        velocity, dt = np.zeros_like(velocity), dt / 2
    return replace(motion, moved=0.0, n_iter=motion.n_iter + 1)


def _left(sheet: Sheet, setting: Setting, dynamics: Dynamics) -> float:
    """Farthest way of a control point to where elastic forces and springs are even."""
    _, elastic, force = _forces(sheet, setting, dynamics)
    change = spsolve(sparse.csc_array(elastic), force, permc_spec="MMD_AT_PLUS_A")
    even = _with_coordinates(sheet, _coordinates(sheet, dynamics.free_weights) + change, dynamics.free_weights)
    return float(np.linalg.norm(even.control - sheet.control, axis=-1).max())


def potential(sheet: Sheet, setting: Setting, dynamics: Dynamics) -> float:
    """Elastic energy of a sheet and of the springs.

    Parameters
    ----------
    sheet : Sheet
    setting : Setting
    dynamics : Dynamics

    Returns
    -------
    float
    """
    v, u, weight = _quadrature(sheet)
    shape, natural, springs = derivatives(sheet, v, u), derivatives(setting.natural, v, u), setting.springs
    elastic = sum(
        factor * float(weight @ ((shape[d] - natural[d]) ** 2).sum(axis=1))
        for factor, d in zip(setting.material.stiffness, STRAINS, strict=True)
    )
    pulled = float(springs.strength @ ((springs.points - sheet.at(springs.v, springs.u)) ** 2).sum(axis=1))
    held = dynamics.hold * float(((sheet.weights - 1) ** 2).sum()) if dynamics.free_weights else 0.0
    return (elastic + pulled + held) / 2


def derivatives(sheet: Sheet, v: NDArray[np.float64], u: NDArray[np.float64]) -> dict[Pair, NDArray[np.float64]]:
    """The surface and its derivatives up to the second.

    Parameters
    ----------
    sheet : Sheet
    v, u : ndarray, shape (k,)
        Parameters.

    Returns
    -------
    dict
        (times by v, times by u) -> ndarray, shape (k, 3).
    """
    points = sheet.control.reshape(-1, 3) * sheet.weights.reshape(-1, 1)
    return {d: part @ points for d, part in _quotients(sheet, v, u, tuple(_SHARES)).items()}


def jacobians(
    sheet: Sheet, v: NDArray[np.float64], u: NDArray[np.float64], free_weights: bool, *, strains: bool = True
) -> dict[Pair, sparse.csr_array]:
    """J, the surface by its coordinates q, and its derivatives along v and u.

    The coordinates q are all x of the control points, all y, all z, then all weights if those are free.

    Parameters
    ----------
    sheet : Sheet
    v, u : ndarray, shape (k,)
        Parameters.
    free_weights : bool
        Whether the weights are coordinates too.
    strains : bool
        Whether to give the derivatives too.

    Returns
    -------
    dict
        (times by v, times by u) -> sparse array, shape (3 k, q): rows of x, y, z one below the other.
    """
    quotients = _quotients(sheet, v, u, tuple(_SHARES) if strains else (VALUE,))
    weights, points = sheet.weights.ravel(), sheet.control.reshape(-1, 3)
    shape = {d: part @ (points * weights[:, None]) for d, part in quotients.items()}
    found = {}
    for d, part in quotients.items():
        by_point = sparse.block_diag([part @ sparse.diags_array(weights)] * 3, format="csr")
        if free_weights:
            by_weight = sparse.vstack([_by_weight(quotients, shape, points, d, axis) for axis in range(3)])
            by_point = sparse.hstack([by_point, by_weight], format="csr")
        found[d] = sparse.csr_array(by_point)
    return found


def _by_weight(
    quotients: dict[Pair, sparse.csr_array], shape: dict[Pair, NDArray], points: NDArray, d: Pair, axis: int
) -> sparse.csr_array:
    """A derivative of ds/dw_i = (p_i - s) Q_i along one axis, by the product rule, shape (k, n m)."""
    total = quotients[d] @ sparse.diags_array(points[:, axis])
    for (i, j), times in _SHARES[d].items():
        total = total - times * sparse.diags_array(shape[i, j][:, axis]) @ quotients[d[0] - i, d[1] - j]
    return sparse.csr_array(total)


_SHARES: dict[Pair, dict[Pair, int]] = {
    VALUE: {VALUE: 1},
    BY_V: {VALUE: 1, BY_V: 1},
    BY_U: {VALUE: 1, BY_U: 1},
    BY_VV: {VALUE: 1, BY_V: 2, BY_VV: 1},
    BY_VU: {VALUE: 1, BY_V: 1, BY_U: 1, BY_VU: 1},
    BY_UU: {VALUE: 1, BY_U: 2, BY_UU: 1},
}
"""Leibniz: a derivative of a product sums these derivatives of one factor, so often, with the rest of the other."""


def _quotients(sheet: Sheet, v: NDArray, u: NDArray, kinds: tuple[Pair, ...]) -> dict[Pair, sparse.csr_array]:
    """Q_i = B_i / W with W = sum w B, and its derivatives, shape (k, n m): from the product rule for B = Q W."""
    weights = sheet.weights.ravel()
    found: dict[Pair, sparse.csr_array] = {}
    products = {d: tensor(v, u, sheet.spans, d) for d in kinds}
    below = {d: part @ weights for d, part in products.items()}
    for d in kinds:
        total = products[d]
        for (i, j), times in _SHARES[d].items():
            if (i, j) != VALUE:
                total = total - times * sparse.diags_array(below[i, j]) @ found[d[0] - i, d[1] - j]
        found[d] = sparse.csr_array(sparse.diags_array(1 / below[VALUE]) @ total)
    return found


def _forces(
    sheet: Sheet, setting: Setting, dynamics: Dynamics
) -> tuple[sparse.csr_array, sparse.csr_array, NDArray[np.float64]]:
    """Integral of J^T J; the stiffness of the sheet and the springs; and the force of both at the sheet's place."""
    free, springs = dynamics.free_weights, setting.springs
    v, u, weight = _quadrature(sheet)
    parts = jacobians(sheet, v, u, free)
    shape, natural = derivatives(sheet, v, u), derivatives(setting.natural, v, u)
    pull = jacobians(sheet, springs.v, springs.u, free, strains=False)[VALUE]
    strength = np.tile(springs.strength, 3)
    elastic = pull.T @ sparse.diags_array(strength) @ pull
    force = pull.T @ (strength * (springs.points - sheet.at(springs.v, springs.u)).T.ravel())
    for factor, d in zip(setting.material.stiffness, STRAINS, strict=True):
        elastic = elastic + factor * _gram(parts[d], weight)
        force = force - factor * (parts[d].T @ (weight * (shape[d] - natural[d]).T).ravel())
    if free:
        held = np.repeat([0.0, dynamics.hold], [3 * sheet.weights.size, sheet.weights.size])
        force = force - held * (_coordinates(sheet, True) - 1)
        elastic = elastic + sparse.diags_array(held)
    return _gram(parts[VALUE], weight), sparse.csr_array(elastic), force


def _gram(part: sparse.csr_array, weight: NDArray) -> sparse.csr_array:
    return sparse.csr_array(part.T @ sparse.diags_array(np.tile(weight, 3)) @ part)


def _quadrature(sheet: Sheet) -> tuple[NDArray, NDArray, NDArray]:
    """Gauss points of all spans and their weights, shape (k,) each."""
    (v, by_v), (u, by_u) = (gauss(n) for n in sheet.spans)
    return np.repeat(v, len(u)), np.tile(u, len(v)), np.outer(by_v, by_u).ravel()


def _coordinates(sheet: Sheet, free_weights: bool) -> NDArray[np.float64]:
    """All x, all y, all z of the control points, then the weights if they are free."""
    points = sheet.control.reshape(-1, 3).T.ravel()
    return np.concatenate([points, sheet.weights.ravel()]) if free_weights else points


def _with_coordinates(sheet: Sheet, q: NDArray, free_weights: bool) -> Sheet:
    n = sheet.weights.size
    control = q[: 3 * n].reshape(3, n).T.reshape(sheet.control.shape)
    return Sheet(control, q[3 * n :].reshape(sheet.weights.shape) if free_weights else sheet.weights)
