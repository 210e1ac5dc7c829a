"""The sheet of D-NURBS of lesson 09 under sliders: pushed into the head, let go, on its way to rest.

Frame: mm along the axes of the radius map, from the point it is taken from.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy import ndimage

from ....drawing.canvas import Canvas
from ....drawing.canvas_axes import Chart
from ....drawing.palette import BLACK, BONE, MEASURE, PATCH, PROSTHESIS, START, WHITE
from ....methods.dnurbs import method as dnurbs
from ....methods.dnurbs import sheet_motion
from ....methods.dnurbs.sheet import Sheet, Springs, settle
from ....methods.dnurbs.sheet_energy import Dynamics, Setting
from ....methods.dnurbs.sheet_motion import Motion
from ....opening import Opening
from ....prosthesis import Prosthesis
from ....vault import radius_measurement
from ....vault.ray_grid import RadiusMap
from ....volume import Volume
from ..controls import Slider, View
from ..panel import Panel
from ..parts import HEIGHT, WIDTH, name_ends
from .scene import Array, Scene, error_line, make_scene

MAX_STEPS = 40
_EVERY = 4  # rays
_SPAN = 25.0  # mm between the knots of the sheet
_DEEP = 0.8  # part of its radius to which the sheet is pushed in before it is let go
_LEAN = np.radians(25)  # of the view onto the net
_SIDE = WIDTH // 2  # px
_TOP = 310  # px: height of the upper pictures
_TOL = 0.02  # mm a step: at rest


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
    """Push a sheet of D-NURBS into the head and let it go until it is at rest; play, pause, step and scrub.

    Parameters
    ----------
    bone, opening, truth
        As for `plate.bent_plate`.

    Returns
    -------
    Panel
        Controls ``wavelength_mm``, ``mass``, ``damping`` and ``step``.
    """
    # on few rays; what holds the sheet is the same for all settings, and a motion is kept for each
    scene = make_scene(radius_measurement.measure_around(bone, opening), bone, truth, _EVERY)
    held = dnurbs.hold(scene.radius_map, scene.radius_map.outer, _SPAN)
    setting = lru_cache(maxsize=32)(lambda wavelength_mm: settle_sheet(scene.radius_map, *held, wavelength_mm))
    run = lru_cache(maxsize=32)(lambda wavelength_mm, **values: relax_sheet(setting(wavelength_mm), Dynamics(**values)))
    controls = (
        Slider("wavelength_mm", "wavelength that is halved: rigidity", 5, 80, 20, unit="mm", log=True, ahead=0),
        Slider("mass", "\N{GREEK SMALL LETTER MU}: mass per parameter area", 0.0, 10.0, 1.0, 0.5, ahead=0),
        Slider("damping", "\N{GREEK SMALL LETTER GAMMA}: damping per parameter area", 0.1, 100, 1, log=True, ahead=0),
        Slider("step", "step", 0, MAX_STEPS, MAX_STEPS, player=True),
    )
    alt = (
        "A net of control points over the bone and the sheet it carries at the chosen step; beside it a cut through "
        "the sheet, and its energy at every step."
    )
    presets = {"heavier": {"mass": 3.0}, "more friction": {"damping": 10.0}, "stiffer": {"wavelength_mm": 80.0}}
    return Panel(
        controls,
        lambda step, **values: _view(scene, run(**values), step),
        alt=alt,
        presets=presets,
        slow=True,
        ahead="wavelength_mm",
    )


def settle_sheet(radius_map: RadiusMap, springs: Springs, natural: Sheet, wavelength_mm: float) -> Setting:
    """What acts on a sheet of some rigidity: springs as weak as the method makes them where bone is off the vault.

    Parameters
    ----------
    radius_map : RadiusMap
    springs, natural
        From `dnurbs.hold`.
    wavelength_mm : float
        Ripples of this length are halved.

    Returns
    -------
    Setting
        As the method fits it.
    """
    material = dnurbs.plate_over(radius_map, natural.spans, wavelength_mm=wavelength_mm)
    return Setting(settle(springs, natural, material, rounds=dnurbs.ROUNDS)[1], natural, material)


def relax_sheet(setting: Setting, dynamics: Dynamics) -> Way:
    """Let a sheet go from too deep in the head, weights frozen, at most `MAX_STEPS` steps.

    Parameters
    ----------
    setting : Setting
        What acts on it.
    dynamics : Dynamics
        Its mass and damping.

    Returns
    -------
    Way
    """
    deep = replace(setting.natural, control=setting.natural.control * _DEEP)
    motions = [sheet_motion.start(deep, setting, dynamics)]
    sheet_motion.relax(
        motions[0], setting, dynamics, tol=_TOL, max_iter=MAX_STEPS, iter_callback=lambda m: motions.append(m)
    )
    return Way(setting, tuple(motions))


def _view(scene: Scene, way: Way, step: int) -> View:
    """Net and sheet at a step, a cut, and the energy."""
    last = len(way.motions) - 1
    step = min(step, last)
    now = way.motions[step]
    canvas = Canvas(WIDTH, HEIGHT)
    _draw_net(canvas, way, now.sheet, scene.radius_map)
    _draw_cut(canvas, way, now.sheet, scene.radius_map.grid.axes[0])
    _draw_energy(canvas, way, step)
    # the numbers of this step, and how far the sheet is off in the hole
    state = "at rest" if now.converged else "not at rest"
    line = f"Step {step} of {last}, {state}: energy {now.energy:.0f} mm\N{SUPERSCRIPT FOUR}"
    line += f", moved {now.moved:.2f} mm at most" if now.n_iter else ""
    hole = scene.radius_map.hole
    off = (dnurbs.radii_of(now.sheet, scene.radius_map) - scene.true)[hole]
    line += f"; {error_line(off)} in the hole" if np.isfinite(off).any() else ""
    return View(canvas.array(), line + ".", limits={"step": last})


def _draw_net(canvas: Canvas, way: Way, one: Sheet, radius_map: RadiusMap) -> None:
    """Control net, sheet, bone and the edge of the hole, seen from outside and a little from below."""
    # seen along a line that leans by _LEAN; the last shape and the bone set the scale
    flat = lambda points: points @ np.array([[1, 0], [0, -np.cos(_LEAN)], [0, -np.sin(_LEAN)]])  # noqa: E731
    springs = way.setting.springs.points
    every = flat(np.concatenate([way.motions[-1].sheet.control.reshape(-1, 3), springs]))
    zoom, middle = (_TOP - 50) / np.ptp(every, axis=0).max(), (every.min(axis=0) + every.max(axis=0)) / 2
    place = lambda points: (flat(points) - middle) * zoom + np.array([_SIDE, _TOP]) / 2  # noqa: E731
    inset = Canvas(_SIDE, _TOP)
    inset.dots(place(springs[::2]), BONE, radius=1.5)  # every other one: they are many, and hold still
    # rays of the hole next to bone, where the sheet at the end meets them
    edge = np.argwhere(radius_map.hole & ~ndimage.binary_erosion(radius_map.hole))
    inset.dots(place(way.motions[-1].sheet.at(*(edge * one.spans / (len(radius_map.hole) - 1)).T)), BLACK, radius=1.5)
    # lines of the sheet twice in each span, then its control net
    (n, m), fine = one.spans, 48
    v, u = np.linspace(0, n, 2 * n + 1), np.linspace(0, m, 2 * m + 1)
    across = np.repeat(v, fine), np.tile(np.linspace(0, m, fine), len(v))
    along = np.tile(np.linspace(0, n, fine), len(u)), np.repeat(u, fine)
    lines = one.at(*(np.concatenate(ways) for ways in zip(across, along, strict=True)))
    for line in lines.reshape(-1, fine, 3):
        inset.line(place(line), PATCH, width=1.5)
    for points in (*one.control, *one.control.swapaxes(0, 1)):
        inset.line(place(points), START, width=1)
    inset.dots(place(one.control.reshape(-1, 3)), START, radius=3, edge=BLACK)
    axes = radius_map.grid.axes
    inset.sides((0, 0, _SIDE, _TOP), axes[0], -axes[1])
    canvas.inlay(inset, 0, 0)


def _draw_cut(canvas: Canvas, way: Way, one: Sheet, right: Array) -> None:
    """The middle of the sheet across the head: bone that pulls, sheet, and its row of control points."""
    # springs beside the middle line, and the row of control points next to it
    springs, middle = way.setting.springs, one.spans[0] / 2
    points = springs.points[np.abs(springs.v - middle) < 0.1]
    control = one.control[len(one.control) // 2]
    wide = float(np.abs(springs.points[:, 0]).max()) + 5
    high = float(springs.points[:, 2].max()) + 8
    # limits by the bone, so that the axes hold still while the sheet moves
    cut = Chart((_SIDE, 0, _SIDE, _TOP), (-wide, wide), (float(springs.points[:, 2].min()) - 8, high))
    cut.frame(canvas, "a cut: out of the head (mm)", "across the hole (mm)")
    name_ends(canvas, cut, right)
    canvas.dots(cut.px(points[:, [0, 2]]), BONE, radius=3.5, edge=BLACK)
    u = np.linspace(0, one.spans[1], 80)
    canvas.line(cut.px(one.at(np.full(80, middle), u)[:, [0, 2]]), PROSTHESIS, width=2.5)
    canvas.line(cut.px(control[:, [0, 2]]), START, width=1, dash=(5, 4))
    canvas.dots(cut.px(control[:, [0, 2]]), START, radius=3.5, edge=BLACK)


def _draw_energy(canvas: Canvas, way: Way, step: int) -> None:
    """Energy at every step, the present one marked."""
    energy = np.array([motion.energy for motion in way.motions])
    limits = (energy.min() / 1.3, energy.max() * 1.5)
    curve = Chart((0, _TOP, WIDTH, HEIGHT - _TOP), (0, len(energy)), limits, log=True)
    curve.frame(canvas, "energy: bending, springs and motion (mm\N{SUPERSCRIPT FOUR})", "step")
    entries = [(START, "dot", "control net"), (PATCH, "line", "sheet of the net"), (PROSTHESIS, "line", "sheet, cut")]
    entries += [(BONE, "dot", "bone"), (BLACK, "dot", "edge of the hole")]
    canvas.legend(WIDTH - 330, _TOP + 24, entries[:3])
    canvas.legend(WIDTH - 165, _TOP + 24, [*entries[3:], (WHITE, "dot", "step shown")])
    canvas.line(curve.px(np.column_stack([np.arange(len(energy)), energy])), MEASURE, width=2)
    canvas.dots(curve.px([[step, energy[step]]]), WHITE, radius=5, edge=BLACK)
