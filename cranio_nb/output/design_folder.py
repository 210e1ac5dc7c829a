"""A finished run -> its folder of files, all of them or none.

Meshes and `design.json` are in world mm, DICOM LPS; the patch stands on the input's own grid (NIfTI counts in RAS).
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from ..errors import CannotWrite
from ..evaluation.paper_tables import balloon_ranges, count_statuses
from ..implant.workshop import implant_data
from ..pipeline.run import RunResult, parameters_used
from ..readers import LoadReport
from . import files

FILES = ("prosthesis.stl", "patch.nii.gz", "design.json", "report.html")
"""What a run leaves in its folder."""
_LIBRARIES = ("numpy", "scipy", "scikit-image", "pydicom", "nibabel", "pynrrd", "trimesh", "manifold3d")


def check_folder(folder: Path, names: tuple[str, ...] = FILES) -> None:
    """Refuse, before any work is done, a folder that cannot take the files; nothing is made.

    Raises
    ------
    CannotWrite
        A file is in the way of the folder, a folder in the way of a file, or writing is not allowed.
    """
    folder = folder.absolute()
    there = next(p for p in (folder, *folder.parents) if os.path.lexists(p))
    if not os.path.isdir(there):
        raise CannotWrite("CannotWrite", "A file is in the way of the output folder.", "Name another folder.")
    if not os.access(there, os.W_OK | os.X_OK):
        raise CannotWrite("CannotWrite", "Writing into the output folder is not allowed.", "Name another folder.")
    blocked = [name for name in names if os.path.isdir(folder / name)]
    if blocked:
        message = f"A folder named {blocked[0]} is in the way of the output file."
        raise CannotWrite("CannotWrite", message, "Name another folder.")


@contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """A hidden folder to write into; its contents get their place in `folder` only if all goes well.

    Files of the same names are replaced, each at once; others in `folder` stay. Subfolders of the same names are
    replaced as a whole.

    Raises
    ------
    CannotWrite
        If the system refuses.
    """
    folder = folder.absolute()
    made: list[Path] = []
    try:
        if not folder.exists():
            made = [p for p in folder.parents if not p.exists()]
            folder.parent.mkdir(parents=True, exist_ok=True)
        home = folder if folder.exists() else folder.parent
        with tempfile.TemporaryDirectory(prefix=".part-", dir=home) as temporary:
            part = Path(temporary) / "files"
            part.mkdir()
            yield part
            _publish(part, folder)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise CannotWrite("CannotWrite", f"The output could not be written: {reason}.") from error
    finally:
        for parent in made:
            if parent.exists() and not any(parent.iterdir()):
                parent.rmdir()


def _publish(part: Path, folder: Path) -> None:
    """Move what was written to where it belongs."""
    if not folder.exists():
        part.replace(folder)
        return
    items = sorted(part.iterdir(), key=lambda p: FILES.index(p.name) if p.name in FILES else -1)
    for item in items:
        goal = folder / item.name
        if goal.is_dir() and not goal.is_symlink():
            goal.replace(part.parent / f"old-{item.name}")
        item.replace(goal)


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


def design_record(result: RunResult) -> dict[str, Any]:
    """What `design.json` says. No text of the input's headers, no path.

    Returns
    -------
    dict
        JSON-able after `export.jsonable`.
    """
    made, load = result.prosthesis, result.case.load
    slices = made.record.get("slices", [])
    return {
        "cranio_nb": version("cranio-nb"),
        "not_for_clinical_use": True,
        "world": "DICOM LPS, mm",
        "load": load_record(load),
        "bone_threshold_hu": result.case.threshold,
        "openings": result.sizes,
        "method": made.method,
        "preset": result.preset,
        "parameters": parameters_used(result),
        "slices": slices,
        "slice_counts": count_statuses(slices),
        "balloons": balloon_ranges(slices),
        "findings": result.findings,
        "measures": measures(result),
        "mesh": result.mesh,
        "implant": implant_data(made.mesh),
        "seconds": result.seconds,
        "versions": versions(),
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
