"""A method of the paper's outlook: two elastic sheets, pulled to the bone around the hole and left to themselves in it.

Bone mask in, pieces out. Source: Qin and Terzopoulos 1996, "D-NURBS: a physics-based framework for geometric
design", IEEE TVCG 2(1). Faithful are the rational surface, its control points and weights as generalised coordinates,
the thin plate under tension, the springs to data, and Lagrange's equations (`sheet`, `sheet_motion`).

Ours is what makes a prosthesis of it. The vault around the hole is measured along rays (`RadiusMap`); every ray that
meets sound bone is a spring from the bone's outer surface to the place of that ray on the outer sheet, and so inside.
Springs far off the sheet are weakened, so that a suture or a ridge does not dent it. The rigidity follows from a
wavelength l: with one spring for each ray, a ripple of the bone of wavelength l is halved, shorter ones vanish,
longer ones pass:

    rigidity = k (l / (2 pi))^4,    k the springs' strength per mm2.

A plate that wants to be plane fills a wide hole too flat. So the natural shape of each sheet, free of stress, is the
sphere that fits its springs best, and bending is counted from there.

The sheets at rest are read along the rays again; between them lies the patch. With weights frozen at 1, the default,
rest is found at once by a sparse solve. With `free_weights` the sheet moves from there to its own rest by steps
(`sheet_motion.relax`; a lesson can watch any of it).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from ...geometry import voxel_pieces
from ...geometry.band import one_thread
from ...opening import Opening
from ...options import Option, Work
from ...vault import radius_measurement, radius_voxels
from ...vault.ray_grid import RadiusMap
from ...volume import Volume
from ..piece import Piece
from . import sheet, sheet_motion
from .sheet import Material, Sheet, Springs
from .sheet_energy import Dynamics, Setting
from .sheet_motion import Motion

ROUNDS = 5
"""Of weakening springs and settling again."""
_SPHERE_ROUNDS = 8  # of fitting the sphere to what is not far off it
_FIND_STEPS = 6  # of looking up where a ray meets the sheet
_SIDE_MM = 100.0  # of a square of sheet whose control points are counted

WORK = Work(
    "With free weights the steps of all control points of 100 x 100 mm, times those in a row of them",
    40 * (_SIDE_MM / 8) ** 3,  # free weights with all else at its default
    lambda options: options["max_iter"] * (_SIDE_MM / options["span_mm"]) ** 3 if options["free_weights"] else 0,
    "Lower max_iter, or give a wider span_mm.",
)
"""A step fills and solves a band of equations: as long as there are control points, as wide as four rows of them.

