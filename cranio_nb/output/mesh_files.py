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
from ..geometry.mesh_check import MeshReport, check_mesh, is_closed
from ..mesh import Mesh
from .files import write_whole

MESH_FORMATS = (".stl", ".ply", ".3mf")
"""Suffixes that `write_mesh` knows."""
_STL_HEAD = 84
_STL_FACE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
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
    if suffix == ".stl":
        write_whole(path, _stl_bytes(mesh), lambda part: _check_stl_file(part, mesh))
        return
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
    # first our own checks, which say what is wrong and where; then those of another library
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
    if not found and not _is_solid(mesh):
        found = ["manifold3d does not take it for a solid"]
    if found:
        raise CannotWrite("MeshInvalid", f"The mesh is not a solid: {found[0]}.", "Extract or design it again.")
    return report


def _trimesh(mesh: Mesh) -> Any:
    """The mesh as trimesh holds it, vertices and faces untouched."""
    import trimesh

    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)


def _is_solid(mesh: Mesh) -> bool:
    """Whether manifold3d, with its own tests, takes a mesh for a solid."""
    import manifold3d

    same = manifold3d.Mesh64(np.ascontiguousarray(mesh.vertices, float), np.ascontiguousarray(mesh.faces, np.uint64))
    solid = manifold3d.Manifold(same)
    return solid.status() == manifold3d.Error.NoError and solid.volume() > 0


def _stl_bytes(mesh: Mesh) -> bytes:
    """A binary STL: 80 bytes of no meaning, the number of faces, and a record for each."""
    records = np.zeros(len(mesh.faces), _STL_FACE)
    records["normal"], records["corners"] = mesh.normals, mesh.corners
    return bytes(80) + np.uint32(len(records)).astype("<u4").tobytes() + records.tobytes()


def _check_stl_file(part: Path, mesh: Mesh) -> None:
    """Read an STL file back and compare it; joined where corners have one place, its faces must be closed again."""
    data = part.read_bytes()
    n_faces = int.from_bytes(data[80:_STL_HEAD], "little")
    whole = n_faces == len(mesh.faces) and len(data) == _STL_HEAD + n_faces * _STL_FACE.itemsize
    corners = np.frombuffer(data, _STL_FACE, offset=_STL_HEAD)["corners"] if whole else np.nan
    if not np.abs(corners - mesh.corners).max() <= _TOLERANCE_MM or not is_closed(_joined(mesh)):
        raise CannotWrite("MeshInvalid", "The mesh does not survive its file: it reads back as another one.")


def _joined(mesh: Mesh) -> Mesh:
    """The mesh with those vertices made one that lie at one place in single precision."""
    places, which = np.unique(mesh.vertices.astype(np.float32), axis=0, return_inverse=True)
    return Mesh(places.astype(float), which.ravel()[mesh.faces])


def _check_mesh_file(part: Path, mesh: Mesh) -> None:
    """Read a mesh file back and compare it, corner by corner."""
    import trimesh

    # faces are compared by the places of their corners
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
