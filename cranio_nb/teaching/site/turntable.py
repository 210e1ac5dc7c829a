"""A 3-D scene -> a panel that turns it: pictures from all round, by the package's own renderer.

Frame: world mm (LPS). The camera goes round the head's axis, and up and down; the scale stays the same.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from ...drawing.canvas import Canvas, round_length
from ...drawing.figures import colour_scale
from ...drawing.palette import GREY, rgb_shares
from ...drawing.scene3d import Scene
from ...drawing.scene_picture import named_colours
from ...drawing.shading import Solid, render, view_axes
from ...drawing.thinning import thin_mesh
from ..widgets import Panel, View
from ..widgets.controls import Slider
from .axes import Axis

_WIDTH, _HEIGHT, _FOOT = 640, 480, 60  # px, of the scene and of what is said below it
_MAX_FACES = 40_000  # of all parts together: a face is then about as large as a pixel
_SIDES = {"L": (1, 0, 0), "R": (-1, 0, 0), "P": (0, 1, 0), "A": (0, -1, 0), "S": (0, 0, 1), "I": (0, 0, -1)}


def turntable(scene: Scene) -> Panel:
    """A scene under two sliders.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    Panel
        Controls ``turn``, 0 from the front and 90 from the patient's left, and ``rise``, both in degrees.
    """
    x, y, z = scene.towards
    turn = Slider("turn", "seen from: 0 front, 90 left side", -180, 165, 0, 15, unit="degrees")
    rise = Slider("rise", "seen from above", -30, 60, 30, 30, unit="degrees")
    budget = _MAX_FACES // len(scene.parts)
    solids = []
    for part in scene.parts:
        colours = rgb_shares(part.colour)
        if part.values is not None and scene.top is not None:
            colours = colour_scale(scene.top).to_rgba(np.asarray(part.values, float))[:, :3]
        mesh, carried = thin_mesh(part.mesh, np.broadcast_to(colours, part.mesh.vertices.shape), budget)
        solids.append(Solid(mesh, carried))
    shown = Panel((turn, rise), partial(_view, scene, solids), alt=scene.alt)
    return shown.set(turn=np.degrees(np.arctan2(x, -y)), rise=np.degrees(np.arcsin(z)))


def all_round(panel: Panel) -> tuple[Axis, ...]:
    """The axes of a turntable: all its stops, the turn without an end.

    Parameters
    ----------
    panel : Panel
        As `turntable` makes it.

    Returns
    -------
    tuple of Axis
    """
    return tuple(
        Axis(control, control.stops, control.stops.index(panel.values[name]), cyclic=name == "turn")
        for name, control in panel.controls.items()
    )


def _view(scene: Scene, solids: list[Solid], turn: int, rise: int) -> View:
    """The scene from one side."""
    a, e = np.radians([turn, rise])
    axes = view_axes((np.sin(a) * np.cos(e), -np.cos(a) * np.cos(e), np.sin(e)))
    # the same scale from everywhere: the ball around all parts just fits
    points = np.concatenate([solid.mesh.vertices for solid in solids])
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    radius = np.linalg.norm(points - middle, axis=1).max()
    px_mm = 2 * radius / _HEIGHT
    seen = render(solids, axes[2], px_mm=px_mm)
    # the picture begins at its lowest corner; the middle of the scene goes to the middle of the canvas
    corner = (points @ axes[:2].T).min(axis=0)
    x, y = np.array([_WIDTH, _HEIGHT]) / 2 - (axes[:2] @ middle - corner) / px_mm
    canvas = Canvas(_WIDTH, _HEIGHT + _FOOT)
    canvas.place((255 * seen.rgb).astype(np.uint8), x, y)
    _annotate(canvas, scene, axes, px_mm)
    names = ", ".join(part.label for part in scene.parts if part.label)
    line = f"3-D scene{': ' + names if names else ''}, seen from {turn} degrees and {rise} degrees above."
    return View(canvas.array(), line)


def _annotate(canvas: Canvas, scene: Scene, axes: NDArray[np.float64], px_mm: float) -> None:
    """Names of the parts, sides of the patient, a length, and what the colours mean."""
    named = named_colours(scene.parts)
    if named:
        canvas.legend(6, 6, [(tones, "area", name) for tones, name in named])
    for letter, direction in _SIDES.items():
        right, down, _ = axes @ np.array(direction, float)
        if np.hypot(right, down) > 0.7:  # else it lies on the head, or behind it
            x, y = (0.5 + 0.47 * right) * _WIDTH, (0.5 + 0.47 * down) * _HEIGHT
            canvas.text(x, y, letter, size=14, anchor="mm", halo=True)
    length = round_length(0.2 * _WIDTH * px_mm)
    canvas.scale_bar(14, _HEIGHT + 40, length / px_mm, f"{length:g} mm")
    if scene.top is not None:
        ramp = colour_scale(scene.top).to_rgba(np.linspace(0, scene.top, 240), bytes=True)[:, :3]
        canvas.place(np.broadcast_to(ramp, (14, 240, 3)).copy(), _WIDTH - 260, _HEIGHT + 14)
        canvas.text(_WIDTH - 260, _HEIGHT + 34, "0", size=12, colour=GREY, anchor="la")
        text = f"\N{GREATER-THAN OR EQUAL TO} {scene.top:.2g} {scene.unit}"
        canvas.text(_WIDTH - 20, _HEIGHT + 34, text, size=12, colour=GREY, anchor="ra")
