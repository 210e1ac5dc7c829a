"""A design and the bone that is known to be missing -> how far apart they are.

Frame: masks on the bone's grid; distances in mm, those of Table 3 in voxels as in the paper.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InputRefused
from ..geometry import face_sides
from ..geometry.closest_point import nearest
from ..mesh import INNER, OUTER, Mesh
from ..prosthesis import DistanceStats, Prosthesis
from ..stages import surface_reconstruction
from ..volume import Volume
from .mesh_distances import distance_stats, in_voxels
from .scores import Score, score

SIDES = {"outer": OUTER, "inner": INNER}
"""The sides that are measured, by name."""


@dataclass(frozen=True, eq=False)
class TruthCheck:
    """A design against the bone that is known to be missing.

    Parameters
    ----------
    prosthesis : Prosthesis
        The truth as a mesh with sides.
    score : Score
        Overlap and surface distances of the voxels.
    distances : dict
        "outer" and "inner": distance in mm from each node of that side to the true one, shape (nodes,).
    table3 : dict
        "outer" and "inner": the same in voxels, summed up as in the paper's Table 3.
    """

    prosthesis: Prosthesis
    score: Score
    distances: dict[str, NDArray[np.float64]]
    table3: dict[str, DistanceStats]


def check_truth(made: Prosthesis, truth: Volume, bone: Volume, head_centre: NDArray[np.float64]) -> TruthCheck:
    """Measure a design against the missing bone.

    Parameters
    ----------
    made : Prosthesis
        With a patch.
    truth : Volume
        Bool mask of the missing bone on the grid of `bone`.
    bone : Volume
        The skull with the hole.
    head_centre : ndarray, shape (3,)
        World mm of a point inside the cranial cavity; the outer surface faces away from it.

    Returns
    -------
    TruthCheck

    Raises
    ------
    InputRefused
        ``NoPatch`` for a design without voxels; ``GridMismatch``.
    """
    return measure_against(made, true_prosthesis(truth, bone, head_centre), bone)


def true_prosthesis(truth: Volume, bone: Volume, head_centre: NDArray[np.float64]) -> Prosthesis:
    """The missing bone as a prosthesis: its mesh with sides.

    Parameters
    ----------
    truth, bone, head_centre
        As for `check_truth`.

    Returns
    -------
    Prosthesis
    """
    mesh = surface_reconstruction.extract_surface(truth)
    return Prosthesis(mesh, face_sides.label_faces(mesh, bone, head_centre), truth, "truth")


def measure_against(made: Prosthesis, true: Prosthesis, bone: Volume) -> TruthCheck:
    """Measure a design against another prosthesis.

    Parameters
    ----------
    made, true : Prosthesis
        With patches on one grid.
    bone : Volume
        As for `check_truth`.

    Returns
    -------
    TruthCheck

    Raises
    ------
    InputRefused
        As `check_truth`.
    """
    if made.patch is None or true.patch is None:
        raise InputRefused("NoPatch", f"The method {made.method} makes no voxels to compare with a mask.")
    # voxels of both against each other, then meshes side by side
    found = score(made.patch, true.patch, bone)
    return TruthCheck(true, found, side_distances(made, true), table3(made, true, bone))


def side_distances(made: Prosthesis, true: Prosthesis) -> dict[str, NDArray[np.float64]]:
    """Distance of each node of a side to the true side.

    Parameters
    ----------
    made, true : Prosthesis

    Returns
    -------
    dict of str to ndarray, shape (nodes,)
        "outer" and "inner", as far as both have them; mm.
    """
    return {name: nearest(own.vertices, other).distance for name, own, other in _both_sides(made, true)}


def table3(made: Prosthesis, true: Prosthesis, bone: Volume) -> dict[str, DistanceStats]:
    """Rows of the paper's Table 3.

    Parameters
    ----------
    made, true : Prosthesis
    bone : Volume
        Its grid counts the voxels.

    Returns
    -------
    dict of str to DistanceStats
        "outer" and "inner", as far as both have them; voxels.
    """
    found = {}
    for name, own, other in _both_sides(made, true):
        # both surfaces in voxels: on an unequal grid mm would weigh the axes otherwise
        nodes = in_voxels(own, bone).vertices
        found[name] = distance_stats(nearest(nodes, in_voxels(other, bone)).distance)
    return found


def _both_sides(made: Prosthesis, true: Prosthesis) -> list[tuple[str, Mesh, Mesh]]:
    sides = [(name, made.surface(side), true.surface(side)) for name, side in SIDES.items()]
    return [(name, own, other) for name, own, other in sides if len(own.faces) and len(other.faces)]
