"""Gap ends of many slices come in -> their balloons at rest go out; slices without one follow their neighbours.

Frame: slice (row, col), in the unit of the slices (px or mm).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...curves import ChordFrame, Points, cubic, spiral
from ...stages import deformable_model
from .slices import Inflation, Settings, SliceResult


def inflate(slices: Sequence[SliceResult], inside: NDArray[np.float64], settings: Settings) -> list[SliceResult]:
    """Relax the balloons of all slices together and put the curves into the results.

    Parameters
    ----------
    slices : sequence of SliceResult
        In the order of their planes.
    inside : ndarray, shape (2,)
        A point inside the head, slice (row, col).
    settings : Settings

    Returns
    -------
    list of SliceResult
    """
    own = [i for i, s in enumerate(slices) if s.status == "balloon"]
    if not own:
        return list(slices)
    # the chord frame and the two end angles of each gap, outer and inner
    gaps = [slices[i].ends for i in own]
    frames = [[ChordFrame.of(ends, inside) for ends in pair] for pair in gaps]
    angles = np.array(
        [[f.end_angles(e) for f, e in zip(*pair, strict=True)] for pair in zip(frames, gaps, strict=True)]
    )
    length = np.array([[f.length for f in pair] for pair in frames])
    # all balloons as one batch
    start, slopes, pressure = _initial(length, angles[..., 0], angles[..., 1], settings.n_snaxels, settings.pressure)
    relaxed = deformable_model.inflate(
        start,
        slopes,
        pressure=pressure,
        tension=settings.tension,
        rigidity=settings.rigidity,
        dt=settings.dt,
        tol=settings.tol,
        max_iter=settings.max_iter,
        max_moves=settings.max_moves,
    )
    # back into the slices
    facts = (np.degrees(angles[..., 0]), np.degrees(angles[..., 1]), length, relaxed.n_iter, relaxed.converged)
    out = list(slices)
    for j, i in enumerate(own):
        inflation = Inflation(*(tuple(values[j].tolist()) for values in facts))
        start_curves, curves = (_in_slice(chord_curves[j], frames[j]) for chord_curves in (start, relaxed.curve))
        out[i] = replace(slices[i], start=start_curves, curves=curves, inflation=inflation)
    return out


def carry(slices: Sequence[SliceResult]) -> tuple[SliceResult, ...]:
    """Fill skipped slices that lie between bridged ones with curves interpolated from those, marked as carried.

    Parameters
    ----------
    slices : sequence of SliceResult

    Returns
    -------
    tuple of SliceResult
    """
    # bridged slices below and above each skipped one; without both, nothing is extrapolated
    known = np.array([s.plane for s in slices if s.curves.size])
    curves = {s.plane: s.curves for s in slices if s.curves.size}
    out = []
    for s in slices:
        below, above = known[known < s.plane], known[known > s.plane]
        if s.status != "skipped" or not len(below) or not len(above):
            out.append(s)
            continue
        # linear between them, snaxel by snaxel: curves of one design have equally many
        a, b = int(below[-1]), int(above[0])
        t = (s.plane - a) / (b - a)
        out.append(replace(s, status="carried", curves=(1 - t) * curves[a] + t * curves[b]))
    return tuple(out)


def _in_slice(curves: Points, frames: list[ChordFrame]) -> Points:
    """Outer and inner curve from their chord frames to the slice."""
    return np.stack([frame.to_slice(curve) for frame, curve in zip(frames, curves, strict=True)])


def _initial(
    length: NDArray[np.float64],
    theta0: NDArray[np.float64],
    theta1: NDArray[np.float64],
    n: int,
    pressure: float | None,
) -> tuple[Points, Points, NDArray[np.float64]]:
    """Start curves, their slopes per snaxel at the ends, and the pressure: the paper's, or the spiral's own."""
    if pressure is not None:
        # the paper's cubic, and one constant k
        start = cubic(length, theta0, theta1, n)
        steps = [np.stack([length, length * np.tan(t)], axis=-1) for t in (theta0, theta1)]
        return start, np.stack(steps, axis=-2) / (n - 1), np.full(length.shape, pressure)
    # a spiral through both ends, and the k that holds its curvature
    start, curvature = spiral(length, theta0, theta1, n)
    along = np.linalg.norm(np.diff(start, axis=-2), axis=-1).sum(-1)
    heads = [np.stack([np.cos(t), np.sin(t)], axis=-1) for t in (theta0, theta1 - np.pi)]
    slopes = np.stack(heads, axis=-2) * (along / (n - 1))[..., None, None]
    return start, slopes, deformable_model.curvature_pressure(along, curvature)
