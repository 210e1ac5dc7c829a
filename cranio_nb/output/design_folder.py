"""A finished run -> its folder of files, all of them or none.

Meshes and `design.json` are in world mm, DICOM LPS; the patch is on the input's own grid (NIfTI counts in RAS).
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from importlib.metadata import PackageNotFoundError, version
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..evaluation.paper_tables import balloon_ranges, count_statuses
from ..geometry.mesh_check import MeshReport, check_mesh
from ..grid import AxisOrder
from ..implant.mass import weigh_implant
from ..methods.catalogue import default_options, is_method
from ..pipeline.input_digest import case_label
from ..pipeline.preparation import Prepared
from ..pipeline.run import RunResult, run_design
from ..prosthesis import Prosthesis
from ..readers import LoadReport
from . import files
from .guard import check_writes
from .manifest import MANIFEST
from .mesh_files import write_mesh
from .nifti_files import write_nifti
from .staging import staged

if TYPE_CHECKING:
    from .painter import Painter

FILES = ("prosthesis.stl", "patch.nii.gz", "design.json", "report.html")
"""What a run leaves in its folder."""
_LIBRARIES = ("numpy", "scipy", "scikit-image", "pydicom", "nibabel", "pynrrd", "trimesh", "manifold3d")


def run_and_draw(painter: Painter, case: Prepared, **options: Any) -> tuple[RunResult, Future[str]]:
    """Design and measure; what is shown is drawn meanwhile.

    Parameters
    ----------
    painter : Painter
        At work until the page that it promises is fetched.
    case : Prepared
    **options
        As for `run_design`.

    Returns
    -------
    RunResult
    Future of str
        Its page, for `write_outputs`.

    Raises
    ------
    InputRefused, NoOpening
        As `run_design`.
    """
    painter.look_at(case)
    result = run_design(case, shaped=painter.draw_patch, designed=painter.draw, **options)
    return result, painter.page(result)


def write_outputs(
    result: RunResult,
    folder: Path,
    page: Future[str],
    progress: Callable[[str, float], None] | None = None,
) -> None:
    """Write the `FILES` of a run.

    Parameters
    ----------
    result : RunResult
    folder : Path
        Must be there; usually the one from `staging.staged`.
    page : Future of str
        Its page, from `run_and_draw`.
    progress : callable, optional
        Called with (step, fraction of the whole).

    Raises
    ------
    CannotWrite
        If the mesh is not a solid, or a file cannot be written.
    """
    progress = progress or (lambda step, done: None)
    progress("writing", 0.85)
    # packing and the disk leave the processor to the record and to the pictures, which are drawn meanwhile
    with ThreadPoolExecutor(1) as beside:
        shapes = beside.submit(_write_shapes, result.prosthesis, folder, result.mesh, result.case.load.order)
        files.write_json(folder / "design.json", design_record(result))
        progress("report", 0.92)
        files.write_text(folder / "report.html", page.result())
        shapes.result()  # or what kept it from being written
    progress("done", 1.0)


def _write_shapes(made: Prosthesis, folder: Path, mesh: MeshReport, order: AxisOrder | None) -> None:
    """Write the mesh of a design, and its voxels where it has them."""
    write_mesh(made.mesh, folder / "prosthesis.stl", n_parts=mesh.n_parts, report=mesh)
    if made.patch is not None:
        write_nifti(made.patch, folder / "patch.nii.gz", order=order)


def save(made: Prosthesis, folder: str | PathLike[str], report: LoadReport | None = None) -> list[Path]:
    """Save a design: its mesh, its voxels and how it was made; all files or none.

    Parameters
    ----------
    made : Prosthesis
    folder : path
        Made if missing.
    report : LoadReport, optional
        Of the scan: with it the voxels are on the scan's own grid, axis by axis.

    Returns
    -------
    list of Path
        ``prosthesis.stl`` (world mm, LPS), ``patch.nii.gz`` where there are voxels, and ``design.json``.

    Raises
    ------
    CannotWrite
        If the mesh is not a solid, or a file cannot be written; nothing is left behind then.

    Examples
    --------
    >>> import numpy as np
    >>> from cranio_nb.stages.surface_reconstruction import extract_surface
    >>> from cranio_nb.volume import Volume
    >>> cube = np.zeros((8, 8, 8), bool)
    >>> cube[2:6, 2:6, 2:6] = True
    >>> patch = Volume(cube, np.eye(4))
    >>> made = Prosthesis(extract_surface(patch), np.zeros(0, np.uint8), patch, "hull")
    >>> [path.name for path in save(made, "out")]
    ['prosthesis.stl', 'patch.nii.gz', 'design.json']
    """
    # what can be refused is refused before anything is written
    folder = Path(folder)
    check_writes(folder, (*FILES, MANIFEST))
    mesh = check_mesh(made.mesh)
    with staged(folder, FILES) as part:
        _write_shapes(made, part, mesh, None if report is None else report.order)
        load = None if report is None else load_record(report)
        files.write_json(part / "design.json", made_record(made) | {"mesh": mesh, "load": load})
        written = {path.name for path in part.iterdir()}
    return [folder / name for name in FILES if name in written]


def made_record(made: Prosthesis) -> dict[str, Any]:
    """What `design.json` says of the design itself.

    Parameters
    ----------
    made : Prosthesis

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
        "parameters": (default_options(made.method) if is_method(made.method) else {}) | made.parameters,
        "slices": slices,
        "slice_counts": count_statuses(slices),
        "balloons": balloon_ranges(slices),
        "implant": weigh_implant(made.mesh),
        "versions": versions(),
    }


def design_record(result: RunResult) -> dict[str, Any]:
    """What `design.json` says of a run: no text of the input's headers, no path.

    Parameters
    ----------
    result : RunResult

    Returns
    -------
    dict
        JSON-able after `files.jsonable`.
    """
    return made_record(result.prosthesis) | {
        "case": case_label(result.case.digests["scan"]),
        "finished": result.finished.isoformat(timespec="seconds"),
        "input_sha256": result.case.digests,
        "load": load_record(result.case.load),
        "bone_threshold_hu": result.case.threshold,
        "openings": [one.record() for one in result.case.closed],
        "left_open": [one.record() for one in result.case.left_open],
        "preset": result.preset,
        "findings": result.findings,
        "measures": measures(result),
        "mesh": result.mesh,
        "seconds": result.seconds,
    }


def load_record(load: LoadReport) -> dict[str, Any]:
    """What `design.json` says of the input: no text of its headers, no path.

    Parameters
    ----------
    load : LoadReport

    Returns
    -------
    dict
        JSON-able after `files.jsonable`.
    """
    return {
        "source": load.source,
        "kind": load.kind,
        "shape": load.shape,
        "spacing_mm": load.spacing,
        "corner_error_mm": load.corner_error,
        "findings": load.findings,
    }


def measures(result: RunResult) -> dict[str, Any]:
    """What `design.json` says of how good a design is.

    Parameters
    ----------
    result : RunResult

    Returns
    -------
    dict
        Fit of the rim, and the scores; None for what could not be measured.
    """
    truth = result.truth
    return {
        "rim_gap_mm": result.rim,
        "score": None if truth is None else truth.score,
        "table3_voxels": None if truth is None else truth.table3,
    }


def versions() -> dict[str, str]:
    """Versions of Python and of the libraries that shape a result.

    Returns
    -------
    dict of str to str
        Name -> version, or "missing".

    Examples
    --------
    >>> list(versions())[:3]
    ['python', 'numpy', 'scipy']
    """
    found = {"python": sys.version.split()[0]}
    for name in _LIBRARIES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "missing"
    return found
