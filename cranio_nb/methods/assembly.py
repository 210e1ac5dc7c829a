"""Voxels to be worn -> a `Prosthesis`: the last step of every method.

Frames: voxel (plane, row, col) in, world mm (LPS) out.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..geometry import face_sides
from ..opening import Opening
from ..prosthesis import Prosthesis
from ..stages import surface_reconstruction
from ..volume import Volume


def assemble(
    patch: NDArray[np.bool_],
    bone: Volume,
    openings: Sequence[Opening],
    method: str,
    options: dict[str, Any],
    *,
    began: float,
    working: Sequence[Any],
    record: dict[str, Any] | None = None,
) -> Prosthesis:
    """Give a patch its surface and its papers.

    Parameters
    ----------
    patch : ndarray of bool, shape (P, R, C)
        Voxels on the grid of the bone, at least one of them set.
    bone : Volume
        Bool mask of the skull.
    openings : sequence of Opening
        What the patch closes; the outer side of the mesh is seen from the first one's head centre.
    method : str
        Name of the method.
    options : dict
        All options of the method; ``smooth`` is heeded here.
    began : float
        `time.perf_counter` at the start of the design.
    working : sequence
        What the method keeps for those who want to look inside.
    record : dict, optional
        JSON-able facts beside version and seconds.
    """
    worn = bone.with_voxels(patch)
    mesh = surface_reconstruction.extract_surface(worn, smooth=options["smooth"])
    sides = face_sides.label_faces(mesh, bone, openings[0].head_centre)
    facts = {"version": version("cranio-nb"), "seconds": time.perf_counter() - began, **(record or {})}
    return Prosthesis(mesh, sides, worn, method, options, facts, tuple(working))
