"""Stage 3 under sliders: a balloon, step by step, from its start curve to rest.

Frames: the balloon in chord (along, out) px; the picture shows that frame, so that the chord lies level.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...curves import ChordFrame, GapEnds, Points
from ...drawing.canvas import Canvas, round_length
from ...drawing.canvas_axes import Chart
from ...drawing.palette import (
    BLACK,
    BONE,
    GREY,
    MEASURE,
    OUTER,
    START,
    TANGENT,
    TRUTH,
    WHITE,
    faded,
    side_letter,
)
from ...drawing.pixels import RGB, plain, tinted, windowed
from ...stages import deformable_model as stage
from ..classroom import distance_to_curve
from .controls import Choice, Slider, View
from .inflation import MAX_STEPS, PRESETS, Inflation, record_inflation
from .panel import Panel
from .parts import HEIGHT, WIDTH

_K_UNIT = "px per index\N{SUPERSCRIPT TWO}"
_HIGH, _CHORD = 300, 195  # px: height of the gap's picture, and where its chord lies
_SEEN = 1.2  # width of the gap's picture, in lengths of the chord
_SIDES = ((-1, 0), (1, 0), (0, -1), (0, 1))  # slice (row, col)
_START, _BALLOON, _GHOST = START, OUTER, faded(TRUTH)


def balloon(
    ends: GapEnds,
    inside: ArrayLike,
    *,
    background: NDArray | None = None,
    truth: ArrayLike | None = None,
    px: float | None = None,
) -> Panel:
    """Inflate a balloon across a gap: forces, weights, convergence; play, pause, step and scrub its way.

    Parameters
    ----------
    ends : GapEnds
        One boundary's ends, slice (row, col) px.
    inside : array_like, shape (2,)
        Any (row, col) on the head's inner side.
    background : ndarray, shape (R, C), optional
        The slice behind the curve: a bool mask of bone, or HU.
    truth : array_like, shape (m, 2), optional
        The curve of the missing bone where it is known, slice (row, col) px.
    px : float, optional
        Size of a pixel in mm, for the scale bar; it counts px when not given.

    Returns
    -------
    Panel
        Controls ``preset``, ``pressure``, ``n``, ``tension``, ``rigidity``, ``dt``, ``tol`` and ``step``.
    """
    # one run for each setting is kept: moving only the step draws, and computes nothing
    frame = ChordFrame.of(ends, inside)
    angles = frame.end_angles(ends)
    true = None if truth is None else frame.to_chord(truth)
    scene = Scene(ends, frame, _background(background), true, px)
    run = lru_cache(maxsize=64)(lambda *values: record_inflation(frame.length, angles, *values))
    controls = (
        Choice("preset", "pressure and start curve", PRESETS, PRESETS[0]),
        Slider("pressure", "k: pressure outwards", -0.1, 0.4, stage.PAPER_PRESSURE, 0.002, unit=_K_UNIT),
        Slider("n", "snaxels, N + 1", 7, 61, 21, 2, expert=True),
        Slider("tension", "w\N{SUBSCRIPT ONE}: tension", 0.1, 5, 1, 0.1, unit="ds\N{SUPERSCRIPT TWO}", expert=True),
        Slider("rigidity", "w\N{SUBSCRIPT TWO}: rigidity", 0.1, 5, 1, 0.1, unit="ds\N{SUPERSCRIPT FOUR}", expert=True),
        Slider("dt", "dt: time step", 0.1, 10, 1, log=True, expert=True),
        Slider("tol", "tol: at rest when ||dc|| is below", 1e-4, 1, 1e-3, unit="px", log=True, expert=True),
        Slider("step", "step", 0, MAX_STEPS, 0, player=True),
    )
    alt = (
        "A gap in a slice, turned so that its chord lies level and the outside is above, with its end tangents, the "
        "start curve dashed and the balloon at the chosen step; beside it the change of the curve and its elastic "
        "energy at every step."
    )
    by_hand = {"preset": PRESETS[0]}
    presets = {"k = 0.4": by_hand | {"pressure": 0.4}, "k = -0.062": by_hand | {"pressure": -0.062}}
    presets |= {"41 snaxels, dt = 4": {"n": 41, "dt": 4.0}}
    return Panel(
        controls, lambda step, **values: _view(scene, run(*values.values()), values, step), alt=alt, presets=presets
    )


@dataclass(frozen=True, eq=False)
class Scene:
    """What lies behind a balloon.

    Parameters
    ----------
    ends : GapEnds
        Slice (row, col) px.
    frame : ChordFrame
    background : ndarray of uint8, shape (R, C, 3), or None
        The slice.
    truth : ndarray, shape (m, 2), or None
        Curve of the missing bone, chord (along, out) px.
    px : float or None
        Size of a pixel, mm.
    """

    ends: GapEnds
    frame: ChordFrame
    background: RGB | None
    truth: Points | None
    px: float | None

    @property
    def zoom(self) -> float:
        """Canvas px per slice px: the chord fills the width of the picture, with a margin at both ends.

        Returns
        -------
        float
        """
        return WIDTH / (_SEEN * self.frame.length)

    def place(self, points: ArrayLike) -> Points:
        """Places of the chord frame on the canvas.

        Parameters
        ----------
        points : array_like, shape (..., 2)
            As `ChordFrame.to_chord` returns them.

        Returns
        -------
        ndarray, shape (..., 2)
            (x, y), px of the canvas.
        """
        return np.asarray(points, float) * [self.zoom, -self.zoom] + self._corner

    @property
    def _corner(self) -> NDArray[np.float64]:
        """Where the chord begins on the canvas, (x, y) px."""
        return np.array([(1 - 1 / _SEEN) / 2 * WIDTH, _CHORD])

    @cached_property
    def level(self) -> RGB:
        """The slice turned into the chord frame, white beyond its edges.

        Returns
        -------
        ndarray of uint8, shape (H, W, 3)
        """
        picture = plain((_HIGH, WIDTH))
        if self.background is None:
            return picture
        # the slice pixel under each pixel of the canvas: `place` backwards
        y, x = np.mgrid[:_HIGH, :WIDTH] + 0.5
        chord = (np.stack([x, y], axis=-1) - self._corner) / [self.zoom, -self.zoom]
        at = np.rint(self.frame.to_slice(chord)).astype(np.intp)
        seen = ((at >= 0) & (at < self.background.shape[:2])).all(axis=-1)
        picture[seen] = self.background[tuple(at[seen].T)]
        return picture


def _background(background: NDArray | None) -> RGB | None:
    """A bone mask or a slice in HU as a pale picture."""
    if background is None:
        return None
    if background.dtype == bool:
        return tinted(plain(background.shape), background, BONE)
    return (windowed(background, 400, 2000) // 2 + 127).astype(np.uint8)


def _view(scene: Scene, run: Inflation, values: dict, step: int) -> View:
    """A balloon at a step; behind it its start curve, beside it its whole way."""
    # a shorter run than the slider shows: its last step
    last = len(run.change)
    step = min(step, last)
    canvas = Canvas(WIDTH, HEIGHT)
    canvas.inlay(_draw_gap(scene, run, step), 0, 0)
    _draw_way(canvas, run, step, values["tol"])
    off = () if values["preset"] == PRESETS[0] else ("pressure",)
    return View(canvas.array(), _line(scene, run, values, step), limits={"step": last}, off=off)


def _line(scene: Scene, run: Inflation, values: dict, step: int) -> str:
    """What the numbers of a step say: height, error, the ends' angles, the parabola of this k, rest and energy."""
    last, curve = len(run.change), run.curves[step]
    state = "at rest" if step == last and run.converged else "not at rest"
    change = f"||dc|| = {run.change[step - 1]:.2g} px, " if step else ""
    # where the curve runs, and how far it is from the truth
    depth = f" and {-curve[:, 1].min():.1f} px below" if curve[:, 1].min() < -0.05 else ""
    error = (
        "" if scene.truth is None else f", at most {distance_to_curve(scene.truth, curve).max():.1f} px off the truth"
    )
    heights = f"apex {curve[:, 1].max():.1f} px above{depth} the chord (start {run.curves[0][:, 1].max():.1f}){error}"
    theta0, theta1 = np.degrees(scene.frame.end_angles(scene.ends))
    ends = f"L {scene.frame.length:.1f} px, theta0 {theta0:.1f}, theta1 {theta1:.1f} degrees"
    # what k alone would raise, and what the curve holds
    k = f"k = {run.pressure.mean():.3g}" + (" on average" if np.ptp(run.pressure) > 1e-12 else "")
    parabola = f"k N\N{SUPERSCRIPT TWO}/8 = {run.pressure.mean() * (values['n'] - 1) ** 2 / 8:.1f} px"
    energy = f"{change}energy {run.energy[step]:.1f} px\N{SUPERSCRIPT TWO} (start {run.energy[0]:.1f})"
    return f"Step {step} of {last}, {state}: {heights}; {ends}; {k}, {parabola}; {energy}."


