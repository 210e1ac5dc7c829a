"""Two ways to bend a surface across a hole, under sliders: the thin plate and the sheet of D-NURBS on its way to rest.

Frames: chart (v, u) with radii in mm; sheets in mm along the chart's axes from its eye. Both look at every third or
fourth ray only, so that a picture follows the hand.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...drawing.canvas import BLACK, BLUE, BONE, GREY, ORANGE, SKY, VERMILLION, Canvas
from ...drawing.canvas_axes import Chart
from ...errors import InputRefused
from ...methods import thin_plate
from ...methods.dnurbs import method as dnurbs
from ...methods.dnurbs import sheet_motion
from ...methods.dnurbs.sheet import Sheet
from ...methods.dnurbs.sheet_motion import Dynamics, Motion, Setting
from ...opening import Opening
from ...prosthesis import Prosthesis
from ...vault import radius_map, symmetry
from ...vault.radius_map import RadialChart
from ...volume import Volume
from .controls import Slider, View
from .panel import Panel
from .solid import coloured

MAX_STEPS = 40
_SIDE, _WIDE = 440, 460  # px
_TOP = 2.0  # mm: upper end of the scale of errors
_PLATE, _SHEET = 3, 4  # every so many rays
_SPAN = 25.0  # mm between the knots of the sheet
_DEEP = 0.8  # part of its radius to which the sheet is pushed in before it is let go
_LEAN = np.radians(25)  # of the view onto the net
_ANY = 1e-9  # a mean above this has something in it; sums of zeros may be a little off
_TOL = 0.02  # mm a step: at rest

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Scene:
    """What both panels look at.

    Parameters
    ----------
    vault : RadialChart
        Of every third or fourth ray.
    true : ndarray, shape (M, M)
        Radii of the outer surface with the missing bone in its place, mm; nan where none is known.
    mirrored : ndarray, shape (M, M), or None
        Outer radii of the other side of the skull.
    """

    vault: RadialChart
    true: Array
    mirrored: Array | None = None


def coarse(vault: RadialChart, every: int) -> RadialChart:
    """A chart of every n-th ray, counted from its middle; radii are means of their neighbours."""
    shown = [np.where(vault.hole, np.nan, radius) for radius in (vault.outer, vault.inner)]
    outer, inner = (thin_plate.thinned(radius, every) for radius in shown)
    hole = thin_plate.thinned(vault.hole.astype(float), every) > _ANY
    return replace(vault, step=vault.step * every, outer=outer, inner=inner, hole=hole)


def look(fine: RadialChart, bone: Volume, truth: Prosthesis | None, every: int) -> Scene:
    """The vault around a hole and, where it is known, the bone that is missing in it."""
    vault = coarse(fine, every)
    if truth is None or truth.patch is None:
        return Scene(vault, np.where(vault.hole, np.nan, vault.outer))
    whole = radius_map.along(fine, bone.with_voxels(bone.voxels | truth.patch.voxels))
    return Scene(vault, thin_plate.thinned(whole.outer, every))


def bent_plate(bone: Volume, opening: Opening, truth: Prosthesis | None = None) -> Panel:
    """Choose the orders and the strength of a thin plate; see its error on the map and a profile through the hole.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    opening : Opening
    truth : Prosthesis, optional
        The missing bone with its patch, where it is known (`truth.true_prosthesis`).
    """
    fine = radius_map.look(bone, opening)
    scene = look(fine, bone, truth, _PLATE)
    try:
        other = radius_map.along(fine, symmetry.find(bone, opening.head_centre).mirrored(bone))
        scene = replace(scene, mirrored=coarse(other, _PLATE).outer)
    except InputRefused:  # no plane of symmetry: the third slider has no effect
        pass
    controls = (
        Slider("second", "a: second order smooths over (mm)", 0.0, 20.0, 1.3, 0.1),
        Slider("third", "b: third order smooths over (mm)", 0.0, 20.0, 1.8, 0.1),
        Slider("mirror", "c: curvature of the other side (mm)", 0.0, 20.0, 1.6, 0.1),
    )
    bend = lru_cache(maxsize=64)(lambda second, third, mirror: plate_of(scene, second, third, mirror))
    alt = "The vault as a map, coloured by how far the plate lies off the bone; beside it a profile through the hole."
    return Panel(controls, lambda **lengths: _plate_view(scene, bend(**lengths), lengths), alt=alt, slow=True)


def plate_of(scene: Scene, second: float, third: float, mirror: float) -> Array:
    """Outer radii of the plate in the hole and beside it, shape (M, M), mm; nan elsewhere."""
    vault = scene.vault
    like = scene.mirrored
    return thin_plate.bend(vault.outer, vault.hole, vault.mm, like=like, second=second, third=third, likeness=mirror)


def _plate_view(scene: Scene, plate: Array, lengths: dict[str, float]) -> View:
    """Map of errors and profile of a plate."""
    off, hole = plate - scene.true, scene.vault.hole
    canvas = Canvas(_SIDE + _WIDE, _SIDE)
    _draw_map(canvas, off, hole)
    _draw_profile(canvas, scene, plate)
    line = "a = {second:g}, b = {third:g}, c = {mirror:g} mm: ".format(**lengths)
    beside = off[~hole & np.isfinite(off)]
    if np.isfinite(off[hole]).any():
        line += f"{_errors(off[hole])} in the hole; "
    known = f"median {np.median(np.abs(beside)):.2f} mm off the bone beside it." if len(beside) else "no bone is seen."
    return View(canvas.array(), line + known, off=() if scene.mirrored is not None else ("mirror",))


def _errors(off: Array) -> str:
    """Mean with its sign, root mean square and maximum of errors of a radius."""
    off = off[np.isfinite(off)]
    mean = f"{abs(off.mean()):.2f} mm too {'high' if off.mean() > 0 else 'deep'} on average"
    return f"{mean}, rms {np.sqrt((off**2).mean()):.2f} mm, {np.abs(off).max():.2f} mm at most"


def _draw_map(canvas: Canvas, off: Array, hole: NDArray[np.bool_]) -> None:
    """Absolute errors over the chart, the hole outlined, and their scale."""
    side, middle = _SIDE - 90, len(off) // 2
    reach = int(np.abs(np.argwhere(np.isfinite(off) | hole) - middle).max(initial=1))
    at = np.linspace(max(middle - reach, 0), min(middle + reach, len(off) - 1), side).round().astype(int)
    rgb = coloured(np.abs(off[np.ix_(at, at)]).astype(np.float32), _TOP)
    inside = hole[np.ix_(at, at)]
    edge = inside & ~(np.roll(inside, 2, 0) & np.roll(inside, -2, 0) & np.roll(inside, 2, 1) & np.roll(inside, -2, 1))
    rgb[edge] = (0, 0, 0)
    canvas.text(45, 22, "plate to bone (mm), the hole outlined")
    canvas.place(rgb, 45, 34)
    canvas.place(coloured(np.broadcast_to(np.linspace(0, _TOP, side, dtype=np.float32), (14, side)), _TOP), 45, 394)
    canvas.text(45, _SIDE - 12, "0 mm", size=12, colour=GREY)
    canvas.text(45 + side, _SIDE - 12, f"{_TOP:g} mm or more", size=12, colour=GREY, anchor="rs")


def _draw_profile(canvas: Canvas, scene: Scene, plate: Array) -> None:
    """Radii along the chart's middle row: bone, truth and plate."""
    vault, row = scene.vault, len(plate) // 2
    x = (np.arange(len(plate)) - row) * vault.mm
    near = np.isfinite(plate[row])
    bone = np.where(vault.hole, np.nan, vault.outer)[row]
    seen = np.concatenate([bone[near], scene.true[row][near]])
    seen = seen[np.isfinite(seen)] if np.isfinite(seen).any() else np.nan_to_num(plate[row])
    ends = (float(x[near].min()), float(x[near].max())) if near.any() else (-1.0, 1.0)
    low, high = float(seen.min()), float(seen.max())
    chart2d = Chart((_SIDE, 8, _WIDE, _SIDE - 16), ends, (low - 1, high + 0.35 * (high - low) + 1))
    chart2d.frame(canvas, "radius of the outer surface (mm)", "along the map's middle row (mm)")
    for curve, colour, width, dash in ((scene.true[row], VERMILLION, 2.0, (7, 4)), (plate[row], BLUE, 2.5, None)):
        for part in _runs(np.isfinite(curve) & near):
            canvas.line(chart2d.px(np.column_stack([x, curve])[part]), colour, width=width, dash=dash)
    known = np.isfinite(bone) & near
    canvas.dots(chart2d.px(np.column_stack([x, bone])[known]), BONE, radius=3.5, edge=BLACK)
    entries = [(BONE, "dot", "bone"), (VERMILLION, "dash", "whole skull"), (BLUE, "line", "plate")]
    canvas.legend(_SIDE + _WIDE - 140, 40, entries)


