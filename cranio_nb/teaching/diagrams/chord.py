"""The chord frame of a real gap (the paper's Fig. 4): L, theta0, theta1, the start curve; with a pressure, its rest.

Frame: chord (along, out) px.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...curves import ChordFrame, GapEnds, Points, cubic
from ...drawing.described import Described
from ...drawing.figures import Axes, Figure
from ...drawing.palette import (
    BLACK,
    MEASURE,
    NOTE_PT,
    OUTER,
    START,
    TANGENT,
    TRUTH,
    TRUTH_WORD,
    WHITE,
    faded,
)
from ...stages.deformable_model import inflate
from . import marks

# in lengths of the chord
_ASIDE, _BELOW = 0.2, 0.22  # shown beside and below the chord
_ARROW = 0.22  # a tangent's arrow
_RADIUS = 0.15  # of the arcs that show angles

_HEIGHT_IN = 3.1
_K_N2 = "k N\N{SUPERSCRIPT TWO}/8"
_THETA = ("\N{GREEK SMALL LETTER THETA}\N{SUBSCRIPT ZERO}", "\N{GREEK SMALL LETTER THETA}\N{SUBSCRIPT ONE}")


@dataclass(frozen=True, eq=False)
class Gap:
    """A gap in its slice.

    Parameters
    ----------
    ends : GapEnds
        Of one boundary, slice (row, col) px.
    inside : array_like, shape (2,)
        Any (row, col) on the head's inner side.
    bone : ndarray of bool, shape (R, C)
        The slice: rows lead to the back, columns to the patient's left.
    px : float
        Size of a pixel, mm.
    truth : array_like, shape (m, 2), optional
        Curve of the missing bone, (row, col) px.
    """

    ends: GapEnds
    inside: ArrayLike
    bone: NDArray[np.bool_]
    px: float
    truth: ArrayLike | None = None

    @property
    def frame(self) -> ChordFrame:
        """Its chord frame.

        Returns
        -------
        ChordFrame
        """
        return ChordFrame.of(self.ends, self.inside)

    @property
    def angles(self) -> tuple[float, float]:
        """theta0 and theta1.

        Returns
        -------
        tuple of float
            Radians.
        """
        return self.frame.end_angles(self.ends)

    def start(self, n: int) -> Points:
        """The start curve, eq. (3).

        Parameters
        ----------
        n : int
            Snaxels.

        Returns
        -------
        ndarray, shape (n, 2)
            Chord px.
        """
        return cubic(self.frame.length, *self.angles, n)

    def slopes(self, n: int) -> Points:
        """What the ends of a balloon are held to, as `deformable_model.inflate` takes it.

        Parameters
        ----------
        n : int
            Snaxels.

        Returns
        -------
        ndarray, shape (2, 2)
            px per index.
        """
        return np.array([[1.0, np.tan(t)] for t in self.angles]) * self.frame.length / (n - 1)


def chord_frame(gap: Gap, *, expected_deg: tuple[float, float] | None = None) -> Described:
    """Draw a gap in its chord frame, with its length, its angles and the start curve.

    Parameters
    ----------
    gap : Gap
    expected_deg : tuple of float, optional
        The angles to expect of a gap of this length.

    Returns
    -------
    Described
    """
    figure = marks.sheet(_HEIGHT_IN)
    ax = draw_gap(figure, gap)
    draw_angles(ax, gap, expected_deg)
    alt = (
        "A gap in the bone, turned so that its chord L lies level and the outside is above. Green arrows leave the two "
        "ends at the angles theta0 and theta1 above the chord; the dashed start curve follows them."
    )
    theta0, theta1 = np.degrees(gap.angles)
    line = f"L {gap.frame.length:.1f} px, theta0 {theta0:.1f}, theta1 {theta1:.1f} degrees"
    return marks.finished(figure, alt, line)


def chord_at_rest(gap: Gap, pressure: float, *, n: int = 21) -> Described:
    """Draw a gap in its chord frame, with the balloon at rest and the parabola of its pressure.

    Parameters
    ----------
    gap : Gap
    pressure : float
        k, px per index squared.
    n : int
        Snaxels.

    Returns
    -------
    Described
    """
    figure = marks.sheet(_HEIGHT_IN)
    ax = draw_gap(figure, gap)
    length = gap.frame.length
    made = inflate(gap.start(n), gap.slopes(n), pressure=pressure)
    bowed = parabola(length, pressure, n)
    apex = pressure * (n - 1) ** 2 / 8
    marks.polyline(ax, bowed, BLACK, lw=1.3, ls=(0, (1, 1.6)))
    draw_balloon(ax, made.curve)
    marks.measure(ax, (length / 2, 0), (length / 2, apex))
    marks.word(ax, (0.49 * length, -0.012 * length), f"parabola of k: {_K_N2} = {apex:.1f} px", ha="left", va="top")
    at = made.curve[round(0.25 * n)]
    marks.pointer(ax, (at[0] + 0.05 * length, -0.04 * length), at, "balloon at rest", colour=OUTER)
    heights = [curve[:, 1].max() for curve in (made.curve, gap.start(n))]
    alt = (
        "The same gap with the balloon at rest: it lies just above the dotted parabola of its pressure, well below the "
        "dashed start curve and the true bone."
        if heights[0] < heights[1]
        else "The same gap with the balloon at rest, above the dashed start curve, and the parabola of its pressure."
    )
    line = f"{_K_N2} {apex:.1f} px, balloon at rest {heights[0]:.1f} px high, start {heights[1]:.1f} px"
    if gap.truth is not None:
        line += f", true bone {gap.frame.to_chord(gap.truth)[:, 1].max():.1f} px"
    return marks.finished(figure, alt, line)


def parabola(length: float, pressure: float, n: int) -> Points:
    """Where tension alone balances a pressure: c = k i (N - i) / 2 at index i.

    Parameters
    ----------
    length : float
        Of the gap, px.
    pressure : float
        k, px per index squared.
    n : int
        Snaxels; N = n - 1.

    Returns
    -------
    ndarray, shape (101, 2)
        Chord px.

    Examples
    --------
    Its apex is k N^2 / 8 high:

    >>> parabola(80.0, 0.02, 21)[50].tolist()
    [40.0, 1.0]
    """
    index = np.linspace(0, n - 1, 101)
    return np.column_stack([index / (n - 1) * length, pressure / 2 * index * (n - 1 - index)])


def draw_gap(figure: Figure, gap: Gap, *, named: bool = True) -> Axes:
    """Draw what every picture of a chord frame has: bone, chord, axes, ends, tangents, start curve, truth.

    Parameters
    ----------
    figure : Figure
    gap : Gap
    named : bool
        Whether start curve and true bone get their names.

    Returns
    -------
    Axes
        In chord px.
    """
    frame, length = gap.frame, gap.frame.length
    ax = marks.plane(figure, (0, 0, 1, 1), (-_ASIDE * length, -_BELOW * length), (1 + 2 * _ASIDE) * length)
    marks.bone_behind(ax, gap.bone, frame)
    start = gap.start(101)
    named_here = {"start, eq. (3)": (start[70], (0.03, 0.06), BLACK)}
    if gap.truth is not None:
        truth = frame.to_chord(gap.truth)
        marks.polyline(ax, truth, faded(TRUTH), lw=7)
        named_here["edge of true bone"] = (truth[len(truth) // 3], (-0.04, 0.08), TRUTH_WORD)
    _draw_axes(ax, length, gap.px)
    marks.polyline(ax, start, START, ls=(0, (4, 1.6)))
    for text, (to, aside, colour) in named_here.items() if named else ():
        marks.pointer(ax, to + length * np.array(aside), to, text, colour=colour)
    _draw_ends(ax, length, gap.angles)
    marks.sides(ax, marks.chord_sides(frame))
    marks.scale(ax, 10 / gap.px, "10 mm")
    return ax


def draw_angles(ax: Axes, gap: Gap, expected_deg: tuple[float, float] | None) -> None:
    """Draw theta0 and theta1 as arcs, with their values.

    Parameters
    ----------
    ax : Axes
        In chord px.
    gap : Gap
    expected_deg : tuple of float or None
        The angles to expect.
    """
    length = gap.frame.length
    for i, (x, lean) in enumerate(zip((0.0, length), gap.angles, strict=True)):
        marks.angle(ax, (x, 0), _RADIUS * length, lean, TANGENT)
        text = f"{_THETA[i]} = {np.degrees(lean):.1f}\N{DEGREE SIGN}"
        if expected_deg is not None:
            text += (" ", "\n")[i] + f"(expect {expected_deg[i]:.1f}\N{DEGREE SIGN})"
        # below the chord at the first end, above the arc at the last
        at = ((0.16 * length, -0.04 * length), (1.06 * length, 0.165 * length))[i]
        marks.word(ax, at, text, colour=TANGENT, ha=("left", "center")[i], va=("center", "bottom")[i])


def draw_balloon(ax: Axes, curve: Points) -> None:
    """Draw a balloon with its snaxels.

    Parameters
    ----------
    ax : Axes
    curve : ndarray, shape (n, 2)
        Chord px.
    """
    marks.polyline(ax, curve, OUTER, marker="o", ms=4.5, mfc=WHITE, mew=1.5)


def _draw_axes(ax: Axes, length: float, px: float) -> None:
    """Chord, axes, and the length of the chord below it."""
    ax.plot([0, length], [0, 0], color=MEASURE, lw=1.3, ls=(0, (2, 2)))
    marks.arrow(ax, (0, 0), (0, 0.25 * length), MEASURE, width=1.2)
    marks.arrow(ax, (length, 0), (1.17 * length, 0), MEASURE, width=1.2)
    marks.word(ax, (-0.015 * length, 0.24 * length), "out", colour=MEASURE, size=NOTE_PT, ha="right")
    marks.word(ax, (1.16 * length, -0.025 * length), "along", colour=MEASURE, size=NOTE_PT, ha="right", va="top")
    text = f"L = {length:.1f} px = {length * px:.1f} mm"
    marks.measure(ax, (0, -0.09 * length), (length, -0.09 * length), text)


def _draw_ends(ax: Axes, length: float, angles: tuple[float, float]) -> None:
    """The ends of the gap, and the way the bone was going."""
    for x, lean in zip((0.0, length), angles, strict=True):
        tip = np.array([x, 0]) + _ARROW * length * np.array([np.cos(lean), np.sin(lean)])
        marks.arrow(ax, (x, 0), tip, TANGENT, width=2.4)
        ax.plot([x], [0], marker="o", ms=7, mfc=WHITE, mec=BLACK, mew=1.5, zorder=5)
