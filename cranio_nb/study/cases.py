"""What a case is -> a scan, and the missing bone where it is known: by path, made by a seed, or cut into a whole skull.

Frames: volumes as `read_ct` gives them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InputRefused
from ..pipeline.truth_file import read_truth
from ..readers import Finding, read_ct, warnings_of
from ..volume import Volume

_STEP_MM = 5  # by which a hole shrinks until it fits its skull


@dataclass(frozen=True)
class Case:
    """A skull of a study.

    Parameters
    ----------
    name : str
        Unique in its study, and shown; it holds no path of the machine.
    kind : str
        One of `SOURCES`.
    source : dict
        What it is made of: plain values, part of its identity. Paths are relative to `folder`.
    folder : str
        Where paths start; not part of its identity, so that a study may be moved with its scans.
    """

    name: str
    kind: str
    source: dict[str, Any]
    folder: str = field(default="", compare=False)

    @property
    def facts(self) -> dict[str, Any]:
        """What was asked of its hole.

        Returns
        -------
        dict
            "defect" (empty for a scan), "seed" (None for a scan), "asked_mm" (None where the size is the kind's own).
        """
        asked = self.source
        return {"defect": asked.get("defect", ""), "seed": asked.get("seed"), "asked_mm": asked.get("diameter_mm")}


@dataclass(frozen=True, eq=False)
class LoadedCase:
    """A case as it was read or made.

    Parameters
    ----------
    scan : Volume
        HU, or a bool mask of the bone.
    truth : Volume or None
        Bool mask of the missing bone, on the same grid.
    warnings : tuple of Finding
        What the files warn of.
    """

    scan: Volume
    truth: Volume | None
    warnings: tuple[Finding, ...] = ()


def scan_cases(
    paths: Sequence[str],
    *,
    truth: str | None = None,
    mask: bool | None = None,
    folder: str | Path = "",
) -> list[Case]:
    """Scans with a hole.

    Parameters
    ----------
    paths : sequence of str
        DICOM folders, NIfTI or NRRD files, relative to `folder`.
    truth : str, optional
        Name of the file beside each of them with the mask of the missing bone.
    mask : bool, optional
        As for `read_ct`.
    folder : path
        Where the paths start.

    Returns
    -------
    list of Case
        Named after the paths.
    """
    found = []
    for path in paths:
        beside = None if truth is None else (Path(path).parent / truth).as_posix()
        found.append(Case(path, "scan", {"path": path, "truth": beside, "mask": mask}, str(folder)))
    return found


def phantom_cases(
    defects: Sequence[str], seeds: Sequence[int], *, size: str = "class", head: str = "simple"
) -> list[Case]:
    """Synthetic heads, each defect with each seed.

    Parameters
    ----------
    defects : sequence of str
        Names in `data_synth.DEFECTS`.
    seeds : sequence of int
        Each chooses head, place, size and rim.
    size, head : str
        As for `data_synth.head_case`.

    Returns
    -------
    list of Case

    Examples
    --------
    >>> [case.name for case in phantom_cases(["vertex"], [0, 1], size="tiny")]
    ['simple-tiny-vertex-0', 'simple-tiny-vertex-1']
    """
    return [
        Case(f"{head}-{size}-{defect}-{seed}", "phantom", {"head": head, "size": size, "defect": defect, "seed": seed})
        for seed in seeds
        for defect in defects
    ]


def cut_case(
    path: str,
    defect: str,
    seed: int,
    *,
    diameter_mm: int | None = None,
    mask: bool | None = None,
    folder: str | Path = "",
) -> Case:
    """A whole skull with a hole cut into it.

    Parameters
    ----------
    path : str
        CT or mask of a whole skull, relative to `folder`.
    defect : str
        A name in `data_synth.DEFECTS`.
    seed : int
        Chooses side, exact place, outline and rim.
    diameter_mm : int, optional
        Mean diameter; a hole that is too wide for its skull is made as wide as fits, in steps of 5 mm. By default the
        kind's own.
    mask : bool, optional
        As for `read_ct`.
    folder : path
        Where the path starts.

    Returns
    -------
    Case
    """
    source = {"path": path, "defect": defect, "seed": seed, "diameter_mm": diameter_mm, "mask": mask}
    return Case(f"{path}-{defect}-{diameter_mm or 'own'}-{seed}", "cut", source, str(folder))


def load_case(case: Case) -> LoadedCase:
    """Read or make a case.

    Parameters
    ----------
    case : Case

    Returns
    -------
    LoadedCase

    Raises
    ------
    InputRefused
        What cannot be read safely; ``CannotCut`` where no hole can be cut or made.

    Examples
    --------
    >>> made = load_case(phantom_cases(["burr_hole"], [0], size="tiny")[0])
    >>> made.scan.shape, made.truth.voxels.any()
    ((44, 128, 128), np.True_)
    """
    return SOURCES[case.kind](Path(case.folder), **case.source)


def _scan(folder: Path, path: str, truth: str | None, mask: bool | None) -> LoadedCase:
    """A scan on disk."""
    scan, load = read_ct(folder / path, mask=mask)
    known, said = (None, ()) if truth is None else read_truth(folder / truth, scan)
    return LoadedCase(scan, known, (*warnings_of(load.findings), *said))


def _phantom(folder: Path, head: str, size: str, defect: str, seed: int) -> LoadedCase:
    """A synthetic head."""
    from data_synth import head_case

    try:
        made = head_case(head, size, defect, seed)
    except ValueError as error:
        raise InputRefused("CannotCut", str(error)) from error
    return LoadedCase(Volume(made.bone if made.hu is None else made.hu, made.affine), Volume(made.implant, made.affine))


def _cut(folder: Path, path: str, defect: str, seed: int, diameter_mm: int | None, mask: bool | None) -> LoadedCase:
    """A hole cut into a whole skull, as wide as it fits."""
    from data_synth import cut_case as open_skull

    whole, load = read_ct(folder / path, mask=mask)
    reason = ""
    for diameter in range(diameter_mm, 0, -_STEP_MM) if diameter_mm else (None,):
        try:
            made = open_skull(whole.voxels, whole.affine, defect, seed, is_mask=load.kind == "mask", diameter=diameter)
        except ValueError as error:
            reason = str(error)
            if "does not fit" not in reason:
                break
        else:
            scan = made.bone if made.hu is None else made.hu
            truth = whole.with_voxels(np.asarray(made.implant))
            return LoadedCase(whole.with_voxels(scan), truth, warnings_of(load.findings))
    raise InputRefused("CannotCut", reason or f"No hole of the kind {defect} fits this skull.")


SOURCES: dict[str, Callable[..., LoadedCase]] = {"scan": _scan, "phantom": _phantom, "cut": _cut}
"""The kinds of cases: each reads or makes one, ``(folder, **source)``."""
