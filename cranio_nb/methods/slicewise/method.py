"""The paper's method: every slice bridged by two balloons, the slices stacked into a patch.

Bone mask in, pieces out. Source: the VISAPP 2011 paper, doi 10.5220/0003356601370142.

Faithful is the preset "paper": axial slices, skeleton and convex hull, tangent lines, the constant pressure, 21
snaxels, the hull for slices of partial loss. The defaults are ours: slices that fan out from inside the head and cross
the hole in several directions, whose answers are averaged by their certainty; rims seen along rays; tangents at the
rim itself, shared between neighbouring slices; a start curve and a pressure that follow from them (`curves.spiral`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ...geometry import voxel_pieces
from ...opening import Opening
from ...stages import deformable_model
from ...volume import Volume
from ..piece import Piece
from . import axial as axial_slices
from . import fanned
from .slices import Settings, SlicedDesign

_PAPER_SKIP_MM = 4.5  # the 10 boundary points that the paper leaves out, at its pixel of 0.45 mm
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


def pieces(
    bone: Volume,
    openings: Sequence[Opening],
    *,
    axial: bool = False,
    directions: int = 6,
    skip_mm: float = 1.5,
    reach_mm: float = 10.0,
    pressure_mm: float | None = None,
    n_snaxels: int = 41,
    tension: float = 1.0,
    rigidity: float = 1.0,
    dt: float = 1.0,
    tol: float = 1e-3,
    max_iter: int = 2000,
    coupling_mm: float = 4.0,
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
        In how many directions the fans cross the hole; 1 is the best single one, across its short side.
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
    settings = Settings(n_snaxels, pressure, tension, rigidity, dt, tol, max_iter)
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