def _draw_gap(scene: Scene, run: Inflation, step: int) -> Canvas:
    """The slice with ends, tangents, true bone, start curve and balloon."""
    length, place = scene.frame.length, scene.place
    inset = Canvas(WIDTH, _HIGH)
    inset.place(scene.level, 0, 0)
    _annotate_gap(inset, scene, step)
    # chord, curves, tangents
    inset.line(place([[0.0, 0.0], [length, 0.0]]), GREY, width=1, dash=(2, 3))
    if scene.truth is not None:
        inset.line(place(scene.truth), _GHOST, width=8)
    inset.line(place(run.curves[0]), _START, width=2.5, dash=(8, 5))
    inset.line(place(run.curves[step]), _BALLOON, width=3)
    inset.dots(place(run.curves[step]), _BALLOON, radius=3.5)
    for point, tangent in zip(scene.ends.points, scene.ends.tangents, strict=True):
        at, tip = scene.frame.to_chord([point, point + 0.2 * length * tangent])
        inset.arrow(place(at), place(tip), TANGENT)
        inset.dots(place(at), WHITE, radius=5, edge=BLACK)
    return inset


def _annotate_gap(inset: Canvas, scene: Scene, step: int) -> None:
    """Scale bar, legend and, where a slice lies behind, the sides of the patient."""
    unit = 1.0 if scene.px is None else scene.px
    bar = round_length(0.2 * WIDTH / scene.zoom * unit)
    inset.scale_bar(14, _HIGH - 14, bar / unit * scene.zoom, f"{bar:g} {'px' if scene.px is None else 'mm'}")
    truth = [] if scene.truth is None else [(_GHOST, "line", "edge of true bone")]
    # below the chord, where the head is hollow
    inset.legend(150, _HIGH - 66, [(_START, "dash", "start"), (_BALLOON, "line", f"balloon, step {step}")])
    inset.legend(320, _HIGH - 66, [(TANGENT, "line", "end tangents"), (GREY, "dash", "chord L")])
    if truth:
        inset.legend(470, _HIGH - 66, truth)
    # a letter where its direction leaves the picture
    for row, col in () if scene.background is None else _SIDES:
        along, out = scene.frame.axes @ np.array([row, col], float)
        half = np.array([WIDTH, _HIGH]) / 2 - 12
        x, y = np.array([along, -out]) / max(abs(along) / half[0], abs(out) / half[1]) + half + 12
        inset.text(x, y, side_letter((col, row, 0)), size=14, anchor="mm", halo=True)


