"""Stage 3, the deformable model: gap ends come in -> the boundary curve of the prosthesis across the gap goes out.

Frame: chord (along, out) px; all curves of all slices are relaxed together as one batch.

The balloon of the paper's eq. (1), after Cohen 1991: an open curve with tension and rigidity, clamped in position and
slope at both ends, inflated by a pressure k along its normal. Written per snaxel index, with w1 = ds^2 and w2 = ds^4
as in the paper's section 3, the step ds cancels, and the weights below are 1.

What the pressure does: away from the ends the curve bends until tension balances pressure, c'' = -k per index squared,
so it settles on an apex of k N^2 / 8 pixels whatever the gap's width. The paper's k therefore fits one width only;
`tangent_pressure` and `spiral` curvature make k follow from the ends.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import cho_solve_banded, cholesky_banded

from ..curves import Points, normals

PAPER_PRESSURE = 0.062
"""|k| of the paper, px per index squared, outward (section 3; the paper's own sign is negative)."""


@dataclass(frozen=True, eq=False)
class Balloon:
    """Relaxed curves, with how they got there.

    Parameters
    ----------
    curve, start : ndarray, shape (..., n, 2)
        Final and initial snaxels, chord (along, out) px.
    n_iter : ndarray of int, shape (...)
        Steps until the curve stopped moving.
    converged : ndarray of bool, shape (...)
        Whether it stopped moving within the allowed steps.
    """

    curve: Points
    start: Points
    n_iter: NDArray[np.intp]
    converged: NDArray[np.bool_]


def tangent_pressure(length: ArrayLike, theta0: ArrayLike, theta1: ArrayLike, n: int) -> NDArray[np.float64]:
    """The pressure that agrees with the end slopes: k = L (tan theta0 - tan theta1) / N^2.

    Parameters
    ----------
    length : array_like
        Gap length L, px.
    theta0, theta1 : array_like
        End angles, radians.
    n : int
        Number of snaxels; N = n - 1.

    Notes
    -----
    The parabola of curvature k per index squared has end slopes +- k N^2 / (2 L).
    """
    return np.asarray(length) * (np.tan(theta0) - np.tan(theta1)) / (n - 1) ** 2


def curvature_pressure(length: NDArray, curvature: NDArray[np.float64]) -> NDArray[np.float64]:
    """The pressure of each snaxel that holds a curve of given curvature: k = h^2 curvature, h the snaxel spacing.

    Parameters
    ----------
    length : ndarray, shape (...)
        Length of the curve, px.
    curvature : ndarray, shape (..., n)
        1 / px, outward positive.
    """
    step = np.asarray(length)[..., None] / (curvature.shape[-1] - 1)
    return step**2 * curvature


def inflate(
    start: Points,
    end_slopes: Points,
    *,
    pressure: ArrayLike = PAPER_PRESSURE,
    tension: float = 1.0,
    rigidity: float = 1.0,
    dt: float = 1.0,
    tol: float = 1e-3,
    max_iter: int = 2000,
    iter_callback: Callable[[int, Points, NDArray], None] | None = None,
) -> Balloon:
    """Relax a batch of balloons.

    Parameters
    ----------
    start : ndarray, shape (..., n, 2)
        Initial snaxels, chord px; the first and last stay where they are.
    end_slopes : ndarray, shape (..., 2, 2)
        Derivative of the curve per snaxel index at its first and last snaxel, px.
    pressure : array_like, shape () or (...) or (..., n)
        k, px per index squared, positive = outward.
    tension, rigidity : float
        w1 and w2 in units of ds^2 and ds^4.
    dt : float
        Time step. The paper gives none.
    tol : float
        Stop when ||c(t + dt) - c(t)|| <= tol, the norm over all snaxels of a curve, px.
    max_iter : int
        Give up after so many steps; the result says so.
    iter_callback : callable, optional
        Called after each step with (step, curves, change).

    Returns
    -------
    Balloon

    Notes
    -----
    Semi-implicit finite differences (Cohen 1991): (I + dt A) c(t + dt) = c(t) + dt (k n(c(t)) + b), with A the sum of
    second and fourth differences, clamped ends by ghost nodes c(-1) = c(1) - 2 c'(0), and b what the fixed ends add.
    A is symmetric, pentadiagonal and the same for every curve: factored once.
    """
    shape = start.shape[:-2]
    curve = start.reshape(-1, *start.shape[-2:]).astype(float)
    slopes = np.broadcast_to(end_slopes, (*shape, 2, 2)).reshape(-1, 2, 2)
    n = curve.shape[1]
    k = np.asarray(pressure, float)
    k = k.reshape(-1, n) if k.ndim > len(shape) else np.broadcast_to(k, shape).reshape(-1, 1)
    k = np.broadcast_to(k, (len(curve), n))[:, 1:-1, None]
    factor, fixed = _clamped_system(curve, slopes, tension, rigidity, dt)
    n_iter = np.zeros(len(curve), np.intp)
    moving = np.ones(len(curve), bool)
    for step in range(1, max_iter + 1):
        inner = curve[moving, 1:-1] + dt * (k[moving] * normals(curve[moving])[:, 1:-1] + fixed[moving])
        solved = cho_solve_banded((factor, True), inner.transpose(1, 0, 2).reshape(n - 2, -1))
        new = solved.reshape(n - 2, -1, 2).transpose(1, 0, 2)
        change = np.zeros(len(curve))
        change[moving] = np.sqrt(((new - curve[moving, 1:-1]) ** 2).sum(axis=(1, 2)))
        curve[moving, 1:-1] = new
        n_iter[moving] = step
        moving = moving & (change > tol)
        if iter_callback is not None:
            iter_callback(step, curve.reshape(start.shape).copy(), change.reshape(shape))
        if not moving.any():
            break
    return Balloon(curve.reshape(start.shape), start, n_iter.reshape(shape), ~moving.reshape(shape))


def _clamped_system(
    curve: Points, slopes: Points, tension: float, rigidity: float, dt: float
) -> tuple[NDArray, NDArray]:
    """Cholesky factor of I + dt A (lower bands), and the force b (B, n - 2, 2) of the clamped ends."""
    n = curve.shape[1]
    bands = np.zeros((3, n - 2))
    bands[0] = 2 * tension + 6 * rigidity
    bands[0, [0, -1]] += rigidity  # the ghost node mirrors the first free one
    bands[1] = -tension - 4 * rigidity
    bands[2] = rigidity
    bands *= dt
    bands[0] += 1
    first, last = curve[:, 0], curve[:, -1]
    fixed = np.zeros((len(curve), n - 2, 2))
    fixed[:, 0] += (tension + 4 * rigidity) * first + 2 * rigidity * slopes[:, 0]
    fixed[:, -1] += (tension + 4 * rigidity) * last - 2 * rigidity * slopes[:, 1]
    fixed[:, 1] -= rigidity * first
    fixed[:, -2] -= rigidity * last
    return cholesky_banded(bands, lower=True), fixed
