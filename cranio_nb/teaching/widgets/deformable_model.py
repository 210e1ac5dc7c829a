"""Stage 3 under sliders: a balloon, step by step, from its start curve to rest.

Frames: the balloon in chord (along, out) px; the picture shows that frame, so that the chord lies level.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...curves import ChordFrame, GapEnds, Points, arc_length, cubic, spiral
from ...drawing.canvas import Canvas, round_length
from ...drawing.canvas_axes import Chart
from ...drawing.palette import BLACK, BLUE, BONE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION
from ...drawing.pixels import RGB, plain, tinted, windowed
from ...stages import deformable_model as stage
from .controls import Choice, Slider, View
from .panel import Panel

PRESETS = ("paper: k as set below", "tangent pressure: k from the ends", "spiral: k along its curve")
MAX_STEPS = 300
_K_UNIT = "px per index\N{SUPERSCRIPT TWO}"
_SIDE, _CHARTS = 512, 340  # px
_SEEN, _ABOVE = 1.2, 0.75  # of the picture's side, and of the part above the chord, in lengths of the chord
_SIDES = {"A": (-1, 0), "P": (1, 0), "R": (0, -1), "L": (0, 1)}  # of the patient, as slice (row, col)


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
    return Panel(controls, lambda step, **values: _view(scene, run(*values.values()), values, step), alt=alt)


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
    # elastic energy of each curve, by differences per index
    stack = np.array(curves)
    energy = (
        tension * (np.diff(stack, axis=1) ** 2).sum(axis=(1, 2))
        + rigidity * (np.diff(stack, 2, axis=1) ** 2).sum(axis=(1, 2))
    ) / 2
    return Inflation(stack, np.array(change), energy, np.broadcast_to(push, (n,)), bool(result.converged))


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
        return _SIDE / (_SEEN * self.frame.length)

    def place(self, points: ArrayLike) -> Points:
        """Places of the chord frame on the canvas.

        Parameters
        ----------
        points : array_like, shape (..., 2)
            Chord (along, out), px.

        Returns
        -------
        ndarray, shape (..., 2)
            (x, y), px of the canvas.
        """
        left_top = np.array([-(_SEEN - 1) / 2, _ABOVE]) * self.frame.length
        return (np.asarray(points, float) - left_top) * [self.zoom, -self.zoom]

    @cached_property
    def level(self) -> RGB:
        """The slice turned into the chord frame, white beyond its edges.

        Returns
        -------
        ndarray of uint8, shape (H, W, 3)
        """
        picture = plain((_SIDE, _SIDE))
        if self.background is None:
            return picture
        # the slice pixel under each pixel of the canvas: `place` backwards
        y, x = np.mgrid[:_SIDE, :_SIDE] + 0.5
        chord = np.stack([x, -y], axis=-1) / self.zoom
        chord += np.array([-(_SEEN - 1) / 2, _ABOVE]) * self.frame.length
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
    canvas = Canvas(_SIDE + _CHARTS, _SIDE)
    _draw_gap(canvas, scene, run, step)
    _draw_way(canvas, run, step, values["tol"])
    state = "at rest" if step == last and run.converged else "not at rest"
    change = f"||dc|| = {run.change[step - 1]:.2g} px, " if step else ""
    k = f"k = {run.pressure.mean():.3g}" + (" on average" if np.ptp(run.pressure) > 1e-12 else "")
    # what the numbers say: height over the chord, the ends' angles, and the height of the parabola of this k
    low, apex = run.curves[step][:, 1].min(), run.curves[step][:, 1].max()
    depth = f" and {-low:.1f} px below" if low < -0.05 else ""
    theta0, theta1 = np.degrees(scene.frame.end_angles(scene.ends))
    chord = f"the chord of {scene.frame.length:.1f} px (theta0 {theta0:.1f}, theta1 {theta1:.1f} degrees)"
    line = f"Step {step} of {last}, {state}: {change}apex {apex:.1f} px above{depth} {chord}; "
    parabola = run.pressure.mean() * (values["n"] - 1) ** 2 / 8
    off = () if values["preset"] == PRESETS[0] else ("pressure",)
    line += f"energy {run.energy[step]:.1f} px\N{SUPERSCRIPT TWO}; {k}, k N\N{SUPERSCRIPT TWO}/8 = {parabola:.1f} px."
    return View(canvas.array(), line, limits={"step": last}, off=off)


def _draw_gap(canvas: Canvas, scene: Scene, run: Inflation, step: int) -> None:
    """The slice with ends, tangents, true bone, start curve and balloon."""
    length, place = scene.frame.length, scene.place
    inset = Canvas(_SIDE, _SIDE)
    inset.place(scene.level, 0, 0)
    # chord, curves, tangents
    inset.line(place([[0.0, 0.0], [length, 0.0]]), GREY, width=1, dash=(2, 3))
    if scene.truth is not None:
        inset.line(place(scene.truth), PURPLE, width=5)
    inset.line(place(run.curves[0]), ORANGE, width=2.5, dash=(8, 5))
    inset.line(place(run.curves[step]), BLUE, width=3)
    inset.dots(place(run.curves[step]), BLUE, radius=3.5)
    for point, tangent in zip(scene.ends.points, scene.ends.tangents, strict=True):
        at, tip = scene.frame.to_chord([point, point + 0.2 * length * tangent])
        inset.arrow(place(at), place(tip), GREEN)
        inset.dots(place(at), "#FFFFFF", radius=5, edge=BLACK)
    _annotate_gap(inset, scene, step)
    canvas.inlay(inset, 0, 0)


def _annotate_gap(inset: Canvas, scene: Scene, step: int) -> None:
    """Scale bar, legend and, where a slice lies behind, the sides of the patient."""
    unit = 1.0 if scene.px is None else scene.px
    bar = round_length(0.25 * _SIDE / scene.zoom * unit)
    inset.scale_bar(14, _SIDE - 14, bar / unit * scene.zoom, f"{bar:g} {'px' if scene.px is None else 'mm'}")
    truth = [] if scene.truth is None else [(PURPLE, "line", "true bone")]
    curves = [(ORANGE, "dash", "start"), (BLUE, "line", f"balloon, step {step}"), (GREEN, "line", "end tangents")]
    inset.legend(_SIDE - 178, _SIDE - 18 * (3 + len(truth)) - 16, [*curves, *truth])
    # a letter where its direction leaves the picture
    sides = {} if scene.background is None else _SIDES
    for letter, direction in sides.items():
        along, out = scene.frame.axes @ np.array(direction, float)
        x, y = np.array([along, -out]) / max(abs(along), abs(out)) * 0.46 * _SIDE + _SIDE / 2
        inset.text(x, y, letter, size=14, anchor="mm", halo=True)


def _draw_way(canvas: Canvas, run: Inflation, step: int, tol: float) -> None:
    """Change and energy at every step, the present one marked."""
    last = len(run.change)
    steps = np.arange(1, last + 1)
    # above: the change, on a logarithmic scale, with the tolerance
    low = max(min(run.change.min(), tol) / 2, 1e-6)
    changes = Chart((_SIDE, 0, _CHARTS, 256), (0, last + 1), (low, 2 * max(run.change.max(), tol)), log=True)
    changes.frame(canvas, "change of the curve ||dc|| (px)", "step")
    changes.level(canvas, tol, VERMILLION, dash=(6, 4))
    (x, y), *_ = changes.px([[0, tol]])
    canvas.text(x + 6, y - 5, "tol", size=12, colour=VERMILLION)
    canvas.line(changes.px(np.column_stack([steps, run.change])), BLUE, width=2)
    # below: the energy
    low, high = run.energy.min(), run.energy.max()
    margin = max(0.08 * (high - low), 1e-3 * high)
    energies = Chart((_SIDE, 256, _CHARTS, 256), (0, last + 1), (low - margin, high + margin))
    energies.frame(canvas, "elastic energy (px\N{SUPERSCRIPT TWO})", "step")
    canvas.line(energies.px(np.column_stack([np.arange(last + 1), run.energy])), SKY, width=2)
    if step:
        canvas.dots(changes.px([[step, run.change[step - 1]]]), "#FFFFFF", radius=5, edge=BLACK)
    canvas.dots(energies.px([[step, run.energy[step]]]), "#FFFFFF", radius=5, edge=BLACK)
