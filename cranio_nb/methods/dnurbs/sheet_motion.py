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

With frozen weights J is constant, so the place of rest q* is known at once, and with it all that follows:

    f(q) = K (q* - q),    E(q) = E(q*) + 1/2 (q - q*) K (q - q*).

Then the matrix of a step is factorised once, and no step raises the energy: implicit steps never do where it is
quadratic.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import count, islice

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu, spsolve

from .sheet import STRAINS, VALUE, Sheet, scale_rows
from .sheet_derivatives import derivatives, jacobians, rational_basis, scale_columns
from .sheet_energy import Dynamics, Quadrature, Setting, potential, quadrature, stretched

_LIGHTEST = 0.05  # a weight may not fall below
_SHORTEST = 1e-6  # part of its time to which a step is shortened before the sheet counts as being at rest


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


@dataclass(frozen=True, eq=False)
class _Forces:
    """What acts on a sheet at its place: the integral of J^T J, the stiffness of sheet and springs, and their force."""

    matter: sparse.csr_array
    elastic: sparse.csr_array
    force: NDArray[np.float64]


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
    return Motion(sheet, still, potential(sheet, setting, dynamics, quadrature(setting)))


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
    moving = _moving if dynamics.free_weights else _moving_frozen
    now = motion
    for now in islice(moving(motion, setting, dynamics, tol), max_iter):
        if iter_callback is not None:
            iter_callback(now)
        if now.converged:
            break
    return now


def _moving(motion: Motion, setting: Setting, dynamics: Dynamics, tol: float) -> Iterator[Motion]:
    """The motion after each step."""
    sums = quadrature(setting)
    forces = _forces(motion.sheet, setting, dynamics, sums)
    while True:
        motion = _step(motion, forces, setting, dynamics, sums)
        forces = _forces(motion.sheet, setting, dynamics, sums)
        rests = motion.moved <= tol and (motion.moved == 0 or _left(motion.sheet, forces, dynamics) <= tol)
        motion = replace(motion, converged=rests)
        yield motion


def _moving_frozen(motion: Motion, setting: Setting, dynamics: Dynamics, tol: float) -> Iterator[Motion]:
    """The motion after each step, weights frozen: a swing about the place of rest, which is known."""
    sums, dt, sheet = quadrature(setting), dynamics.dt, motion.sheet
    matter, elastic, pulled = _frozen(sheet.weights, setting, sums)
    q, velocity = sheet.control.reshape(-1, 3), motion.velocity.reshape(3, -1).T
    # the place of rest and its energy
    rest = spsolve(elastic, pulled, permc_spec="MMD_AT_PLUS_A")
    least = potential(Sheet(rest.reshape(sheet.control.shape), sheet.weights), setting, dynamics, sums)
    # (M / dt^2 + D / dt + K) dq = K (q* - q) + M q' / dt, one matrix for all steps
    inertia = (dynamics.mass / dt**2 + dynamics.damping / dt) * matter
    factors = splu(sparse.csc_array(inertia + elastic), permc_spec="MMD_AT_PLUS_A")
    for n_iter in count(motion.n_iter + 1):
        change = factors.solve(elastic @ (rest - q) + dynamics.mass / dt * (matter @ velocity))
        q, velocity, away = q + change, change / dt, rest - q - change
        energy = (
            least + float(np.sum(away * (elastic @ away)) + dynamics.mass * np.sum(velocity * (matter @ velocity))) / 2
        )
        moved, left = (float(np.linalg.norm(way, axis=1).max()) for way in (change, away))
        now = Sheet(q.reshape(sheet.control.shape), sheet.weights)
        yield Motion(now, velocity.T.ravel(), energy, moved, n_iter, converged=max(moved, left) <= tol)


def _frozen(
    weights: NDArray[np.float64], setting: Setting, sums: Quadrature
) -> tuple[sparse.csc_array, sparse.csc_array, NDArray[np.float64]]:
    """Of one coordinate, the same for x, y and z: the integral of J^T J, and K; and K q*, shape (n m, 3)."""
    parts, at_springs = (rational_basis(weights, products) for products in (sums.splines, sums.at_springs))
    by_point = {d: scale_columns(part, weights.ravel()) for d, part in parts.items()}
    # the springs, then the sheet itself against its natural shape
    pull = scale_columns(at_springs[VALUE], weights.ravel())
    held = scale_rows(pull, setting.springs.strength).T
    elastic, pulled = held @ pull, held @ setting.springs.points
    for factor, d in zip(setting.material.stiffness, STRAINS, strict=True):
        bent = scale_rows(by_point[d], factor * sums.weight).T
        elastic, pulled = elastic + bent @ by_point[d], pulled + bent @ sums.natural[d]
    matter = scale_rows(by_point[VALUE], sums.weight).T @ by_point[VALUE]
    return sparse.csc_array(matter), sparse.csc_array(elastic), pulled


