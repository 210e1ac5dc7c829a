"""A prepared skull -> a designed and measured prosthesis.

For the command line, notebooks and studies; nothing is written here (see `output`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

import numpy as np

from ..errors import InputRefused
from ..evaluation.against_truth import TruthCheck, check_truth
from ..evaluation.paper_tables import count_crossed, count_not_converged, count_statuses
from ..evaluation.rim_gap import GapStats, rim_gap
from ..geometry.mesh_check import MeshReport, check_mesh
from ..grid import true_indices
from ..mesh import RIM
from ..methods.catalogue import default_options
from ..methods.design import design
from ..opening import Opening
from ..prosthesis import Prosthesis
from ..readers import Finding
from ..vault.remarks import opening_remarks
from ..volume import Volume
from .preparation import Clock, Prepared, Progress, check_margin, touches_border

_THIN = 2.0  # mm: a wall that workshops begin to warn about
_BESIDE = 20.0  # mm beside an opening within which a patch may reach


@dataclass(frozen=True, eq=False)
class RunResult:
    """Everything one run found and made.

    Parameters
    ----------
    case : Prepared
        The scan and its openings.
    preset : str
    prosthesis : Prosthesis
    mesh : MeshReport
    rim : GapStats or None
        Fit of the rim; None without a rim.
    truth : TruthCheck or None
    findings : tuple of Finding
        What to know about the design.
    seconds : dict of str to float
        Time of each step.
    finished : datetime
        When it was done, UTC.
    """

    case: Prepared
    preset: str
    prosthesis: Prosthesis
    mesh: MeshReport
    rim: GapStats | None
    truth: TruthCheck | None
    findings: tuple[Finding, ...] = ()
    seconds: dict[str, float] = field(default_factory=dict)
    finished: datetime = field(default_factory=lambda: datetime.now(UTC))


def run_design(
    case: Prepared,
    *,
    method: str = "slicewise",
    preset: str = "default",
    progress: Progress | None = None,
    shaped: Callable[[Prosthesis], None] | None = None,
    designed: Callable[[Prosthesis], None] | None = None,
    **options: Any,
) -> RunResult:
    """Design what closes the openings of a scan, and measure it.

    Parameters
    ----------
    case : Prepared
        What `prepare` made of the scan.
    method, preset, **options
        As for `design`.
    progress : callable, optional
        Called with (step, fraction of the whole run, of which `prepare` is the first 0.4).
    shaped : callable, optional
        As for `design`: called with the prosthesis before it has a surface.
    designed : callable, optional
        Called with the prosthesis before it is measured: its pictures may begin.

    Returns
    -------
    RunResult

    Raises
    ------
    InputRefused
        What cannot be designed or compared safely.
    NoOpening
        When there is nothing to close.

    Examples
    --------
    >>> import cranio_nb as cn
    >>> from cranio_nb.output.nifti_files import write_nifti
    >>> from data_synth import phantom_case
    >>> case = phantom_case("tiny", "burr_hole", 0)
    >>> write_nifti(cn.Volume(case.bone, case.affine), "skull.nii.gz")
    >>> result = cn.run_design(cn.prepare("skull.nii.gz"), method="hull", axial=True)
    >>> result.prosthesis.parameters, result.mesh.sound, result.case.bone.shape
    ({'axial': True, 'smooth': True}, True, ...)
    """
    report = progress or (lambda step, done: None)
    clock = Clock(case.seconds)
    made = design(
        case.bone,
        case.openings,
        method=method,
        preset=preset,
        progress=lambda step, done: report(step, 0.4 + 0.4 * done),
        shaped=shaped,
        **options,
    )
    check_patch(made, case.openings)
    clock.lap("design")
    if designed is not None:
        designed(made)
    report("measuring", 0.8)
    mesh = check_mesh(made.mesh)
    rim = rim_gap(made.surface(RIM), case.bone) if (made.sides == RIM).any() else None
    check = None if case.truth is None else check_truth(made, case.truth, case.bone, case.openings[0].head_centre)
    clock.lap("measures")
    found = (*opening_remarks(case.closed, case.left_open), *_findings(made, mesh, case.openings))
    return RunResult(case, preset, made, mesh, rim, check, found, clock.seconds)


def check_patch(made: Prosthesis, openings: Sequence[Opening]) -> None:
    """Refuse a patch that touches the border of its grid, and say whether the image or the method is to blame.

    Parameters
    ----------
    made : Prosthesis
    openings : sequence of Opening
        Those it closes.

    Raises
    ------
    InputRefused
        ``OpeningLeavesImage`` where the opening lies beside the border, ``PatchLeavesOpening`` where the patch runs
        away from the opening.
    """
    if made.patch is None or not touches_border(made.patch):
        return
    away = _farthest(made.patch, openings)
    if away > _BESIDE:
        message = (
            f"The method {made.method} did not bridge the opening: in places its patch runs up to {away:.0f} mm away"
            " from it, to the edge of the image."
        )
        raise InputRefused("PatchLeavesOpening", message, "Use another method or preset.")
    check_margin(made.patch, "The prosthesis")


def parameters_used(result: RunResult) -> dict[str, Any]:
    """Every parameter of the method with the value it had.

    Parameters
    ----------
    result : RunResult

    Returns
    -------
    dict
    """
    return default_options(result.prosthesis.method) | result.prosthesis.parameters


def _findings(made: Prosthesis, mesh: MeshReport, openings: tuple[Opening, ...]) -> tuple[Finding, ...]:
    """What a reader of the result must not miss."""
    slices = made.record.get("slices", [])
    counts, restless = count_statuses(slices), count_not_converged(slices)
    candidates = {
        "CrossedCurves": (
            count_crossed(slices),
            "In {} slices the outer and the inner curve cross: do not trust the shape there.",
        ),
        "CarriedSlices": (counts["carried"], "{} slices could not be bridged and follow their neighbours."),
        "SkippedSlices": (counts["skipped"], "{} slices could not be bridged and were left empty."),
        "NotConverged": (restless, "In {} slices a balloon was stopped before it came to rest."),
        "FaultyMesh": (0 if mesh.sound else 1, "The mesh is not a sound solid."),
    }
    found = [Finding(c, "warning", text.format(n), {"count": n}) for c, (n, text) in candidates.items() if n]
    if mesh.n_parts != len(openings):
        message = f"Separate parts of the prosthesis: {mesh.n_parts}; openings that it closes: {len(openings)}."
        found.append(Finding("SeparateParts", "warning", message, {"parts": mesh.n_parts, "openings": len(openings)}))
    if mesh.wall_p1 < _THIN:
        message = f"The wall is thinner than {mesh.wall_p1:.1f} mm over 1 % of the surface."
        found.append(Finding("ThinWall", "warning", message, {"wall_p1_mm": mesh.wall_p1}))
    return tuple(found)


def _farthest(patch: Volume, openings: Sequence[Opening]) -> float:
    """Largest distance of a patch's voxels from the boxes around the openings, mm."""
    index = true_indices(patch.voxels)
    distances = []
    for opening in openings:
        held = true_indices(opening.sheet.voxels)
        beyond = np.maximum(np.maximum(held.min(axis=0) - index, index - held.max(axis=0)), 0)
        distances.append(np.linalg.norm(beyond * patch.spacing, axis=1))
    return float(np.min(distances, axis=0).max())
