"""A finished run -> its folder of files, all of them or none.

Meshes and `design.json` are in world mm, DICOM LPS; the patch stands on the input's own grid (NIfTI counts in RAS).
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version
from os import PathLike
from pathlib import Path
from typing import Any

from ..evaluation.paper_tables import balloon_ranges, count_statuses
from ..geometry.mesh_check import check_mesh
from ..implant.mass import weigh_implant
from ..methods.catalogue import default_options
from ..pipeline.run import RunResult
from ..prosthesis import Prosthesis
from ..readers import LoadReport
from . import files
from .staging import check_folder, staged

FILES = ("prosthesis.stl", "patch.nii.gz", "design.json", "report.html")
"""What a run leaves in its folder."""
_LIBRARIES = ("numpy", "scipy", "scikit-image", "pydicom", "nibabel", "pynrrd", "trimesh", "manifold3d")


def write_outputs(result: RunResult, folder: Path, tell: Callable[[str, float], None] | None = None) -> None:
    """Write the files of a run into a folder that is there.

    Parameters
    ----------
    result : RunResult
    folder : Path
        Usually the one from `staged`.
    tell : callable, optional
        Called with (step, fraction of the whole).

    Raises
    ------
    CannotWrite
        If the mesh is not a solid, or a file cannot be written.
    """
    from .design_page import report_page

    tell = tell or (lambda step, done: None)
    tell("writing", 0.85)
    stl, report = folder / "prosthesis.stl", result.mesh
    files.write_mesh(result.prosthesis.mesh, stl, n_parts=report.n_parts, report=report)
    if result.prosthesis.patch is not None:
        files.write_nifti(result.prosthesis.patch, folder / "patch.nii.gz", order=result.case.load.order)
    files.write_json(folder / "design.json", design_record(result))
    tell("report", 0.92)
    files.write_text(folder / "report.html", report_page(result))
    tell("done", 1.0)


def save(made: Prosthesis, folder: str | PathLike[str], report: LoadReport | None = None) -> list[Path]:
    """Save a design: its mesh, its voxels and how it was made; all files or none.

    Parameters
    ----------
    made : Prosthesis
    folder : path
        Made if missing.
    report : LoadReport, optional
        Of the scan: with it the voxels stand on the scan's own grid, axis by axis.

    Returns
    -------
    list of Path
        ``prosthesis.stl`` (world mm, LPS), ``patch.nii.gz`` where there are voxels, and ``design.json``.

    Raises
    ------
    CannotWrite
        If the mesh is not a solid, or a file cannot be written; nothing is left behind then.
    """
    folder = Path(folder)
    check_folder(folder, FILES)
    mesh = check_mesh(made.mesh)
    with staged(folder) as part:
        files.write_mesh(made.mesh, part / "prosthesis.stl", n_parts=mesh.n_parts, report=mesh)
        if made.patch is not None:
            files.write_nifti(made.patch, part / "patch.nii.gz", order=None if report is None else report.order)
        files.write_json(
            part / "design.json",
            made_record(made) | {"mesh": mesh, "load": None if report is None else load_record(report)},
        )
        names = [path.name for path in part.iterdir()]
    return [folder / name for name in FILES if name in names]


def made_record(made: Prosthesis) -> dict[str, Any]:
    """What `design.json` says of the design itself.

    Returns
    -------
    dict
        JSON-able after `files.jsonable`.
    """
    slices = made.record.get("slices", [])
    return {
        "cranio_nb": version("cranio-nb"),
        "not_for_clinical_use": True,
        "world": "DICOM LPS, mm",
        "method": made.method,
        "parameters": default_options(made.method) | made.parameters,
        "slices": slices,
        "slice_counts": count_statuses(slices),
        "balloons": balloon_ranges(slices),
        "implant": weigh_implant(made.mesh),
        "versions": versions(),
    }


def design_record(result: RunResult) -> dict[str, Any]:
    """What `design.json` says of a run. No text of the input's headers, no path.

    Returns
    -------
    dict
        JSON-able after `files.jsonable`.
    """
    return made_record(result.prosthesis) | {
        "load": load_record(result.case.load),
        "bone_threshold_hu": result.case.threshold,
        "openings": result.sizes,
        "preset": result.preset,
        "findings": result.findings,
        "measures": measures(result),
        "mesh": result.mesh,
        "seconds": result.seconds,
    }


def load_record(load: LoadReport) -> dict[str, Any]:
    """What `design.json` says of the input."""
    return {
        "source": load.source,
        "kind": load.kind,
        "shape": load.shape,
        "spacing_mm": load.spacing,
        "corner_error_mm": load.corner_error,
        "findings": load.findings,
    }


def measures(result: RunResult) -> dict[str, Any]:
    """Fit of the rim, and the scores where a truth was given (else null)."""
    truth = result.truth
    return {
        "rim_gap_mm": result.rim,
        "score": None if truth is None else truth.score,
        "table3_voxels": None if truth is None else truth.table3,
    }


def versions() -> dict[str, str]:
    """Versions of Python and of the libraries that shape a result."""
    found = {"python": sys.version.split()[0]}
    for name in _LIBRARIES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "missing"
    return found