def _draw_way(canvas: Canvas, run: Inflation, step: int, tol: float) -> None:
    """Change and energy at every step, the present one marked."""
    last = len(run.change)
    steps = np.arange(1, last + 1)
    # left: the change, on a logarithmic scale, with the tolerance
    low = max(min(run.change.min(), tol) / 2, 1e-6)
    top, wide, high = _HIGH + 4, WIDTH // 2, HEIGHT - _HIGH - 4
    changes = Chart((0, top, wide, high), (0, last + 1), (low, 2 * max(run.change.max(), tol)), log=True)
    changes.frame(canvas, "||dc||: how far a step moves the curve (px)", "step")
    changes.level(canvas, tol, MEASURE, dash=(6, 4))
    (x, y), *_ = changes.px([[0, tol]])
    canvas.text(x + 6, y - 5, "tol", size=12, colour=MEASURE)
    canvas.line(changes.px(np.column_stack([steps, run.change])), OUTER, width=2)
    # right: the energy
    least, most = run.energy.min(), run.energy.max()
    margin = max(0.08 * (most - least), 1e-3 * most)
    energies = Chart((wide, top, wide, high), (0, last + 1), (least - margin, most + margin))
    energies.frame(canvas, "energy of stretching and bending (px\N{SUPERSCRIPT TWO})", "step")
    canvas.line(energies.px(np.column_stack([np.arange(last + 1), run.energy])), MEASURE, width=2)
    if step:
        canvas.dots(changes.px([[step, run.change[step - 1]]]), WHITE, radius=5, edge=BLACK)
    canvas.dots(energies.px([[step, run.energy[step]]]), WHITE, radius=5, edge=BLACK)
