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

from ...geometry.band import band_solver, band_times
from .sheet import Sheet
from .sheet_energy import Dynamics, Quadrature, Setting, potential, quadrature
from .sheet_forces import Forces, by_kind, by_point, forces

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
    acting = forces(motion.sheet, setting, dynamics, sums)
    while True:
        motion = _step(motion, acting, setting, dynamics, sums)
        acting = forces(motion.sheet, setting, dynamics, sums)
        rests = motion.moved <= tol and (motion.moved == 0 or _left(motion.sheet, acting, dynamics) <= tol)
        motion = replace(motion, converged=rests)
        yield motion


def _moving_frozen(motion: Motion, setting: Setting, dynamics: Dynamics, tol: float) -> Iterator[Motion]:
    """The motion after each step, weights frozen: a swing about the place of rest, which is known."""
    sums, dt, sheet = quadrature(setting), dynamics.dt, motion.sheet
    acting = forces(sheet, setting, dynamics, sums)
    q, velocity = sheet.control.reshape(-1, 3), by_point(motion.velocity, free_weights=False)
    # the place of rest and its energy
    rest = q + band_solver(acting.elastic)(acting.force)
    least = potential(Sheet(rest.reshape(sheet.control.shape), sheet.weights), setting, dynamics, sums)
    # (M / dt^2 + D / dt + K) dq = K (q* - q) + M q' / dt, one matrix for all steps
    inertia = (dynamics.mass / dt**2 + dynamics.damping / dt) * acting.matter
    solve = band_solver(inertia + acting.elastic)
    for n_iter in count(motion.n_iter + 1):
        push = band_times(acting.elastic, rest - q) + _momentum(velocity, acting, dynamics) / dt
        change = solve(push)
        q, velocity, away = q + change, change / dt, rest - q - change
        twice = away * band_times(acting.elastic, away) + velocity * _momentum(velocity, acting, dynamics)
        energy = least + float(np.sum(twice)) / 2
        moved, left = (float(np.linalg.norm(way, axis=1).max()) for way in (change, away))
        now = Sheet(q.reshape(sheet.control.shape), sheet.weights)
        yield Motion(now, velocity.T.ravel(), energy, moved, n_iter, converged=max(moved, left) <= tol)


def _step(motion: Motion, acting: Forces, setting: Setting, dynamics: Dynamics, sums: Quadrature) -> Motion:
    """One step of the motion under the forces at its place, shortened where it must be."""
    sheet, free = motion.sheet, dynamics.free_weights
    q, velocity, dt = _coordinates(sheet, free), by_point(motion.velocity, free_weights=free), dynamics.dt
    while dt > _SHORTEST * dynamics.dt:
        # (M / dt^2 + D / dt + K) dq = f + M q' / dt
        inertia = (dynamics.mass / dt**2 + dynamics.damping / dt) * acting.matter
        push = acting.force + _momentum(velocity, acting, dynamics) / dt
        change = band_solver(inertia + acting.elastic)(push)
        new = _with_coordinates(sheet, q + by_kind(change, free_weights=free), free)
        # nan where nothing holds the sheet: no step either
        if new.weights.min() > _LIGHTEST:
            speed = change / dt
            motion_energy = float(np.sum(speed * _momentum(speed, acting, dynamics))) / 2
            energy = potential(new, setting, dynamics, sums) + motion_energy
            if energy <= motion.energy * (1 + 1e-12):
                moved = float(np.linalg.norm(new.control - sheet.control, axis=-1).max())
                return Motion(new, by_kind(speed, free_weights=free), energy, moved, motion.n_iter + 1)
        # too far: from rest again with half the time
        velocity, dt = np.zeros_like(velocity), dt / 2
    return replace(motion, moved=0.0, n_iter=motion.n_iter + 1)


def _momentum(velocity: NDArray[np.float64], acting: Forces, dynamics: Dynamics) -> NDArray[np.float64]:
    """M q', without the cost of it where there is no mass."""
    return dynamics.mass * band_times(acting.matter, velocity) if dynamics.mass else np.zeros_like(velocity)


def _left(sheet: Sheet, acting: Forces, dynamics: Dynamics) -> float:
    """Farthest way of a control point to where elastic forces and springs are even."""
    free = dynamics.free_weights
    change = by_kind(band_solver(acting.elastic)(acting.force), free_weights=free)
    even = _with_coordinates(sheet, _coordinates(sheet, free) + change, free)
    return float(np.linalg.norm(even.control - sheet.control, axis=-1).max())


def _coordinates(sheet: Sheet, free_weights: bool) -> NDArray[np.float64]:
    """All x, all y, all z of the control points, then the weights if they are free."""
    points = sheet.control.reshape(-1, 3).T.ravel()
    return np.concatenate([points, sheet.weights.ravel()]) if free_weights else points


def _with_coordinates(sheet: Sheet, q: NDArray, free_weights: bool) -> Sheet:
    n = sheet.weights.size
    control = q[: 3 * n].reshape(3, n).T.reshape(sheet.control.shape)
    return Sheet(control, q[3 * n :].reshape(sheet.weights.shape) if free_weights else sheet.weights)
