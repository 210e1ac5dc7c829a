"""Meshes -> STL, PLY and 3MF, written only if they are solids and read back as they were.

Frame: world mm, DICOM LPS. 3MF says so itself; STL and PLY carry no unit.
"""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import CannotWrite
from ..geometry.mesh_check import MeshReport, check_mesh
from ..mesh import Mesh
from .files import write_whole

MESH_FORMATS = (".stl", ".ply", ".3mf")
"""Suffixes that `write_mesh` knows."""
_TOLERANCE_MM = 1e-3  # single precision keeps 6e-5 mm at 800 mm


def write_mesh(mesh: Mesh, path: str | Path, *, n_parts: int = 1, report: MeshReport | None = None) -> None:
    """Write a solid as binary STL, PLY or 3MF.

    Parameters
    ----------
    mesh : Mesh
        World mm.
    path : str or Path
        The suffix chooses the format: .stl, .ply or .3mf.
    n_parts : int
        Number of pieces the mesh is meant to have.
    report : MeshReport, optional
        `check_mesh` of this mesh, where it has been made already.

    Raises
    ------
    CannotWrite
        If the mesh is not a solid (MeshInvalid), in memory or as read back; if the suffix is none of the three
        (BadFormat); or if the file cannot be written (CannotWrite).

    Examples
    --------
    >>> import trimesh
    >>> cube = trimesh.creation.box()
    >>> write_mesh(Mesh(cube.vertices, cube.faces), "cube.stl")
    >>> float(trimesh.load_mesh("cube.stl").volume)
    1.0
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in MESH_FORMATS:
        raise CannotWrite("BadFormat", f"{path.name} has no known mesh suffix; use {', '.join(MESH_FORMATS)}.")
    validate(mesh, n_parts=n_parts, report=report)
    write_whole(path, _trimesh(mesh).export(file_type=suffix[1:]), lambda part: _check_mesh_file(part, mesh))


def validate(mesh: Mesh, *, n_parts: int = 1, report: MeshReport | None = None) -> MeshReport:
    """Make sure that a mesh is a solid.

    Parameters
    ----------
    mesh : Mesh
        World mm.
    n_parts : int
        Number of pieces wanted.
    report : MeshReport, optional
        `check_mesh` of this mesh, where it has been made already.

    Returns
    -------
    MeshReport
        The report of the mesh that passed.

    Raises
    ------
    CannotWrite
        MeshInvalid, saying the first thing that is wrong.

    Examples
    --------
    >>> import trimesh
    >>> cube = trimesh.creation.box()
    >>> validate(Mesh(cube.vertices, cube.faces)).sound
    True
    """
    # first our own checks, which say what is wrong and where; then those of two other libraries
    report = check_mesh(mesh) if report is None else report
    faults = {
        "it has no faces": report.n_faces == 0,
        f"{report.n_unclear} faces are not finite, have no area or are there twice": report.n_unclear > 0,
        f"{report.n_open_edges} edges do not join two faces": report.n_open_edges > 0,
        f"{report.n_flipped_edges} edges join faces of opposite winding": report.n_flipped_edges > 0,
        f"it is pinched at {report.n_pinches} vertices": report.n_pinches > 0,
        f"it has {report.n_parts} parts and {n_parts} are wanted": report.n_parts != n_parts,
        f"its volume is {report.volume:.3g} mm3": not report.volume > 0,
        f"{report.n_crossings} pairs of faces pass through each other": report.n_crossings > 0,
    }
    found = [fault for fault, there in faults.items() if there]
    if not found and not _peers_agree(mesh):
        found = ["manifold3d or trimesh does not take it for a solid"]
    if found:
        raise CannotWrite("MeshInvalid", f"The mesh is not a solid: {found[0]}.", "Extract or design it again.")
    return report


def _trimesh(mesh: Mesh) -> Any:
    """The mesh as trimesh holds it, vertices and faces untouched."""
    import trimesh

    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)


def _peers_agree(mesh: Mesh) -> bool:
    """Whether manifold3d and trimesh, with their own tests, take the mesh for a solid."""
    import manifold3d

    solid = manifold3d.Mesh64(np.ascontiguousarray(mesh.vertices, float), np.ascontiguousarray(mesh.faces, np.uint64))
    return manifold3d.Manifold(solid).status() == manifold3d.Error.NoError and bool(_trimesh(mesh).is_volume)


def _check_mesh_file(part: Path, mesh: Mesh) -> None:
    """Read a mesh file back and compare it, corner by corner."""
    import trimesh

    # STL keeps no shared vertices, so faces are compared by the places of their corners
    back = trimesh.load_mesh(part)
    same = len(back.faces) == len(mesh.faces) and back.is_volume
    if not same or np.abs(_corners(back, mesh) - mesh.corners).max() > _TOLERANCE_MM:
        raise CannotWrite("MeshInvalid", "The mesh does not survive its file: it reads back as another one.")
    if part.suffix.lower() == ".3mf":
        with zipfile.ZipFile(part) as package:
            if b'unit="millimeter"' not in package.read("3D/3dmodel.model"):
                raise CannotWrite("MeshInvalid", "The 3MF file does not say that its unit is the millimetre.")


def _corners(back: Any, mesh: Mesh) -> NDArray[np.float64]:
    """Corners of a mesh read back, each face turned so that it starts at the corner the written one starts at."""
    corners = np.asarray(back.triangles)
    start = np.linalg.norm(corners - mesh.corners[:, :1], axis=2).argmin(axis=1)
    turn = (start[:, None] + np.arange(3)) % 3
    return np.take_along_axis(corners, turn[:, :, None], axis=1)