On a map of 200 x 200 mm it takes 0.1 s of one core with spans of 8 mm and 0.5 s with spans of 4 mm, between the square
and the cube of their number in a row. Each sheet makes `max_iter` of them; without free weights there are none.
"""


@dataclass(frozen=True, eq=False)
class Sheets:
    """What the method made of one hole; for pictures and lessons.

    Parameters
    ----------
    radius_map : RadiusMap
        The bone around the hole.
    outer, inner : Sheet
        At rest, in mm along the map's axes from the head centre.
    settings : tuple of Setting
        Springs with their last strengths, natural shape and material of the outer and the inner sheet, same frame.
    n_iter : tuple of int
        Steps of the outer and the inner sheet; 0 where one solve was enough.
    converged : tuple of bool
        Whether each came to rest.
    """

    radius_map: RadiusMap
    outer: Sheet
    inner: Sheet
    settings: tuple[Setting, Setting]
    n_iter: tuple[int, int]
    converged: tuple[bool, bool]


def pieces(
    bone: Volume,
    openings: Sequence[Opening],
    *,
    # shorter waves than 5 mm are the scan's stairs; a stiffer sheet than at 80 mm no longer follows the bone
    wavelength_mm: Annotated[float, Option("Ripples of the bone of this length are halved.", 5, 80, "mm")] = 20.0,
    # at 1000 tension smooths over sqrt(1000) = 30 mm: a membrane
    tension_mm2: Annotated[float, Option("0 for a plate, more for a membrane.", 0, 1000, "mm2")] = 0.0,
    # 4 mm: thousands of control points; 40 mm: the four spans that a sheet has at least
    span_mm: Annotated[float, Option("Between the knots of the sheets.", 4, 40, "mm")] = 8.0,
    free_weights: Annotated[bool, Option("Whether the weights move too.")] = False,
    # below 1e-6 rounding moves a sheet; one that may still move 1 mm a step is not at rest
    tol_mm: Annotated[float, Option("Way of a control point in a step at which a sheet rests.", 1e-6, 1, "mm")] = 1e-2,
    # many sheets rest after a few; what moves on after 40 hardly moves
    max_iter: Annotated[int, Option("Steps at most, with free weights.", 1, 40)] = 40,
) -> Iterator[Piece]:
    """Close each opening between two elastic sheets.

    Parameters
    ----------
    bone, openings
        As for `methods.design.design`.
    wavelength_mm : float
        Ripples of the bone of this length in mm are halved; the rigidity follows from it.
    tension_mm2 : float
        mm2, of springs of unit strength per mm2: 0 for a plate, more for a membrane, which fills flatter.
    span_mm : float
        mm between the knots of the sheets.
    free_weights : bool
        Whether the weights move too.
    tol_mm, max_iter
        As for `sheet_motion.relax`, in mm; only with free weights.

    Yields
    ------
    Piece
        The record's `sheets` describe the outer and the inner sheet; `working` holds `Sheets`.
    """
    # without mass the motion is of first order: damping alone, no swinging
    dynamics = Dynamics(mass=0.0, free_weights=True) if free_weights else None
    plate = {"wavelength_mm": wavelength_mm, "tension_mm2": tension_mm2, "span_mm": span_mm}
    for opening in openings:
        made = fit(
            radius_measurement.measure_around(bone, opening),
            **plate,
            dynamics=dynamics,
            tol_mm=tol_mm,
            max_iter=max_iter,
        )
        # the sheets as radii on the rays, the voxels between them, and of these the piece in the hole
        radii = [_inside(made.radius_map, radii_of(part, made.radius_map)) for part in (made.outer, made.inner)]
        outer, inner = radius_voxels.thickened(made.radius_map, outer=radii[0], inner=radii[1])
        between = radius_voxels.voxels_between(made.radius_map, bone, outer=outer, inner=inner)
        voxels = voxel_pieces.keep_main_piece(between, opening.sheet.voxels)
        yield Piece(voxels, (made,), {"sheets": _entries(made)})


@one_thread()  # of its many small products too
def fit(
    radius_map: RadiusMap,
    *,
    wavelength_mm: float,
    tension_mm2: float,
    span_mm: float,
    dynamics: Dynamics | None = None,
    tol_mm: float = 1e-2,
    max_iter: int = 40,
) -> Sheets:
    """Both sheets of one hole at rest.

    Parameters
    ----------
    radius_map : RadiusMap
    wavelength_mm, tension_mm2, span_mm, tol_mm, max_iter
        As for `pieces`.
    dynamics : Dynamics, optional
        How the sheets move on from where frozen weights leave them; they stay there when not given.

    Returns
    -------
    Sheets
    """
    rests, settings = [], []
    for radius in (radius_map.outer, radius_map.inner):
        # each surface by itself, bent as little as can be from the sphere that fits it
        springs, natural = hold(radius_map, radius, span_mm)
        material = plate_over(radius_map, natural.spans, wavelength_mm=wavelength_mm, tension_mm2=tension_mm2)
        rest, springs = sheet.settle(springs, natural, material, rounds=ROUNDS)
        settings.append(Setting(springs, natural, material))
        rests.append(Motion(rest, np.zeros(0), 0.0, converged=True))
    # with free weights the equations of motion go on from there
    if dynamics is not None:
        rests = [
            sheet_motion.relax(sheet_motion.start(m.sheet, s, dynamics), s, dynamics, tol=tol_mm, max_iter=max_iter)
            for m, s in zip(rests, settings, strict=True)
        ]
    outer, inner = rests
    counts, ends = (outer.n_iter, inner.n_iter), (outer.converged, inner.converged)
    return Sheets(radius_map, outer.sheet, inner.sheet, (settings[0], settings[1]), counts, ends)


def hold(radius_map: RadiusMap, radius: NDArray[np.float64], span_mm: float) -> tuple[Springs, Sheet]:
    """What holds the sheet of one surface, whatever it is made of.

    Parameters
    ----------
    radius_map : RadiusMap
    radius : ndarray, shape (M, M)
        The vault's outer or inner radii.
    span_mm : float
        mm between the knots, about: they are uniform over the whole map.

    Returns
    -------
    springs : Springs
        To the bone beside the hole.
    natural : Sheet
        Its shape without stress: on the sphere that fits these points best.
    """
    spans = (max(round((len(radius_map.outer) - 1) * radius_map.step_mm / span_mm), 4),) * 2
    springs = springs_to(radius_map, radius, spans)
    return springs, _sphere(springs.points, radius_map, spans)


def plate_over(
    radius_map: RadiusMap, spans: tuple[int, int], *, wavelength_mm: float, tension_mm2: float = 0.0
) -> Material:
    """The material of a sheet over a map.

    Parameters
    ----------
    radius_map : RadiusMap
    spans : tuple of int
        Of the sheet.
    wavelength_mm, tension_mm2
        As for `pieces`.

    Returns
    -------
    Material
    """
    # rigidity k (l / 2 pi)^4 with unit strength k: bone ripples of the wavelength l are halved
    size = (len(radius_map.outer) - 1) * radius_map.step_mm / spans[0]
    return Material.plate(tension_mm2, (wavelength_mm / (2 * np.pi)) ** 4, (size, size))


def springs_to(radius_map: RadiusMap, radius: NDArray[np.float64], spans: tuple[int, int]) -> Springs:
    """A spring to one surface of the bone for every ray beside the hole that meets it, of unit strength per mm2.

    Parameters
    ----------
    radius_map : RadiusMap
    radius : ndarray, shape (M, M)
        The vault's outer or inner radii.
    spans : tuple of int
        Of the sheet.

    Returns
    -------
    Springs
        To points in mm along the map's axes from the head's centre.
    """
    # points of the bone along the map's axes; each pulls the parameters of its own ray
    known = np.isfinite(radius) & ~radius_map.hole
    points = (radius_map.grid.directions[known] * radius[known][:, None]) @ radius_map.grid.axes.T
    # ray index -> parameter: the sheet's spans cover the map from edge to edge
    v, u = (i * n / (len(radius) - 1) for i, n in zip(np.nonzero(known), spans, strict=True))
    return Springs(points, v, u, np.full(len(points), radius_map.step_mm**2))


def radii_of(one: Sheet, radius_map: RadiusMap) -> NDArray[np.float64]:
    """Radius of a sheet along every ray into the hole or near it, shape (M, M), mm; nan elsewhere.

    Parameters
    ----------
    one : Sheet
        In mm along the map's axes from the head centre.
    radius_map : RadiusMap

    Returns
    -------
    ndarray, shape (M, M)
        mm.
    """
    # parameters and rays are not the same: the ray v, u may meet the sheet at other parameters
    near = ndimage.binary_dilation(radius_map.hole, iterations=3)
    wanted = np.argwhere(near).astype(float)
    scale = np.array(one.spans) / (len(radius_map.outer) - 1)
    at = wanted
    # fixed-point iteration: the point at some parameters lies on a ray; move by what that ray is off
    for _ in range(_FIND_STEPS):
        points = one.at(*(at * scale).T)
        at = np.clip(
            at + wanted - radius_map.grid.locate(points @ radius_map.grid.axes).T, 0, len(radius_map.outer) - 1
        )
    radius = np.full(radius_map.hole.shape, np.nan)
    radius[near] = np.linalg.norm(one.at(*(at * scale).T), axis=1)
    return radius


def _sphere(points: NDArray[np.float64], radius_map: RadiusMap, spans: tuple[int, int]) -> Sheet:
    """The sheet on the sphere that best fits points around the hole, each ray at its own place."""
    # |p - c|^2 = r^2 is linear in c and r^2 - |c|^2
    system = np.column_stack([2 * points, np.ones(len(points))])
    squares, weight = (points**2).sum(axis=1), np.ones(len(points))
    # Cauchy's weights: a ridge or a dent does not move the sphere
    for _ in range(_SPHERE_ROUNDS):
        x = np.linalg.lstsq(system * weight[:, None], squares * weight, rcond=None)[0]
        radius = np.sqrt(x[3] + x[:3] @ x[:3])
        off = np.abs(np.linalg.norm(points - x[:3], axis=1) - radius)
        weight = 1 / (1 + (off / (3 * np.median(off) + 1e-6)) ** 2)
    # where each ray leaves that sphere: t = d c + sqrt((d c)^2 + r^2 - |c|^2)
    along = radius_map.grid.directions @ radius_map.grid.axes.T
    middle = along @ x[:3]
    away = middle + np.sqrt(np.maximum(middle**2 + x[3], 0.0))
    # a sheet through all these points with next to no bending
    v, u = np.indices(away.shape).reshape(2, -1) * np.array(spans)[:, None] / (len(away) - 1)
    springs = Springs((along * away[..., None]).reshape(-1, 3), v, u, np.ones(away.size))
    return sheet.settle(springs, sheet.flat(spans), Material((0.0, 0.0, 1e-6, 1e-6, 1e-6)))[0]


def _inside(radius_map: RadiusMap, radius: NDArray[np.float64]) -> NDArray[np.float64]:
    """A radius map with nan outside the hole."""
    return np.where(radius_map.hole, radius, np.nan)


def _entries(made: Sheets) -> list[dict[str, Any]]:
    """JSON-able record of the outer and the inner sheet."""
    weights = [(float(part.weights.min()), float(part.weights.max())) for part in (made.outer, made.inner)]
    return [
        {"spans": list(made.outer.spans), "weights": list(w), "n_iter": n, "converged": c}
        for w, n, c in zip(weights, made.n_iter, made.converged, strict=True)
    ]
