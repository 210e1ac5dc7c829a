"""The paper's method: every slice bridged by two balloons, the slices stacked into a patch.

Bone mask in, pieces out. Source: the VISAPP 2011 paper, doi 10.5220/0003356601370142.

Faithful is the preset "paper": axial slices, skeleton and convex hull, tangent lines, the constant pressure, 21
snaxels, the hull for slices of partial loss. The defaults are ours: slices that fan out from inside the head and cross
the hole in several directions, whose answers are averaged by their certainty; rims seen along rays; tangents at the
rim itself, shared between neighbouring slices; a start curve and a pressure that follow from them (`curves.spiral`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Any

from ...geometry import voxel_pieces
from ...opening import Opening
from ...options import Option, Work
from ...stages import deformable_model
from ...volume import Volume
from ..piece import Piece
from . import axial as axial_slices
from . import fanned
from .slices import Settings, SlicedDesign

_PAPER_SKIP_MM = 4.5  # the paper's 10 boundary points at 0.45 mm, as it gives no pixel size: 512 of them span a head
_PAPER_REACH_PX = 10.0  # the paper gives none: as many points again, since a line through fewer of them is unsure


def paper_options(bone: Volume) -> dict[str, Any]:
    """Options of `pieces` as the paper sets them, for a given grid.

    Parameters
    ----------
    bone : Volume
        Its pixel size turns the paper's k, 0.062 px per index squared, and the points of the tangent line into mm.

    Returns
    -------
    dict
    """
    # the skip is the paper's length in mm; k and the reach are counts of this scan's pixels
    px = float(bone.spacing[1:].mean())
    return {
        "axial": True,
        "skip_mm": _PAPER_SKIP_MM,
        "reach_mm": _PAPER_REACH_PX * px,
        "pressure_mm": deformable_model.PAPER_PRESSURE * px,
        "n_snaxels": 21,
        "coupling_mm": 0.0,
        "smooth": False,
    }


PRESETS = {"paper": paper_options}
"""The method as published in 2011."""

WORK = Work(
    "In each slice, the steps of all points of its balloons",
    2_500_000,  # one option may be at its end beside the defaults of the others
    lambda options: (1 if options["axial"] else options["directions"]) * options["n_snaxels"] * options["max_iter"],
    "Lower max_iter, n_snaxels or directions.",
)
"""The balloons that do not come to rest decide how long a design can take."""

MOST_MOVES = 40_000_000
"""Steps of single points in a design, some seconds: how many slices an opening has is not known before, nor how many
steps a small `tol` takes. Balloons that move on then are stopped and said not to be at rest."""


def pieces(
    bone: Volume,
    openings: Sequence[Opening],
    *,
    axial: Annotated[bool, Option("As the paper: the planes of the scan, not fans from inside the head.")] = False,
    # from 24 on the fans stand 7.5 degrees apart, and more of them change nothing
    directions: Annotated[int, Option("In how many directions the fans cross the hole.", 1, 24, usual=(1, 8))] = 6,
    # bone is known for 0.75 rad, some 55 mm, beside the hole: both together need most of it at most
    skip_mm: Annotated[float, Option("Boundary left out next to the gap.", 0, 20, "mm", usual=(0, 15))] = 1.5,
    # three rays, 0.4 mm apart, fix a tangent and its bend
    reach_mm: Annotated[float, Option("Boundary fitted after that.", 1, 40, "mm", usual=(4, 30))] = 10.0,
    # 21 snaxels at the upper end rise by k N^2 / 8 = 50 mm, more than any vault does over a hole
    pressure_mm: Annotated[
        float | None,
        Option("Constant k, outward positive; without it k follows from the ends.", -0.1, 1, "mm per index squared"),
    ] = None,
    # a fourth difference needs five points; 201 lie closer than voxels across the widest hole
    n_snaxels: Annotated[int, Option("Points of a balloon, ends included.", 5, 201, usual=(11, 81))] = 41,
    # k is made for a tension near 1: with 0 nothing holds the balloon against it
    tension: Annotated[float, Option("w1, against stretching.", 0.5, 10, "ds^2", usual=(0.5, 5))] = 1.0,
    rigidity: Annotated[float, Option("w2, against bending; 0 for none.", 0, 10, "ds^4", usual=(0.1, 5))] = 1.0,
    # shorter steps look like rest, longer ones leap over it
    dt: Annotated[float, Option("Time step.", 0.1, 10, "units of the model's own time")] = 1.0,
    # below 1e-9 rounding moves a curve; a balloon that may still move 1 a step is not at rest
    tol: Annotated[float, Option("Change of a curve in a step at which it rests.", 1e-9, 1, "mm (px if axial)")] = 1e-3,
    # the usual ones rest within some hundred steps; the slowest take seconds for these many
    max_iter: Annotated[int, Option("Steps at most.", 1, 5000)] = 2000,
    # over more than 20 mm the rim itself turns
    coupling_mm: Annotated[
        float, Option("Standard deviation over which slices share tangents; 0 for none.", 0, 20, "mm", usual=(0, 10))
    ] = 4.0,
) -> Iterator[Piece]:
    """Close each opening slice by slice.

    Parameters
    ----------
    bone, openings
        As for `methods.design.design`.
    axial : bool
        As the paper: the planes of the scan, features by skeleton and convex hull.
        Otherwise fans of planes from inside the head, features along rays.
    directions : int
        In how many directions the fans cross the hole; 1 is the one across its short side.
    skip_mm, reach_mm : float
        Boundary left out next to the gap, and fitted after that, mm of arc length.
    pressure_mm : float, optional
        Constant k, mm per index squared, outward positive. When not given, k follows from the end tangents.
    n_snaxels : int
        Points of a balloon, ends included.
    tension, rigidity, dt, max_iter
        As for `deformable_model.inflate`.
    tol : float
        As for `deformable_model.inflate`, in px of axial slices and in mm of the others.
    coupling_mm : float
        Standard deviation in mm over which tangents are shared between neighbouring slices of a fan; 0 for none.

    Yields
    ------
    Piece
        The record's `slices` hold one entry per slice: direction, plane, status, reason, angles, lengths, iterations,
        convergence. `working` holds a `SlicedDesign` per direction.
    """
    # the balloon's k is a length per index squared, so that it changes with the unit of the slices
    unit = float(bone.spacing[1:].mean()) if axial else 1.0  # mm per unit of the slices
    pressure = None if pressure_mm is None else pressure_mm / unit
    settings = Settings(n_snaxels, pressure, tension, rigidity, dt, tol, max_iter, MOST_MOVES / max(1, len(openings)))
    for opening in openings:
        made: tuple[SlicedDesign, ...]
        if axial:
            one, voxels = axial_slices.bridge(
                bone, opening, skip_px=skip_mm / unit, reach_px=reach_mm / unit, settings=settings
            )
            made = (one,)
        else:
            made, voxels = fanned.bridge(
                bone,
                opening,
                directions=directions,
                skip_mm=skip_mm,
                reach_mm=reach_mm,
                coupling_mm=coupling_mm,
                settings=settings,
            )
        slices = [{"direction": i, **s.record()} for i, sliced in enumerate(made) for s in sliced.slices]
        yield Piece(voxel_pieces.keep_main_piece(voxels, opening.sheet.voxels), made, {"slices": slices})
