"""A scan on disk -> a designed and measured prosthesis: the whole pipeline as one call.

For the command line, notebooks and studies; nothing is written here (see `outputs`).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Collection
from dataclasses import dataclass, field, replace
from os import PathLike
from typing import Any

from ..errors import InputRefused, NoOpening
from ..evaluation.against_truth import TruthCheck, check_truth
from ..evaluation.opening_size import OpeningSize, measure_opening
from ..evaluation.paper_tables import count_not_converged, count_statuses
from ..evaluation.rim_gap import GapStats, rim_gap
from ..geometry.mesh_check import MeshReport, check_mesh
from ..methods.catalogue import default_options
from ..methods.design import check_request, design
from ..opening import Opening
from ..prosthesis import RIM, Prosthesis
from ..readers import Finding, LoadReport, read_ct
from ..stages.segmentation import bone_of, threshold_of
from ..vault.head_frame import find_head_frame
from ..vault.opening_search import find_openings
from ..vault.remarks import remarks
from ..volume import Volume, same_grid

Progress = Callable[[str, float], None]
_THIN = 2.0  # mm: a wall that workshops begin to warn about


@dataclass(frozen=True, eq=False)
class Prepared:
    """A scan as every method gets it.

    Parameters
    ----------
    load : LoadReport
    bone : Volume
        Bool mask the design stands on.
    openings : tuple of Opening
        The openings to close, the largest first.
    threshold : float or None
        HU of the bone threshold; None for a mask.
    truth : Volume or None
        Bool mask of the missing bone on the grid of `bone`.
    seconds : dict of str to float
        Time of each step.
    """

    load: LoadReport
    bone: Volume
    openings: tuple[Opening, ...]
    threshold: float | None
    truth: Volume | None
    seconds: dict[str, float]


@dataclass(frozen=True, eq=False)
class RunResult:
    """Everything one run found and made.

    Parameters
    ----------
    case : Prepared
        The scan and its openings.
    sizes : tuple of OpeningSize
        Place and size of each opening.
    preset : {"default", "paper"}
    prosthesis : Prosthesis
    mesh : MeshReport
    rim : GapStats or None
        Fit of the rim; None without a rim.
    truth : TruthCheck or None
    findings : tuple of Finding
        What to know about the design.
    seconds : dict of str to float
        Time of each step.
    """

    case: Prepared
    sizes: tuple[OpeningSize, ...]
    preset: str
    prosthesis: Prosthesis
    mesh: MeshReport
    rim: GapStats | None
    truth: TruthCheck | None
    findings: tuple[Finding, ...] = ()
    seconds: dict[str, float] = field(default_factory=dict)


def run_design(
    path: str | PathLike[str],
    *,
    method: str = "slicewise",
    preset: str = "default",
    options: dict[str, Any] | None = None,
    mask: bool | None = None,
    threshold: float | None = None,
    planes: tuple[int, int] | None = None,
    truth: str | PathLike[str] | None = None,
    allow: Collection[str] = (),
    progress: Progress | None = None,
) -> RunResult:
    """Read a scan, find its openings, design what closes them, and measure it.

    Parameters
    ----------
    path : path
        DICOM folder, NIfTI or NRRD file with a CT in HU or a bone mask.
    method : str
        A key of `catalogue.METHODS`.
    preset : {"default", "paper"}
        Options to start from.
    options : dict, optional
        Options of the method that differ from the preset.
    mask : bool, optional
        As for `read_ct`: True takes every nonzero voxel as bone. By default data of 0 and 1 are a mask.
    threshold : float, optional
        Lowest HU of bone; `segmentation.BONE_HU` when not given.
    planes : tuple of int, optional
        First and last plane (both included): only what lies between them is closed.
    truth : path, optional
        Mask of the missing bone on the scan's own grid, to score the design against.
    allow : collection of str
        Relaxations for `read_ct`.
    progress : callable, optional
        Called with (step, fraction of the whole).

    Returns
    -------
    RunResult

    Raises
    ------
    InputRefused
        What cannot be read, designed or compared safely.
    NoOpening
        When there is nothing to close.
    """
    options = dict(options or {})
    check_request(method, preset, options)
    tell = progress or (lambda step, done: None)
    case = prepare(path, mask=mask, threshold=threshold, planes=planes, truth=truth, allow=allow, progress=tell)
    clock = _Clock(case.seconds)
    made = design_inside(
        case.bone, case.openings, method, preset, options, lambda step, done: tell(step, 0.4 + 0.4 * done)
    )
    clock.lap("design")
    tell("measuring", 0.8)
    mesh = check_mesh(made.mesh)
    rim = rim_gap(made.surface(RIM), case.bone) if (made.sides == RIM).any() else None
    check = None if case.truth is None else check_truth(made, case.truth, case.bone, case.openings[0].head_centre)
    clock.lap("measures")
    found = _findings(made, mesh, case.openings)
    sizes = tuple(measure_opening(one) for one in case.openings)
    return RunResult(case, sizes, preset, made, mesh, rim, check, found, clock.seconds)


def prepare(
    path: str | PathLike[str],
    *,
    mask: bool | None = None,
    threshold: float | None = None,
    planes: tuple[int, int] | None = None,
    truth: str | PathLike[str] | None = None,
    allow: Collection[str] = (),
    progress: Progress | None = None,
) -> Prepared:
    """Read a scan and find its openings: all that comes before a design. Parameters and errors as in `run_design`."""
    tell = progress or (lambda step, done: None)
    clock = _Clock()
    tell("reading", 0.0)
    scan, load = read_ct(path, mask=mask, allow=allow, progress=lambda i, n: tell("reading", 0.3 * i / n))
    known = None if truth is None else read_truth(truth, scan)
    clock.lap("read")
    tell("bone", 0.3)
    bone = bone_of(scan, threshold)
    frame = find_head_frame(bone)
    load = replace(load, findings=(*load.findings, *remarks(bone, frame)))
    found = find_openings(bone, scan=scan, frame=frame)
    openings = found if planes is None else within_planes(found, planes)
    _check_room([one.sheet for one in openings], "The opening of the skull")
    clock.lap("bone and openings")
    return Prepared(load, bone, openings, threshold_of(scan, threshold), known, clock.seconds)


def within_planes(openings: tuple[Opening, ...], planes: tuple[int, int]) -> tuple[Opening, ...]:
    """The parts of the openings in planes first..last (both included); openings elsewhere are left.

    Raises
    ------
    InputRefused
        ``BadPlanes`` when the range is empty or outside the volume.
    NoOpening
        ``NoOpening`` when no opening meets it.
    """
    first, last = planes
    n_planes = openings[0].sheet.shape[0]
    if not 0 <= first <= last < n_planes:
        raise InputRefused("BadPlanes", f"Planes {first} to {last} are not a range within 0 to {n_planes - 1}.")
    parts = []
    for one in openings:
        voxels = one.sheet.voxels.copy()
        voxels[:first] = voxels[last + 1 :] = False
        if voxels.any():
            parts.append(replace(one, sheet=one.sheet.with_voxels(voxels)))
    if not parts:
        spans = ", ".join(f"{a} to {b - 1}" for a, b in (one.planes for one in openings))
        message = f"No opening lies in planes {first} to {last}; openings were found in planes {spans}."
        raise NoOpening("NoOpening", message)
    return tuple(parts)


def read_truth(path: str | PathLike[str], scan: Volume) -> Volume:
    """Read the mask of the missing bone that belongs to a scan.

    Raises
    ------
    InputRefused
        ``GridMismatch`` or ``EmptyMask``, or what reading refuses.
    """
    truth, _ = read_ct(path, mask=True)
    if not same_grid(scan, truth):
        message = f"The truth has shape {truth.shape}, the scan {scan.shape}, or they stand at different places."
        raise InputRefused("GridMismatch", message, "Give a truth mask on the scan's own grid.")
    if not truth.voxels.any():
        raise InputRefused("EmptyMask", "The truth mask is empty; there is nothing to compare with.")
    return truth


def design_inside(
    bone: Volume,
    openings: tuple[Opening, ...],
    method: str,
    preset: str,
    options: dict[str, Any],
    progress: Progress | None = None,
) -> Prosthesis:
    """`methods.design`, refused where the prosthesis reaches the edge of the image (``OpeningLeavesImage``)."""
    made = design(bone, openings, method=method, preset=preset, progress=progress, **options)
    _check_room([] if made.patch is None else [made.patch], "The prosthesis")
    return made


def parameters_used(result: RunResult) -> dict[str, Any]:
    """Every parameter of the method with the value it had."""
    return default_options(result.prosthesis.method) | result.prosthesis.parameters


def _findings(made: Prosthesis, mesh: MeshReport, openings: tuple[Opening, ...]) -> tuple[Finding, ...]:
    """What a reader of the result must not miss."""
    slices = made.record.get("slices", [])
    counts, restless = count_statuses(slices), count_not_converged(slices)
    candidates = {
        "CarriedSlices": (counts["carried"], "{} slices could not be bridged and follow their neighbours."),
        "SkippedSlices": (counts["skipped"], "{} slices could not be bridged and were left empty."),
        "NotConverged": (restless, "In {} slices a balloon was stopped before it came to rest."),
        "FaultyMesh": (0 if mesh.sound else 1, "The mesh is not a sound solid."),
    }
    found = [Finding(c, "warning", text.format(n), {"count": n}) for c, (n, text) in candidates.items() if n]
    if mesh.n_parts != len(openings):
        message = f"The prosthesis has {mesh.n_parts} separate parts for {len(openings)} openings."
        found.append(Finding("SeparateParts", "warning", message, {"parts": mesh.n_parts, "openings": len(openings)}))
    if mesh.wall_p1 < _THIN:
        message = f"The wall is thinner than {mesh.wall_p1:.1f} mm over 1 % of the surface."
        found.append(Finding("ThinWall", "warning", message, {"wall_p1_mm": mesh.wall_p1}))
    return tuple(found)


def _check_room(masks: list[Volume], what: str) -> None:
    """Refuse what touches the border of its grid: it may go on outside."""
    if any(mask.voxels.take(end, axis).any() for mask in masks for axis in range(3) for end in (0, -1)):
        raise InputRefused(
            "OpeningLeavesImage",
            f"{what} reaches the edge of the image, where it would be cut off.",
            "Use a scan that covers the whole opening and some room around it.",
        )


class _Clock:
    """Seconds of each step."""

    def __init__(self, before: dict[str, float] | None = None) -> None:
        self.seconds = dict(before or {})
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        now = time.perf_counter()
        self.seconds[name] = now - self._last
        self._last = now