def _step(motion: Motion, forces: _Forces, setting: Setting, dynamics: Dynamics, sums: Quadrature) -> Motion:
    """One step of the motion under the forces at its place, shortened where it must be."""
    sheet, free = motion.sheet, dynamics.free_weights
    q, velocity, dt = _coordinates(sheet, free), motion.velocity, dynamics.dt
    while dt > _SHORTEST * dynamics.dt:
        # (M / dt^2 + D / dt + K) dq = f + M q' / dt
        inertia = (dynamics.mass / dt**2 + dynamics.damping / dt) * forces.matter
        push = forces.force + (dynamics.mass / dt) * (forces.matter @ velocity)
        change = spsolve(sparse.csc_array(inertia + forces.elastic), push, permc_spec="MMD_AT_PLUS_A")
        new = _with_coordinates(sheet, q + change, free)
        if new.weights.min() > _LIGHTEST:
            speed = change / dt
            motion_energy = dynamics.mass / 2 * float(speed @ (forces.matter @ speed))
            energy = potential(new, setting, dynamics, sums) + motion_energy
            if energy <= motion.energy * (1 + 1e-12):
                moved = float(np.linalg.norm(new.control - sheet.control, axis=-1).max())
                return Motion(new, speed, energy, moved, motion.n_iter + 1)
        # too far: from rest again with half the time
        velocity, dt = np.zeros_like(velocity), dt / 2
    return replace(motion, moved=0.0, n_iter=motion.n_iter + 1)


def _left(sheet: Sheet, forces: _Forces, dynamics: Dynamics) -> float:
    """Farthest way of a control point to where elastic forces and springs are even."""
    change = spsolve(sparse.csc_array(forces.elastic), forces.force, permc_spec="MMD_AT_PLUS_A")
    even = _with_coordinates(sheet, _coordinates(sheet, dynamics.free_weights) + change, dynamics.free_weights)
    return float(np.linalg.norm(even.control - sheet.control, axis=-1).max())


def _forces(sheet: Sheet, setting: Setting, dynamics: Dynamics, sums: Quadrature) -> _Forces:
    """Inertia, stiffness and force of a sheet and its springs at the sheet's place."""
    free, springs = dynamics.free_weights, setting.springs
    # the springs
    at_springs = rational_basis(sheet.weights, sums.at_springs)
    pull = jacobians(sheet, at_springs, free_weights=free)[VALUE]
    strength = np.tile(springs.strength, 3)
    elastic = pull.T @ scale_rows(pull, strength)
    force = pull.T @ (strength * stretched(sheet, springs, sums).T.ravel())
    # the sheet itself, against its natural shape
    basis = rational_basis(sheet.weights, sums.splines)
    parts, shape = jacobians(sheet, basis, free_weights=free), derivatives(sheet, basis)
    for factor, d in zip(setting.material.stiffness, STRAINS, strict=True):
        elastic = elastic + factor * _gram(parts[d], sums.weight)
        force = force - factor * (parts[d].T @ (sums.weight * (shape[d] - sums.natural[d]).T).ravel())
    # what holds free weights at 1
    if free:
        held = np.repeat([0.0, dynamics.hold], [3 * sheet.weights.size, sheet.weights.size])
        force = force - held * (_coordinates(sheet, True) - 1)
        elastic = elastic + sparse.diags_array(held)
    return _Forces(_gram(parts[VALUE], sums.weight), sparse.csr_array(elastic), force)


def _gram(part: sparse.csr_array, weight: NDArray) -> sparse.csr_array:
    return sparse.csr_array(part.T @ scale_rows(part, np.tile(weight, 3)))


def _coordinates(sheet: Sheet, free_weights: bool) -> NDArray[np.float64]:
    """All x, all y, all z of the control points, then the weights if they are free."""
    points = sheet.control.reshape(-1, 3).T.ravel()
    return np.concatenate([points, sheet.weights.ravel()]) if free_weights else points


def _with_coordinates(sheet: Sheet, q: NDArray, free_weights: bool) -> Sheet:
    n = sheet.weights.size
    control = q[: 3 * n].reshape(3, n).T.reshape(sheet.control.shape)
    return Sheet(control, q[3 * n :].reshape(sheet.weights.shape) if free_weights else sheet.weights)
