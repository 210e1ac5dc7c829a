"""Meshes, masks and words -> files, written whole or not at all.

Frame: mesh files hold world mm, DICOM LPS (3MF says so itself; STL and PLY carry no unit). NIfTI files hold the
same places in RAS, as that format asks.

Every file is made under another name in its folder, brought to disk, read back and compared, and only then given its
name. What fails raises `CannotWrite` and leaves nothing behind.
"""

from __future__ import annotations

import dataclasses
import gzip
import io
import json
import math
import os
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import CannotWrite
from ..geometry.mesh_check import MeshReport, check_mesh
from ..grid import AxisOrder
from ..mesh import Mesh
from ..volume import Volume

MESH_FORMATS = (".stl", ".ply", ".3mf")
_MESH_TOLERANCE = 1e-3  # mm; single precision keeps 6e-5 mm at 800 mm
_AFFINE_TOLERANCE = 1e-3  # mm
_NIFTI_TYPES = ("uint8", "int16", "int32", "float32", "float64")
_LPS_TO_RAS = np.diag([-1.0, -1.0, 1.0, 1.0])


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
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in MESH_FORMATS:
        raise CannotWrite("BadFormat", f"{path.name} has no known mesh suffix; use {', '.join(MESH_FORMATS)}.")
    validate(mesh, n_parts=n_parts, report=report)
    _write_whole(path, _trimesh(mesh).export(file_type=suffix[1:]), lambda part: _check_mesh_file(part, mesh))


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
    """
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


def write_nifti(volume: Volume, path: str | Path, order: AxisOrder | None = None) -> None:
    """Write a mask or a CT as NIfTI (.nii or .nii.gz).

    Parameters
    ----------
    volume : Volume
        Bool is stored as uint8 0 / 1; uint8, int16, int32, float32 and float64 as they are.
    path : str or Path
        File name.
    order : AxisOrder, optional
        How the input's stored axes became (plane, row, col), from its `LoadReport`. With it the file stands on
        the input's own grid, axis by axis; without it the axes are (plane, row, col).

    Raises
    ------
    CannotWrite
        If the suffix or the type of the voxels is another one (BadFormat), or the file cannot be written.
    """
    path = Path(path)
    if not path.name.lower().endswith((".nii", ".nii.gz")):
        raise CannotWrite("BadFormat", f"{path.name} has no NIfTI suffix; use .nii or .nii.gz.")
    stored = volume if order is None else volume.reorder(order.inverse)
    voxels = stored.voxels.astype(np.uint8) if stored.voxels.dtype == bool else stored.voxels
    if voxels.dtype.name not in _NIFTI_TYPES:
        raise CannotWrite("BadFormat", f"Voxels of {voxels.dtype} cannot be stored; use {', '.join(_NIFTI_TYPES)}.")
    affine = _LPS_TO_RAS @ stored.affine
    data = _nifti_bytes(voxels, affine)
    if path.name.lower().endswith(".gz"):
        data = gzip.compress(data, compresslevel=4, mtime=0)
    _write_whole(path, data, lambda part: _check_nifti_file(part, voxels, affine))


def write_text(path: str | Path, text: str) -> None:
    """Write a text file in UTF-8; raises `CannotWrite`."""
    _write_whole(Path(path), text.encode(), lambda part: None)


def write_json(path: str | Path, data: Any) -> None:
    """Write dataclasses, dicts, sequences, arrays, numbers and text as strict JSON; raises `CannotWrite`.

    JSON knows no infinity: a number that is not finite becomes null.
    """
    write_text(path, json.dumps(jsonable(data), indent=2, ensure_ascii=False, allow_nan=False) + "\n")


def jsonable(data: Any) -> Any:
    """The same data in the types of strict JSON.

    Examples
    --------
    >>> jsonable({"gap": np.float32(0.5), "sizes": np.arange(3), "ratio": np.inf})
    {'gap': 0.5, 'sizes': [0, 1, 2], 'ratio': None}
    """
    if dataclasses.is_dataclass(data) and not isinstance(data, type):
        return {field.name: jsonable(getattr(data, field.name)) for field in dataclasses.fields(data)}
    if isinstance(data, dict):
        return {str(key): jsonable(value) for key, value in data.items()}
    if isinstance(data, np.ndarray | np.generic):
        return jsonable(data.tolist())
    if isinstance(data, list | tuple):
        return [jsonable(value) for value in data]
    if isinstance(data, float) and not math.isfinite(data):
        return None
    if data is None or isinstance(data, bool | int | float | str):
        return data
    raise CannotWrite("BadFormat", f"A {type(data).__name__} has no place in JSON.")


def output_folder(path: str | Path) -> Path:
    """Make sure that a folder is there and can be written.

    Raises
    ------
    CannotWrite
        If a file is in its way, or writing into it is not allowed.
    """
    path = Path(path)
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            return path
    except (FileExistsError, NotADirectoryError) as error:
        raise CannotWrite("CannotWrite", f"A file is in the way of the folder {path.name}.", "Name another.") from error
    except OSError as error:
        raise _cannot(f"The folder {path.name}", error) from error


def _write_whole(path: Path, data: bytes, check: Callable[[Path], None]) -> None:
    """Write to a hidden file beside the goal, check that, and rename it; remove it if anything fails."""
    part = path.with_name(f".part-{os.getpid()}-{path.name}")
    try:
        with part.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        check(part)
        part.replace(path)
        _sync_folder(path.parent)
    except OSError as error:
        raise _cannot(path.name, error) from error
    finally:
        _remove(part)


def _sync_folder(folder: Path) -> None:
    """Bring the new name to disk, where the system can do that for folders."""
    if not hasattr(os, "O_DIRECTORY"):
        return
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _remove(part: Path) -> None:
    try:
        part.unlink(missing_ok=True)
    except OSError:
        return  # the folder itself is gone or not to be written: there is nothing of ours in it


def _cannot(what: str, error: OSError) -> CannotWrite:
    """The system's own words without the path it adds to them."""
    return CannotWrite("CannotWrite", f"{what} could not be written: {error.strerror or type(error).__name__}.")


def _trimesh(mesh: Mesh) -> Any:
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

    back = trimesh.load_mesh(part)
    same = len(back.faces) == len(mesh.faces) and back.is_volume
    if not same or np.abs(_corners(back, mesh) - mesh.corners).max() > _MESH_TOLERANCE:
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


def _nifti_bytes(voxels: NDArray, affine: NDArray[np.float64]) -> bytes:
    """A NIfTI-1 file with both of its affines, mm, and no text."""
    import nibabel

    image = nibabel.Nifti1Image(voxels, affine)
    image.set_sform(affine, code=1)
    image.set_qform(affine, code=1)
    image.header.set_xyzt_units("mm")
    return image.to_bytes()


def _check_nifti_file(part: Path, voxels: NDArray, affine: NDArray[np.float64]) -> None:
    """Read a NIfTI file back and compare it."""
    import nibabel

    data = part.read_bytes()
    plain = gzip.decompress(data) if part.name.lower().endswith(".gz") else data
    back = nibabel.Nifti1Image.from_stream(io.BytesIO(plain))
    same = back.shape == voxels.shape and np.array_equal(np.asanyarray(back.dataobj), voxels)
    if not same or np.abs(back.affine - affine).max() > _AFFINE_TOLERANCE:
        raise CannotWrite("CannotWrite", "The volume does not survive its file: it reads back as another one.")
