"""The thin plate of lesson 09 under sliders: orders and strength of bending.

Frame: radius map (v, u), radii in mm.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ....drawing.canvas import Canvas
from ....drawing.canvas_axes import Chart
from ....drawing.palette import BLACK, BONE, PROSTHESIS, TRUTH
from ....errors import InputRefused
from ....methods import thin_plate
from ....opening import Opening
from ....prosthesis import Prosthesis
from ....vault import radius_measurement, symmetry
from ....volume import Volume
from ..controls import Slider, View
from ..panel import Panel
from ..parts import HEIGHT, WIDTH, coloured, draw_colour_scale, name_ends
from .scene import Array, Scene, error_line, make_scene, thin_rays

_EVERY = 3  # rays
_TOP = 2.0  # mm: upper end of the scale of errors
_HALF = WIDTH // 2  # px
_MAP = _HALF - 40  # px: side of the map


def bent_plate(bone: Volume, opening: Opening, truth: Prosthesis | None = None) -> Panel:
    """Choose the orders and the strength of a thin plate; its error on the map, and a profile through the hole.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    opening : Opening
    truth : Prosthesis, optional
        The missing bone with its patch, where it is known (`against_truth.true_prosthesis`).

    Returns
    -------
    Panel
        Controls ``second_mm``, ``third_mm`` and ``mirror_mm``.
    """
    # fewer rays than the method takes, so that a plate is bent at once
    fine = radius_measurement.measure_around(bone, opening)
    scene = make_scene(fine, bone, truth, _EVERY)
    try:
        other = radius_measurement.measure_along(
            fine, symmetry.find_symmetry_plane(bone, opening.head_centre, opening.head_axes).mirrored(bone)
        )
        scene = replace(scene, mirrored=thin_rays(other, _EVERY).outer)
    except InputRefused:  # no plane of symmetry: the third slider has no effect
        pass
    controls = (
        Slider("second_mm", "a: second order smooths over", 0.0, 20.0, 1.3, 0.1, unit="mm"),
        Slider("third_mm", "b: third order smooths over", 0.0, 20.0, 1.8, 0.1, unit="mm"),
        Slider("mirror_mm", "c: curvature of the other side", 0.0, 20.0, 1.6, 0.1, unit="mm"),
    )
    bend = lru_cache(maxsize=64)(lambda **lengths: _bend(scene, **lengths))
    alt = "The vault as a map, coloured by how far the plate lies off the bone; beside it a profile through the hole."
    none = {control.name: 0.0 for control in controls}
    settings = {"second order only": {"second_mm": 12.0}, "third order only": {"third_mm": 1.8}, "nothing": {}}
    presets = {name: none | setting for name, setting in settings.items()}
    return Panel(
        controls, lambda **lengths: _view(scene, bend(**lengths), lengths), alt=alt, presets=presets, slow=True
    )


def _bend(scene: Scene, *, second_mm: float, third_mm: float, mirror_mm: float) -> Array:
    """Outer radii of the plate in the hole and beside it, shape (M, M), mm; nan elsewhere."""
    radius_map = scene.radius_map
    return thin_plate.bend(
        radius_map.outer,
        radius_map.hole,
        radius_map.step_mm,
        like=scene.mirrored,
        second_mm=second_mm,
        third_mm=third_mm,
        mirror_mm=mirror_mm,
    )


def _view(scene: Scene, plate: Array, lengths: dict[str, float]) -> View:
    """Map of errors and profile of a plate."""
    # errors in the hole where the truth is known, and on the bone beside it
    off, hole = plate - scene.true, scene.radius_map.hole
    canvas = Canvas(WIDTH, HEIGHT)
    _draw_map(canvas, off, hole, scene.radius_map.grid.axes)
    _draw_profile(canvas, scene, plate)
    line = "a = {second_mm:g}, b = {third_mm:g}, c = {mirror_mm:g} mm: ".format(**lengths)
    beside = off[~hole & np.isfinite(off)]
    if np.isfinite(off[hole]).any():
        line += f"{error_line(off[hole])} in the hole; "
    known = (
        f"median {np.median(np.abs(beside)):.2f} mm off the bone beside it."
        if len(beside)
        else "there is no bone beside it."
    )
    return View(canvas.array(), line + known, off=() if scene.mirrored is not None else ("mirror_mm",))


def _draw_map(canvas: Canvas, off: Array, hole: NDArray[np.bool_], axes: Array) -> None:
    """Absolute errors over the map, the hole outlined, and their scale."""
    # the part of the map that has values, scaled to the square
    middle = len(off) // 2
    reach = int(np.abs(np.argwhere(np.isfinite(off) | hole) - middle).max(initial=1))
    at = np.linspace(max(middle - reach, 0), min(middle + reach, len(off) - 1), _MAP).round().astype(int)
    rgb = coloured(np.abs(off[np.ix_(at, at)]).astype(np.float32), _TOP)
    # black where the hole ends
    inside = hole[np.ix_(at, at)]
    edge = inside & ~(np.roll(inside, 2, 0) & np.roll(inside, -2, 0) & np.roll(inside, 2, 1) & np.roll(inside, -2, 1))
    rgb[edge] = (0, 0, 0)
    # the rows of the map count upwards in the head: turned round, it is seen from outside
    canvas.text(20, 66, "plate to bone (mm), the hole outlined")
    canvas.place(rgb[::-1], 20, 80)
    canvas.sides((20, 80, _MAP, _MAP), axes[0], -axes[1])
    draw_colour_scale(canvas, (20, 96 + _MAP), _MAP, _TOP)


def _draw_profile(canvas: Canvas, scene: Scene, plate: Array) -> None:
    """Radii along the map's middle row: bone, truth and plate."""
    radius_map, row = scene.radius_map, len(plate) // 2
    x = (np.arange(len(plate)) - row) * radius_map.step_mm
    near = np.isfinite(plate[row])
    bone = np.where(radius_map.hole, np.nan, radius_map.outer)[row]
    radii = np.concatenate([bone[near], scene.true[row][near]])
    radii = radii[np.isfinite(radii)] if np.isfinite(radii).any() else np.nan_to_num(plate[row])
    ends = (float(x[near].min()), float(x[near].max())) if near.any() else (-1.0, 1.0)
    low, high = float(radii.min()), float(radii.max())
    # whole skull dashed, plate full, bone beside the hole as dots
    profile = Chart((_HALF, 48, _HALF, HEIGHT - 110), ends, (low - 1, high + 0.35 * (high - low) + 1))
    profile.frame(canvas, "radius of the outer surface (mm)", "along the map's middle row (mm)")
    name_ends(canvas, profile, radius_map.grid.axes[0])
    for curve, colour, width, dash in ((scene.true[row], TRUTH, 3.0, (7, 4)), (plate[row], PROSTHESIS, 2.5, None)):
        for part in _runs(np.isfinite(curve) & near):
            canvas.line(profile.px(np.column_stack([x, curve])[part]), colour, width=width, dash=dash)
    known = np.isfinite(bone) & near
    canvas.dots(profile.px(np.column_stack([x, bone])[known]), BONE, radius=3.5, edge=BLACK)
    entries = [(BONE, "dot", "bone"), (TRUTH, "dash", "whole skull"), (PROSTHESIS, "line", "plate")]
    canvas.legend(WIDTH - 150, 80, entries)


def _runs(known: NDArray[np.bool_]) -> list[slice]:
    """Stretches of at least two true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(int)))
    return [slice(a, b) for a, b in edges.reshape(-1, 2) if b - a > 1]
