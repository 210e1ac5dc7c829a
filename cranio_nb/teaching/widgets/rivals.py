"""Two rivals under sliders: the guiding points of a flat fill, and the plane that a skull is mirrored at.

Frames: world mm (LPS); slices (row, col) px of the scan, the patient's left on the right.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...drawing.canvas import Canvas
from ...drawing.palette import BLACK, BONE, MEASURE, MIDDLE_GREY, PATCH, SKULL, START, TRUTH, rgb_shares
from ...drawing.pixels import Window, plain, tinted
from ...drawing.shading import Solid, render, view_axes
from ...evaluation import mesh_distances
from ...mesh import OUTER
from ...methods.you import mesh_to_voxels
from ...methods.you import method as you
from ...opening import Opening
from ...prosthesis import Prosthesis
from ...vault import radius_measurement, symmetry
from ...vault.outer_surface import OuterSurface, measure_outer_surface
from ...vault.ray_grid import RadiusMap
from ...vault.symmetry import SymmetryPlane
from ...volume import Volume
from .controls import Slider, View
from .panel import Panel
from .parts import (
    HEIGHT,
    LEFT,
    RIGHT,
    WIDTH,
    annotate_slice,
    coloured,
    draw_colour_scale,
    left_window,
    put_view,
)

_HALF = WIDTH // 2  # px
_TOP = 4.0  # mm: upper end of the scale of residuals
_FREE = 1.0  # mm that `render` leaves free around what it draws


@dataclass(frozen=True, eq=False)
class FlatFill:
    """The fill between some guiding points, drawn.

    Parameters
    ----------
    made : you.Filling
    picture : Canvas
        Hole, rim, guides and fill, from outside.
    patch : ndarray of bool, shape (R, C)
        Voxels of the fill in one plane.
    off : ndarray, shape (V,)
        mm from the nodes of its outer side to the true one; empty where none is known.
    """

    made: you.Filling
    picture: Canvas
    patch: NDArray[np.bool_]
    off: NDArray[np.float64]


def guiding_points(bone: Volume, opening: Opening, truth: Prosthesis | None = None) -> Panel:
    """Choose the number of guiding points around a hole; see the rim they make and the fill across it.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    opening : Opening
    truth : Prosthesis, optional
        The missing bone with sides and patch, where it is known (`against_truth.true_prosthesis`).

    Returns
    -------
    Panel
        Control ``n``.
    """
    # each number of guides is filled once and kept
    radius_map, plane = radius_measurement.measure_around(bone, opening), sum(opening.planes) // 2
    made = lru_cache(maxsize=None)(lambda n: _flat_fill(bone, opening, radius_map, n, plane, truth))
    lost = np.zeros(bone.shape[1:], bool) if truth is None or truth.patch is None else truth.patch.voxels[plane]
    alt = "The hole from outside with guiding points, rim and fill; beside it a slice with the fill and what it misses."
    controls = (Slider("n", "guiding points", 3, 24, 12),)
    presets = {f"{n} points": {"n": n} for n in (3, 4, 24)}
    return Panel(
        controls, lambda n: _guides_view(bone, plane, made(n), lost), alt=alt, presets=presets, slow=True, ahead="n"
    )


def _flat_fill(
    bone: Volume, opening: Opening, radius_map: RadiusMap, n: int, plane: int, truth: Prosthesis | None
) -> FlatFill:
    """Fill a hole between `n` guiding points and measure it."""
    # only the shown plane is voxelised, and the outer nodes measured where the truth is known
    made = you.fill_between(bone, opening, you.find_guides(radius_map, n))
    slab = bone.crop((slice(plane, plane + 1), slice(0, bone.shape[1]), slice(0, bone.shape[2])))
    patch = mesh_to_voxels.fill_mesh(made.solid, slab)[0] & ~slab.voxels[0]
    nodes = made.outer.mesh.vertices
    off = np.zeros(0) if truth is None else mesh_distances.surface_distance(nodes, truth.surface(OUTER))
    return FlatFill(made, _from_outside(made, opening.direction), patch, off)


def _from_outside(made: you.Filling, towards: NDArray[np.float64]) -> Canvas:
    """A filling with its rim and guides, shaded."""
    # extent of skull and fill across the line of sight: it sets the size of a pixel
    right_down = view_axes(towards)[:2].T
    meshes = (made.skull, SKULL), (made.outer.mesh, PATCH)
    flat = np.concatenate([mesh.vertices for mesh, _ in meshes]) @ right_down
    low, px = flat.min(axis=0) - _FREE, float(np.ptp(flat, axis=0).max() / (LEFT - 40))
    # both surfaces shaded
    solids = [Solid(mesh, rgb_shares(colour)) for mesh, colour in meshes]
    rgb = (255 * render(solids, towards, px_mm=px).rgb).astype(np.uint8)
    canvas = Canvas(LEFT, HEIGHT)
    corner = put_view(canvas, rgb, px, towards, (0, 30, LEFT, HEIGHT - 30))
    # the same projection for rim and guides, drawn over the surfaces
    rim, guides = ((points @ right_down - low) / px + corner for points in (made.outer_rim.points, made.guides))
    canvas.line(np.concatenate([rim, rim[:1]]), MEASURE, width=2.5)
    canvas.dots(guides, START, radius=5, edge=BLACK)
    canvas.legend(
        6,
        6,
        [
            (START, "dot", "guiding point"),
            (MEASURE, "line", "rim"),
            (PATCH, "area", "fill"),
            (TRUTH, "area", "missed bone"),
        ],
    )
    return canvas


def _guides_view(bone: Volume, plane: int, fill: FlatFill, lost: NDArray[np.bool_]) -> View:
    """The fill from outside, and one slice of it over the bone that is missing."""
    canvas = Canvas(WIDTH, HEIGHT)
    canvas.inlay(fill.picture, 0, 0)
    # the slice around fill and missing bone; what of the missing bone the fill covers is in its colour
    _, _, width, height = RIGHT
    inset = Canvas(width, height)
    index = np.argwhere(fill.patch | lost) if (fill.patch | lost).any() else np.argwhere(bone.voxels[plane])
    window = Window.around((0, 0, width, height), index.min(axis=0) - 12, index.max(axis=0) + 12)
    rgb = plain(bone.shape[1:])
    for mask, colour in ((bone.voxels[plane], BONE), (lost, TRUTH), (fill.patch, PATCH)):
        rgb = tinted(rgb, mask, colour)
    inset.show(rgb, window)
    annotate_slice(inset, window, bone, plane)
    canvas.inlay(inset, *RIGHT[:2])
    # length of the closed rim, area of the membrane across it
    rim = fill.made.outer_rim.points
    length = np.linalg.norm(rim - np.roll(rim, 1, axis=0), axis=1).sum()
    area = f"{fill.made.outer.areas[-1] / 100:.1f} cm\N{SUPERSCRIPT TWO}"
    line = f"{len(fill.made.guides)} guiding points: rim {length:.0f} mm, fill {area}"
    if len(fill.off):
        line += f"; {fill.off.mean():.2f} mm from the true surface on average, {fill.off.max():.2f} mm at most"
    return View(canvas.array(), line + ".")


def symmetry_plane(bone: Volume, opening: Opening) -> Panel:
    """Turn and shift the plane a skull is mirrored at, away from the one found; see what no longer agrees.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    opening : Opening
        The vault is measured from its head centre; its planes choose the slice.

    Returns
    -------
    Panel
        Controls ``turn_deg``, ``lean_deg`` and ``shift_mm``.
    """
    # plane and surface are measured once; a move only reflects the surface again
    found = symmetry.find_symmetry_plane(bone, opening.head_centre, opening.head_axes)
    surface = measure_outer_surface(bone, opening.head_centre, opening.head_axes)
    plane = sum(opening.planes) // 2
    controls = (
        Slider("turn_deg", "turned about the upright axis", -10.0, 10.0, 0.0, 0.5, unit="degrees", ahead=5),
        Slider("lean_deg", "leaning to a side", -10.0, 10.0, 0.0, 0.5, unit="degrees", ahead=5),
        Slider("shift_mm", "shifted to the left", -10.0, 10.0, 0.0, 0.5, unit="mm", ahead=5),
    )
    alt = "A slice with the mirror image over the bone and the plane; beside it the residual over the vault."
    window = left_window(bone.voxels, _HALF)
    still = {control.name: 0.0 for control in controls}
    moves = {"turn 3\N{DEGREE SIGN}": {"turn_deg": 3.0}, "lean 3\N{DEGREE SIGN}": {"lean_deg": 3.0}}
    moves |= {"shift 1 mm": {"shift_mm": 1.0}}
    return Panel(
        controls,
        lambda **move: _mirror_view(bone, window, surface, move_plane(found, surface, **move), plane, move),
        alt=alt,
        presets={name: still | move for name, move in moves.items()},
    )


def move_plane(
    plane: SymmetryPlane, surface: OuterSurface, *, turn_deg: float, lean_deg: float, shift_mm: float
) -> SymmetryPlane:
    """Turn and lean a plane about its own point, then shift it along its normal.

    Parameters
    ----------
    plane : SymmetryPlane
    surface : OuterSurface
        Its axes say what is upright.
    turn_deg, lean_deg : float
        About the upright axis, and to a side.
    shift_mm : float
        Towards the patient's left.

    Returns
    -------
    SymmetryPlane
    """
    # adding the tangent of an angle along an axis turns the normal by that angle
    _, back, up = surface.grid.axes
    normal = plane.normal + np.tan(np.radians(turn_deg)) * back + np.tan(np.radians(lean_deg)) * up
    normal = normal / np.linalg.norm(normal)
    return replace(plane, point=plane.point + shift_mm * normal, normal=normal)


def _mirror_view(
    bone: Volume,
    window: Window,
    surface: OuterSurface,
    mirror: SymmetryPlane,
    plane: int,
    move: dict[str, float],
) -> View:
    """Bone and mirror image in a slice, and the residual over the vault."""
    canvas = Canvas(WIDTH, HEIGHT)
    canvas.inlay(_mirrored_slice(bone, window, mirror, plane), 0, 0)
    # residuals of all rays as a map, scaled to the square; its sides are those of the slice beside it
    residual = np.abs(symmetry.mirror_residuals(surface, mirror)).astype(np.float32)
    side = _HALF - 40
    rows = np.linspace(0, len(residual) - 1, side).round().astype(int)
    left, top = _HALF + 20, 80
    canvas.place(coloured(residual[np.ix_(rows, rows)], _TOP), left, top)
    canvas.text(left, top - 14, "the vault, sides as at the left: residual (mm)")
    canvas.sides((left, top, side, side))
    draw_colour_scale(canvas, (left, top + side + 16), side, _TOP)
    known = residual[np.isfinite(residual)]
    line = "Turned by {turn_deg:g} and leaning by {lean_deg:g} degrees, shifted by {shift_mm:g} mm: ".format(**move)
    if not len(known):
        return View(canvas.array(), line + "no ray has a partner.")
    return View(canvas.array(), line + f"residual {np.median(known):.2f} mm (median), {known.mean():.2f} mm (mean).")


def _mirrored_slice(bone: Volume, window: Window, mirror: SymmetryPlane, plane: int) -> Canvas:
    """A slice: bone, its mirror image, what both share, and the plane."""
    # the mirror image of the slice: each pixel shows the voxel that its mirrored place falls on
    mask = bone.voxels[plane]
    image = bone.at_index(_over(mask.shape, _mirrored_index(bone, mirror, plane)), outside=False)
    canvas = Canvas(_HALF, HEIGHT)
    canvas.show(tinted(tinted(tinted(plain(mask.shape), image, PATCH), mask, BONE), mask & image, MIDDLE_GREY), window)
    # the plane, where the side changes along a row
    side = _over(mask.shape, mirror.distance(bone.to_world(_corners(plane)))) > 0
    rows = np.flatnonzero(side.any(axis=1) & ~side.all(axis=1))
    if len(rows):
        canvas.line(window.px(np.column_stack([rows, side[rows].argmax(axis=1) - 0.5])), BLACK, width=1.5, dash=(8, 5))
    annotate_slice(canvas, window, bone, plane)
    entries = [(MIDDLE_GREY, "area", "both"), (BONE, "area", "bone"), (PATCH, "area", "mirror")]
    canvas.legend(_HALF / 2 - 46, HEIGHT / 2 - 40, [*entries, (BLACK, "dash", "plane")])  # within the ring of bone
    return canvas


def _corners(plane: int) -> NDArray[np.float64]:
    """The first voxel of a slice and its neighbours in the next row and the next column, shape (3, 3)."""
    return np.array([[plane, 0, 0], [plane, 1, 0], [plane, 0, 1]], float)


def _mirrored_index(bone: Volume, mirror: SymmetryPlane, plane: int) -> NDArray[np.float64]:
    """Voxel indices of the mirrored places of `_corners`, shape (3, 3)."""
    return bone.to_voxel(mirror.mirror(bone.to_world(_corners(plane))))


def _over(shape: tuple[int, ...], corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """An affine function of row and column at every pixel of a slice, from its values at `_corners`."""
    first, row, col = corners
    rows, cols = np.arange(shape[0])[:, None], np.arange(shape[1])
    if first.ndim:
        rows, cols = rows[..., None], cols[:, None]
    return np.asarray(first + rows * (row - first) + cols * (col - first))
