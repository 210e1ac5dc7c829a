"""One balloon of lesson 04 with all its steps, for the panel that shows any of them.

Frame: chord (along, out) px.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...curves import Points, arc_length, cubic, spiral
from ...stages import deformable_model as stage

PRESETS = ("paper: k as set below", "tangent pressure: k from the ends", "spiral: k along its curve")
MAX_STEPS = 300


@dataclass(frozen=True, eq=False)
class Inflation:
    """All steps of one balloon.

    Parameters
    ----------
    curves : ndarray, shape (T + 1, n, 2)
        Start curve and the curve after each step, chord px.
    change : ndarray, shape (T,)
        ||c(t + dt) - c(t)|| of each step, px.
    energy : ndarray, shape (T + 1,)
        Elastic energy w1/2 sum |c'|^2 + w2/2 sum |c''|^2 per snaxel index, px^2.
    pressure : ndarray, shape (n,)
        k at each snaxel.
    converged : bool
    """

    curves: Points
    change: NDArray[np.float64]
    energy: NDArray[np.float64]
    pressure: NDArray[np.float64]
    converged: bool


def record_inflation(
    length: float,
    angles: tuple[float, float],
    preset: str,
    pressure: float,
    n: int,
    tension: float,
    rigidity: float,
    dt: float,
    tol: float,
) -> Inflation:
    """Run a balloon and keep all its steps, at most `MAX_STEPS`.

    Parameters
    ----------
    length : float
        Of the gap, px.
    angles : tuple of float
        theta0 and theta1, rad.
    preset : str
        One of `PRESETS`.
    pressure : float
        k, px per index squared, where the preset leaves it open.
    n : int
        Snaxels.
    tension, rigidity, dt, tol : float
        As for `deformable_model.inflate`.

    Returns
    -------
    Inflation
    """
    # the stage reports each step; kept here, the slider can show any of them
    start, slopes, push = _initial(length, angles, preset, pressure, n)
    curves, change = [start], []

    def keep(step: int, curve: Points, moved: NDArray) -> None:
        curves.append(curve)
        change.append(float(moved))

    scheme = {"tension": tension, "rigidity": rigidity, "dt": dt, "tol": tol}
    result = stage.inflate(start, slopes, pressure=push, max_iter=MAX_STEPS, iter_callback=keep, **scheme)
    stack = np.array(curves)
    energy = elastic_energy(stack, tension, rigidity)
    return Inflation(stack, np.array(change), energy, np.broadcast_to(push, (n,)), bool(result.converged))


def elastic_energy(curves: Points, tension: float = 1.0, rigidity: float = 1.0) -> NDArray[np.float64]:
    """What curves hold by being stretched and bent, by differences per index.

    Parameters
    ----------
    curves : ndarray, shape (T, n, 2)
        Chord px.
    tension, rigidity : float
        w1 and w2.

    Returns
    -------
    ndarray, shape (T,)
        px^2.

    Examples
    --------
    A straight chord of length L holds L^2 / 2 N:

    >>> elastic_energy(np.stack([np.linspace(0, 60, 21), np.zeros(21)], axis=1)[None]).round(9).tolist()
    [90.0]
    """
    stretched, bent = ((np.diff(curves, order, axis=1) ** 2).sum(axis=(1, 2)) for order in (1, 2))
    return np.asarray((tension * stretched + rigidity * bent) / 2)


def _initial(
    length: float, angles: tuple[float, float], preset: str, pressure: float, n: int
) -> tuple[Points, Points, NDArray[np.float64]]:
    """Start curve, shape (n, 2), its end slopes per index, shape (2, 2), and the pressure."""
    # an Euler spiral, and at each snaxel the k that holds its curvature
    if preset == PRESETS[2]:
        start, curvature = spiral(length, *angles, n)
        along = arc_length(start)[-1]
        heads = np.array([[np.cos(t), np.sin(t)] for t in (angles[0], angles[1] - np.pi)])
        return start, heads * along / (n - 1), stage.curvature_pressure(along, curvature)
    # the paper's cubic: one k by hand, or the one that agrees with the end slopes
    push = stage.tangent_pressure(length, *angles, n) if preset == PRESETS[1] else np.asarray(pressure)
    slopes = np.array([[1.0, np.tan(t)] for t in angles]) * length / (n - 1)
    return cubic(length, *angles, n), slopes, push
