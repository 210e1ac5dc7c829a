"""A design and the bone that is known to be missing -> how far apart they are.

Frame: masks on the bone's grid; distances in mm, those of Table 3 in voxels as in the paper.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import evaluate, surface
from .errors import InputRefused
from .evaluate import Score
from .prosthesis import INNER, OUTER, DistanceStats, Lesion, Prosthesis
from .volume import Volume


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


def check_truth(made: Prosthesis, truth: Volume, bone: Volume, largest: Lesion) -> TruthCheck:
    """Measure a design against the missing bone.

    Parameters
    ----------
    made : Prosthesis
        With a patch.
    truth : Volume
        Bool mask of the missing bone on the grid of `bone`.
    bone : Volume
        The skull with the hole.
    largest : Lesion
        Its head centre tells outside from inside.
    """
    return against(made, true_prosthesis(truth, bone, largest), bone)


def true_prosthesis(truth: Volume, bone: Volume, largest: Lesion) -> Prosthesis:
    """The missing bone as a prosthesis: its mesh with sides. Parameters as in `check_truth`."""
    mesh = surface.extract(truth)
    return Prosthesis(mesh, surface.face_sides(mesh, bone, largest.head_centre), truth, "truth")


def against(made: Prosthesis, true: Prosthesis, bone: Volume) -> TruthCheck:
    """Measure a design against another prosthesis with a patch on the same grid; see `check_truth`."""
    if made.patch is None or true.patch is None:
        raise InputRefused("NoPatch", f"The method {made.method} makes no voxels to compare with a mask.")
    distances, table3 = {}, {}
    for name, side in (("outer", OUTER), ("inner", INNER)):
        own, other = made.surface(side), true.surface(side)
        if not len(own.faces) or not len(other.faces):
            continue
        distances[name] = evaluate.surface_distance(own.vertices, other)
        nodes = evaluate.in_voxels(own, bone).vertices
        table3[name] = evaluate.distance_stats(evaluate.surface_distance(nodes, evaluate.in_voxels(other, bone)))
    return TruthCheck(true, evaluate.score(made.patch, true.patch, bone), distances, table3)
