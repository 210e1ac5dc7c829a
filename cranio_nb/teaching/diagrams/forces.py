"""The forces on each snaxel of a balloon: tension, rigidity and pressure, at the start and at rest.

Frame: chord (along, out) px. Forces are per step of the model's time, px, as the scheme of `deformable_model` has them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...curves import Points, cubic, normals
from ...drawing.described import Described
from ...drawing.figures import Axes
from ...drawing.palette import BLACK, MEASURE, OUTER, PRESSURE, TITLE_PT, WHITE
from ...stages.deformable_model import inflate
from . import marks

_PUSH = 0.045  # of the chord: the arrow of the pressure
_MARGIN = 0.06  # of the chord, shown beside it
_HEIGHT_IN = 4.8
_SHARE = (0.44, 0.56)  # of the height, for the start and for the rest
_BELOW = (0.11, 0.165)  # of the chord, shown below it
_STYLES = ((OUTER, False), (OUTER, True), (PRESSURE, False))  # tension, rigidity, pressure: colour, hollow head
_TERMS = ("c''", "\N{MINUS SIGN}c''''", "k n")  # the same in eq. (1), where both weights are 1
_WORDS = {"tension": (0, 2, (0.06, -0.075)), "rigidity": (1, -1, (-0.15, 0.01)), "pressure": (2, 13, (0.1, 0.035))}
"""Which of the forces, at which of the free snaxels it is named, and where beside its arrow, in chords."""


def forces(curve: Points, end_slopes: Points, pressure: float) -> NDArray[np.float64]:
    """What pulls and pushes at the free snaxels of a curve, with the paper's weights.

    Parameters
    ----------
    curve : ndarray, shape (n, 2)
        Snaxels, chord px.
    end_slopes : ndarray, shape (2, 2)
        As for `deformable_model.inflate`.
    pressure : float
        k, px per index squared.

    Returns
    -------
    ndarray, shape (3, n - 2, 2)
        Tension, rigidity, pressure. Their sum is what eq. (1) has for the velocity of the snaxel.

    Examples
    --------
    On a straight chord only the pressure acts:

    >>> chord = np.stack([np.arange(5.0), np.zeros(5)], axis=1)
    >>> (forces(chord, np.array([[1.0, 0.0], [1.0, 0.0]]), 0.1)[:, 1] + 0.0).tolist()
    [[0.0, 0.0], [0.0, 0.0], [0.0, 0.1]]
    """
    # eq. (2): ghost nodes beyond the ends, c(-1) = c(1) - 2 c'(0), hold the slopes
    first, last = curve[1] - 2 * end_slopes[0], curve[-2] + 2 * end_slopes[1]
    bends = np.diff(np.vstack([first, curve, last]), 2, axis=0)
    return np.stack([bends[1:-1], -np.diff(bends, 2, axis=0), pressure * normals(curve)[1:-1]])


def snaxel_forces(length: float, theta0: float, theta1: float, *, pressure: float, n: int = 21) -> Described:
    """Draw the forces on all snaxels of a balloon, at its start and at rest.

    Parameters
    ----------
    length : float
        Of the gap, px.
    theta0, theta1 : float
        Angles of the end tangents above the chord, radians.
    pressure : float
        k, px per index squared.
    n : int
        Snaxels.

    Returns
    -------
    Described
    """
    start = cubic(length, theta0, theta1, n)
    slopes = np.array([[1.0, np.tan(t)] for t in (theta0, theta1)]) * length / (n - 1)
    made = inflate(start, slopes, pressure=pressure)
    states = start, made.curve
    acting = [forces(curve, slopes, pressure) for curve in states]
    figure = marks.sheet(_HEIGHT_IN)
    unit = _PUSH * length / abs(pressure)  # one scale for all arrows
    rises = acting[0].sum(axis=0)[(n - 2) // 2] @ normals(start)[n // 2] > 0
    way = "outwards: the curve rises" if rises else "inwards: the curve sinks"
    names = f"Step 0: the sum points {way}", f"Step {int(made.n_iter)}, at rest: in and out are equally long"
    for i, (name, curve, some) in enumerate(zip(names, states, acting, strict=True)):
        low = np.array([-_MARGIN, -_BELOW[i]]) * length
        ax = marks.plane(figure, (0, (_SHARE[1], 0)[i], 1, _SHARE[i]), low, (1 + 2 * _MARGIN) * length)
        draw_forces(ax, curve, some, unit)
        ax.text(0.01, 0.97, name, transform=ax.transAxes, fontsize=TITLE_PT, weight="bold", va="top")
        _name_forces(ax, curve, some, unit, ("pressure", "tension") if i == 0 else ("rigidity",))
    sums = [np.linalg.norm(some.sum(axis=0), axis=1).max() for some in acting]
    line = f"k = {pressure:g}; largest sum of forces: {sums[0]:.3f} px at the start, {sums[1]:.4f} px at rest"
    sides = "pressure outwards", "tension inwards"
    longer, shorter = sides if rises else sides[::-1]
    alt = (
        "Twice the same balloon with an arrow for each force on each snaxel. At the start "
        f"{longer} is longer than {shorter}; at rest they are equally long, and rigidity acts beside the two ends only."
    )
    return marks.finished(figure, alt, line)


def stacked(curve: Points, acting: NDArray[np.float64], unit: float) -> NDArray[np.float64]:
    """Where the arrows begin: each at the tip of the one before it that points to the same side of the curve.

    Parameters
    ----------
    curve : ndarray, shape (n, 2)
        Chord px.
    acting : ndarray, shape (3, n - 2, 2)
        As `forces` gives them.
    unit : float
        Length of an arrow for each px of force.

    Returns
    -------
    ndarray, shape (3, n - 2, 2)
        Chord px.
    """
    out = (acting * normals(curve)[1:-1]).sum(axis=-1) > 0
    feet = np.broadcast_to(curve[1:-1], acting.shape).copy()
    for kind in (1, 0):  # the pressure stands on the curve, rigidity on it, tension on both
        beneath = (out == out[kind]) & (np.arange(3)[:, None] > kind)
        feet[kind] += unit * (beneath[..., None] * acting).sum(axis=0)
    return feet


def draw_forces(ax: Axes, curve: Points, acting: NDArray[np.float64], unit: float) -> None:
    """Draw a curve with the forces on its free snaxels.

    Parameters
    ----------
    ax : Axes
    curve, acting, unit
        As for `stacked`.
    """
    ax.plot(*curve[[0, -1]].T, color=MEASURE, lw=1.2, ls=(0, (2, 2)))
    marks.polyline(ax, curve, OUTER, lw=1.8)
    for feet, some, (colour, hollow) in zip(stacked(curve, acting, unit), acting, _STYLES, strict=True):
        for foot, force in zip(feet, some, strict=True):
            marks.arrow(ax, foot, foot + unit * force, colour, hollow=hollow)
    ax.plot(*curve.T, ls="none", marker="o", ms=4, mfc=WHITE, mec=BLACK, mew=1.1, zorder=5)


def _name_forces(ax: Axes, curve: Points, acting: NDArray[np.float64], unit: float, names: tuple[str, ...]) -> None:
    """Write its name beside one arrow of each of some forces."""
    feet, length = stacked(curve, acting, unit), curve[-1, 0]
    for name in names:
        kind, snaxel, aside = _WORDS[name]
        middle = feet[kind, snaxel] + 0.6 * unit * acting[kind, snaxel]
        text = f"{name} {_TERMS[kind]}: {np.linalg.norm(acting[kind, snaxel]):.2g} px"
        marks.pointer(ax, middle + length * np.array(aside), middle, text, colour=_STYLES[kind][0])