def _runs(known: NDArray[np.bool_]) -> list[slice]:
    """Stretches of at least two true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(int)))
    return [slice(a, b) for a, b in edges.reshape(-1, 2) if b - a > 1]


@dataclass(frozen=True, eq=False)
class Way:
    """A sheet on its way to rest.

    Parameters
    ----------
    setting : Setting
        What acts on it.
    motions : tuple of Motion
        Before the first step, and after each.
    """

    setting: Setting
    motions: tuple[Motion, ...]


def elastic_sheet(bone: Volume, opening: Opening, truth: Prosthesis | None = None) -> Panel:
    """Push a sheet of D-NURBS into the head, let it go, and watch it come to rest; play, pause, step and scrub.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    opening : Opening
    truth : Prosthesis, optional
        The missing bone with its patch, where it is known (`truth.true_prosthesis`).
    """
    scene = look(radius_map.look(bone, opening), bone, truth, _SHEET)
    run = lru_cache(maxsize=16)(lambda *values: relaxing(scene.vault, *values))
    controls = (
        Slider("wavelength", "wavelength that is halved: rigidity (mm)", 5, 80, 20, log=True),
        Slider("mass", "\N{GREEK SMALL LETTER MU}: mass per parameter area", 0.0, 10.0, 1.0, 0.5),
        Slider("damping", "\N{GREEK SMALL LETTER GAMMA}: damping per parameter area", 0.1, 100, 1, log=True),
        Slider("step", "step", 0, MAX_STEPS, MAX_STEPS, player=True),
    )
    alt = (
        "A net of control points over the bone and the sheet it carries at the chosen step; beside it a cut through "
        "the sheet, and its energy at every step."
    )
    return Panel(controls, lambda step, **values: _sheet_view(scene, run(*values.values()), step), alt=alt, slow=True)


def relaxing(vault: RadialChart, wavelength: float, mass: float, damping: float) -> Way:
    """Let the outer sheet go from too deep in the head, weights frozen, at most `MAX_STEPS` steps."""
    setting = dnurbs.fit(vault, wavelength=wavelength, tension=0.0, span=_SPAN).settings[0]
    dynamics = Dynamics(mass=mass, damping=damping)
    deep = replace(setting.natural, control=setting.natural.control * _DEEP)
    motions = [sheet_motion.start(deep, setting, dynamics)]
    sheet_motion.relax(
        motions[0], setting, dynamics, tol=_TOL, max_iter=MAX_STEPS, iter_callback=lambda m: motions.append(m)
    )
    return Way(setting, tuple(motions))


def _sheet_view(scene: Scene, way: Way, step: int) -> View:
    """Net and sheet at a step, a cut, and the energy."""
    last = len(way.motions) - 1
    now = way.motions[min(step, last)]
    canvas = Canvas(_SIDE + _WIDE, _SIDE)
    _draw_net(canvas, way, now.sheet)
    _draw_cut(canvas, way, now.sheet)
    _draw_energy(canvas, way, min(step, last))
    state = "at rest" if now.converged else "not at rest"
    line = f"Step {min(step, last)} of {last}, {state}: energy {now.energy:.0f} mm4"
    line += f", moved {now.moved:.2f} mm at most" if now.n_iter else ""
    hole = scene.vault.hole
    off = (dnurbs.radii_of(now.sheet, scene.vault) - scene.true)[hole]
    line += f"; {_errors(off)} in the hole" if np.isfinite(off).any() else ""
    return View(canvas.array(), line + ".", limits={"step": last})


def _draw_net(canvas: Canvas, way: Way, one: Sheet) -> None:
    """Control net, sheet and bone, seen from outside and a little from below."""
    flat = lambda points: points @ np.array([[1, 0], [0, np.cos(_LEAN)], [0, -np.sin(_LEAN)]])  # noqa: E731
    springs = way.setting.springs.points
    every = flat(np.concatenate([way.motions[-1].sheet.control.reshape(-1, 3), springs]))
    zoom, middle = (_SIDE - 40) / np.ptp(every, axis=0).max(), (every.min(axis=0) + every.max(axis=0)) / 2
    place = lambda points: (flat(points) - middle) * zoom + _SIDE / 2  # noqa: E731
    inset = Canvas(_SIDE, _SIDE)
    inset.dots(place(springs), BONE, radius=1.5)
    (n, m), fine = one.spans, 48
    for v in np.linspace(0, n, 2 * n + 1):
        inset.line(place(one.at(np.full(fine, v), np.linspace(0, m, fine))), SKY, width=1.5)
    for u in np.linspace(0, m, 2 * m + 1):
        inset.line(place(one.at(np.linspace(0, n, fine), np.full(fine, u))), SKY, width=1.5)
    for points in (*one.control, *one.control.swapaxes(0, 1)):
        inset.line(place(points), ORANGE, width=1)
    inset.dots(place(one.control.reshape(-1, 3)), ORANGE, radius=3, edge=BLACK)
    inset.legend(6, 6, [(ORANGE, "dot", "control net"), (SKY, "line", "sheet"), (BONE, "dot", "bone")])
    canvas.inlay(inset, 0, 0)


def _draw_cut(canvas: Canvas, way: Way, one: Sheet) -> None:
    """The middle of the sheet across the head: bone that pulls, sheet, and its row of control points."""
    springs, middle = way.setting.springs, one.spans[0] / 2
    points = springs.points[np.abs(springs.v - middle) < 0.1]
    control = one.control[len(one.control) // 2]
    wide = float(np.abs(springs.points[:, 0]).max()) + 5
    high = float(springs.points[:, 2].max()) + 8
    cut = Chart((_SIDE, 0, _WIDE, 250), (-wide, wide), (float(springs.points[:, 2].min()) - 8, high))
    cut.frame(canvas, "a cut through the middle: out of the head (mm)", "across the hole (mm)")
    canvas.dots(cut.px(points[:, [0, 2]]), BONE, radius=3.5, edge=BLACK)
    u = np.linspace(0, one.spans[1], 80)
    canvas.line(cut.px(one.at(np.full(80, middle), u)[:, [0, 2]]), BLUE, width=2.5)
    canvas.line(cut.px(control[:, [0, 2]]), ORANGE, width=1, dash=(5, 4))
    canvas.dots(cut.px(control[:, [0, 2]]), ORANGE, radius=3.5, edge=BLACK)


def _draw_energy(canvas: Canvas, way: Way, step: int) -> None:
    """Energy at every step, the present one marked."""
    energy = np.array([motion.energy for motion in way.motions])
    limits = (energy.min() / 1.3, energy.max() * 1.5)
    curve = Chart((_SIDE, 250, _WIDE, _SIDE - 250), (0, len(energy)), limits, log=True)
    curve.frame(canvas, "energy: bending, springs and motion (mm\N{SUPERSCRIPT FOUR})", "step")
    canvas.line(curve.px(np.column_stack([np.arange(len(energy)), energy])), SKY, width=2)
    canvas.dots(curve.px([[step, energy[step]]]), "#FFFFFF", radius=5, edge=BLACK)
