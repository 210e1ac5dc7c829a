"""Stage 3, deformable model: the ends of a gap come in -> the boundary curve of the prosthesis across it goes out.

Frame: chord (along, out); lengths in px. The curves of all slices are relaxed in batches that fit a processor's cache.
Source: VISAPP 2011, sections 2 and 3, eqs. (1) to (3), after Cohen 1991.

Eq. (1) is the balloon: an open curve with tension w1 and rigidity w2, pushed by a pressure k along its normal n,

    dc/dt - (w1 c')' + (w2 c'')'' = k n(c),

and eq. (2) fixes its ends in position and slope; eq. (3) is the start curve, `curves.cubic`. The paper sets w1 = ds^2
and w2 = ds^4. Written per snaxel index the step ds cancels, and both weights are 1.

What the pressure does: away from the ends the curve bends until tension balances pressure, c'' = -k per index squared.
Its apex then lies k N^2 / 8 px above the chord, however wide the gap is: the paper's k fits one width only.
`tangent_pressure` and `curvature_pressure` make k follow from the ends instead.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import count, islice

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..curves import Balloon, Points

PAPER_PRESSURE = 0.062
"""Size of k in the paper, px per index squared, outward (section 3; the paper's own sign is negative)."""
_CURVES_AT_A_TIME = 64  # of 41 snaxels they take 40 kB


def tangent_pressure(length: ArrayLike, theta0: ArrayLike, theta1: ArrayLike, n: int) -> NDArray[np.float64]:
    """The pressure that agrees with the slopes at the two ends.

    Parameters
    ----------
    length : array_like, shape (...)
        Gap length L, px.
    theta0, theta1 : array_like, shape (...)
        Angles of the end tangents above the chord, radians: theta0 acute, theta1 obtuse for an outward bulge.
    n : int
        Number of snaxels; N = n - 1.

    Returns
    -------
    ndarray of float, shape (...)
        k, px per index squared, outward positive.

    Notes
    -----
    k = L (tan theta0 - tan theta1) / N^2: the parabola of curvature k per index squared has the end slopes
    +- k N^2 / (2 L).

    Examples
    --------
    The apex of that parabola, k N^2 / 8, is L tan(theta0) / 4:

    >>> k = tangent_pressure(40.0, 0.1, np.pi - 0.1, n=21)
    >>> bool(np.isclose(k * 20**2 / 8, 40 * np.tan(0.1) / 4))
    True
    """
    return np.asarray(length) * (np.tan(theta0) - np.tan(theta1)) / (n - 1) ** 2


def curvature_pressure(length: NDArray, curvature: NDArray[np.float64]) -> NDArray[np.float64]:
    """The pressure at each snaxel that holds a curve of given curvature.

    Parameters
    ----------
    length : ndarray, shape (...)
        Length of the curve (not of the chord), px.
    curvature : ndarray, shape (..., n)
        1 / px, outward positive.

    Returns
    -------
    ndarray of float, shape (..., n)
        k = h^2 curvature, px per index squared, with h the distance between snaxels.

    Examples
    --------
    21 snaxels 2 px apart on a circle of 50 px: k = 2^2 / 50.

    >>> curvature_pressure(np.array(40.0), np.full(21, 1 / 50))[:2].round(9)
    array([0.08, 0.08])
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
    max_moves: float = np.inf,
    iter_callback: Callable[[int, Points, NDArray], None] | None = None,
) -> Balloon:
    """Relax a batch of balloons.

    Parameters
    ----------
    start : ndarray, shape (..., n, 2)
        Initial snaxels, chord px. The first and the last stay where they are.
    end_slopes : ndarray, shape (..., 2, 2)
        Derivative of the curve at its first and last snaxel, px per index.
    pressure : array_like, shape () or (...) or (..., n)
        k, px per index squared, outward positive.
    tension : float
        w1 in units of ds^2, at least 0; the paper: 1.
    rigidity : float
        w2 in units of ds^4, at least 0; the paper: 1.
    dt : float
        Time step in units of the model's own time. The paper gives none.
    tol : float
        A curve stops when ||c(t + dt) - c(t)|| <= tol, px, the norm over all its snaxels; the paper: 1e-3.
    max_iter : int
        At most so many steps; `Balloon.converged` says whether they were enough.
    max_moves : float
        After so many steps of single snaxels, those of all curves that still moved added up, none goes on.
    iter_callback : callable, optional
        Called after each step with (step, curves (..., n, 2), change (...) in px).

    Returns
    -------
    Balloon
        Final and initial curves, the steps of each and whether it converged.

    Notes
    -----
    Eq. (1) by semi-implicit finite differences (Cohen 1991):

        (I + dt A) c(t + dt) = c(t) + dt (k n(c(t)) + b),

    with A the sum of second and fourth differences and b what the fixed ends of eq. (2) add, by ghost nodes
    c(-1) = c(1) - 2 c'(0). A is the same for every curve, and I + dt A is inverted once: its eigenvalues lie between 1
    and 1 + dt (4 w1 + 16 w2), so that the inverse is exact to rounding, and a step takes a third of the time of a
    banded solution.

    Examples
    --------
    Tension alone against the pressure gives a parabola, whose apex is k N^2 / 8 = 0.5 px:

    >>> start = np.stack([np.linspace(0, 100, 21), np.zeros(21)], axis=1)
    >>> made = inflate(start, np.zeros((2, 2)), pressure=0.01, rigidity=0.0, tol=1e-9)
    >>> bool(made.converged), float(made.curve[10, 1].round(3))
    (True, 0.5)
    """
    # one row for each curve, whatever the shape of the batch; a coordinate after the other in memory
    shape, n = start.shape[:-2], start.shape[-2]
    curves = np.moveaxis(start.reshape(-1, n, 2).astype(float), 2, 1).copy()
    slopes = np.moveaxis(np.broadcast_to(end_slopes, (*shape, 2, 2)).reshape(-1, 2, 2), 2, 1)
    k = _pressure_rows(pressure, shape, n)[:, None, 1:-1]

    # eq. (1): the matrix that takes a step, and the force of the fixed ends, eq. (2); both never change
    step_matrix = _step_matrix(n - 2, tension, rigidity, dt)
    fixed = _end_forces(curves, slopes, tension, rigidity)

    def done(step: int, moved: NDArray[np.float64]) -> None:
        if iter_callback is not None:
            iter_callback(step, np.moveaxis(curves, 1, 2).reshape(start.shape).copy(), moved.reshape(shape))

    # a part of the curves at a time, which stays in the processor's cache; who watches sees all of them
    n_iter, at_rest = np.zeros(len(curves), np.intp), np.zeros(len(curves), bool)
    size = _CURVES_AT_A_TIME if iter_callback is None else max(len(curves), 1)
    for first in range(0, len(curves), size):
        part = slice(first, first + size)
        relaxing = _relaxed(curves[part], k[part], fixed[part], step_matrix, dt=dt, tol=tol)
        moves_left = max_moves * len(curves[part]) / len(curves)  # each part has its share
        for step, moving, moved in islice(relaxing, max_iter):
            n_iter[part][moving] = step
            at_rest[part] = moved <= tol
            done(step, moved)
            moves_left -= n * np.count_nonzero(moving)
            if moves_left <= 0:
                break
    curve = np.moveaxis(curves, 1, 2).reshape(start.shape)
    return Balloon(curve, start, n_iter.reshape(shape), at_rest.reshape(shape))


def _relaxed(
    curves: NDArray[np.float64],
    k: NDArray[np.float64],
    fixed: NDArray[np.float64],
    step_matrix: NDArray[np.float64],
    *,
    dt: float,
    tol: float,
) -> Iterator[tuple[int, NDArray[np.bool_], NDArray[np.float64]]]:
    """Move curves (B, 2, n) in place, step by step, until all rest.

    Yields the step, which curves it moved, and by how much each (B,); a curve that has come to rest stays as it is.
    """
    moving = np.ones(len(curves), bool)
    for step in count(1):
        now = curves[moving]
        # the normal is the tangent turned by a quarter: central differences along the index
        tangent = (now[:, :, 2:] - now[:, :, :-2]) / 2
        push = k[moving] / np.maximum(np.sqrt(tangent[:, :1] ** 2 + tangent[:, 1:] ** 2), 1e-12)
        force = fixed[moving] + push * np.concatenate([-tangent[:, 1:], tangent[:, :1]], axis=1)
        # eq. (1): the pressure of now, the curve's own forces of the next step
        free = now[:, :, 1:-1]
        new = (free + dt * force).reshape(-1, free.shape[2]) @ step_matrix
        change = new.reshape(free.shape) - free
        moved = np.zeros(len(curves))
        moved[moving] = np.sqrt((change**2).sum(axis=(1, 2)))
        curves[moving, :, 1:-1] = new.reshape(free.shape)
        yield step, moving, moved
        moving = moving & (moved > tol)
        if not moving.any():
            return


def _pressure_rows(pressure: ArrayLike, shape: tuple[int, ...], n: int) -> NDArray[np.float64]:
    """The pressure at each snaxel of each curve, shape (B, n): one for all, one a curve, or one a snaxel."""
    k = np.asarray(pressure, float)
    k = k.reshape(-1, n) if k.ndim > len(shape) else np.broadcast_to(k, shape).reshape(-1, 1)
    return np.broadcast_to(k, (int(np.prod(shape)), n))


def _step_matrix(n_free: int, tension: float, rigidity: float, dt: float) -> NDArray[np.float64]:
    """(I + dt A)^-1 between the free snaxels, with A: w1 (-1 2 -1) + w2 (1 -4 6 -4 1)."""
    second = 2 * np.eye(n_free) - np.eye(n_free, k=1) - np.eye(n_free, k=-1)
    fourth = second @ second
    fourth[[0, -1], [0, -1]] += 2  # the ghost node mirrors the first free one
    return np.asarray(np.linalg.inv(np.eye(n_free) + dt * (tension * second + rigidity * fourth)))


def _end_forces(curves: NDArray, slopes: NDArray, tension: float, rigidity: float) -> NDArray[np.float64]:
    """b: what the fixed snaxels and the ghost nodes beyond them add to their two neighbours, shape (B, 2, n - 2)."""
    first, last = curves[:, :, 0], curves[:, :, -1]
    fixed = np.zeros((*curves.shape[:2], curves.shape[2] - 2))
    fixed[:, :, 0] += (tension + 4 * rigidity) * first + 2 * rigidity * slopes[:, :, 0]
    fixed[:, :, -1] += (tension + 4 * rigidity) * last - 2 * rigidity * slopes[:, :, 1]
    fixed[:, :, 1] -= rigidity * first
    fixed[:, :, -2] -= rigidity * last
    return fixed
