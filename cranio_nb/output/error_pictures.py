"""Where a design lies farthest from the truth: the place of each side in words and numbers, and a cut through it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..drawing import figures
from ..evaluation.against_truth import SIDES
from ..pipeline.run import RunResult
from ..vault.opening_size import name_place
from .pages import Shot, shot

_REACH_MM = 32.0  # shown to the left and right of the place


@dataclass(frozen=True, eq=False)
class LargestError:
    """The node of one side of a prosthesis that is farthest from the true surface.

    Parameters
    ----------
    side : str
        "outer" or "inner".
    distance_mm : float
    point : ndarray, shape (3,)
        World mm, LPS.
    place : str
        The same in words.
    voxel : tuple of int
        Plane, row and column of the scan.
    cut : str
        Name of the cut, one of `figures.CUTS`, that shows it best: the one that runs most straight out of the head.
    """

    side: str
    distance_mm: float
    point: NDArray[np.float64]
    place: str
    voxel: tuple[int, ...]
    cut: str


def largest_errors(result: RunResult) -> list[LargestError]:
    """The largest distance of each side from the truth, and where it is.

    Parameters
    ----------
    result : RunResult

    Returns
    -------
    list of LargestError
        Empty without a truth.
    """
    if result.truth is None:
        return []
    found = []
    for side, distances in result.truth.distances.items():
        worst = int(np.argmax(distances))
        point = result.prosthesis.surface(SIDES[side]).vertices[worst]
        voxel = tuple(int(i) for i in np.rint(result.case.bone.to_voxel(point)))
        away = point - result.case.openings[0].head_centre
        out = away / np.linalg.norm(away)
        axes = result.case.openings[0].head_axes
        place = name_place(out if axes is None else axes @ out)
        found.append(LargestError(side, float(distances[worst]), point, place, voxel, _cut_along(out)))
    return found


def _cut_along(out: NDArray[np.float64]) -> str:
    """The cut in whose plane a direction lies most."""
    return max(figures.CUTS, key=lambda name: float(np.hypot(*(np.array(figures.CUTS[name]) @ out))))


def error_shots(result: RunResult, errors: list[LargestError]) -> list[Shot]:
    """A cut through each of the largest errors: bone and missing bone as areas, the patch as a line, the place ringed.

    Parameters
    ----------
    result : RunResult
        With a truth and a patch.
    errors : list of LargestError

    Returns
    -------
    list of Shot
    """
    bone, truth, patch = result.case.bone, result.case.truth, result.prosthesis.patch
    shots = []
    for one in errors:
        axes = figures.CUTS[one.cut]
        patches = [] if patch is None else [patch]
        figure = figures.outlines_figure(bone, truth, patches, centre=one.point, axes=axes, reach_mm=_REACH_MM)
        figures.ring_place(figure.axes[0], 0.0, 0.0)
        alt = (
            f"{one.cut.capitalize()} cut through the largest error of the {one.side} side ({one.place}): bone grey, the"
            f" missing bone light blue, the designed patch as a line, and a ring around the place where they are"
            f" {one.distance_mm:.2f} mm apart; letters name the sides; scale bar 20 mm."
        )
        caption = f"{one.side.capitalize()} side, {one.cut} cut: {one.distance_mm:.2f} mm in the ring"
        shots.append(shot(figure, alt=alt, caption=caption))
    return shots
