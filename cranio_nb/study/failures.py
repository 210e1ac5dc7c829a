"""What failed and what was warned of: by reason, and a picture of the skulls that runs failed on."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..drawing import figures
from ..drawing.coarse_skull import skull_surface
from ..mesh import Mesh
from ..output.pages import Shot, shot
from ..stages.segmentation import segment
from ..stages.surface_reconstruction import extract_surface
from ..volume import Volume
from .cases import Case, load_case
from .store import Columns

_PX_MM = 0.9  # size of a pixel


@dataclass(frozen=True)
class Reason:
    """Runs that ended alike without a prosthesis.

    Parameters
    ----------
    status, code, message : str
        Of the first of them; the code is what they share.
    runs : int
    cases, contenders : tuple of str
    """

    status: str
    code: str
    message: str
    runs: int
    cases: tuple[str, ...]
    contenders: tuple[str, ...]


def reasons(columns: Columns) -> list[Reason]:
    """Why runs failed or were refused.

    Parameters
    ----------
    columns : Columns

    Returns
    -------
    list of Reason
        The most frequent first.
    """
    lost = columns["status"] != "done"
    found = []
    for code in dict.fromkeys(columns["code"][lost]):
        own = np.flatnonzero(lost & (columns["code"] == code))
        status, message = columns["status"][own[0]], columns["message"][own[0]]
        cases, rivals = (tuple(dict.fromkeys(columns[name][own])) for name in ("case", "contender"))
        found.append(Reason(status, code, message, len(own), cases, rivals))
    return sorted(found, key=lambda reason: -reason.runs)


@dataclass(frozen=True)
class Warned:
    """A warning, and the cases that it is about.

    Parameters
    ----------
    code, message : str
        The message is that of the first case.
    cases : tuple of str
    """

    code: str
    message: str
    cases: tuple[str, ...]


def warned(columns: Columns) -> list[Warned]:
    """What a person has to check in the cases: doubtful openings that were left open, thick slices and the like.

    Parameters
    ----------
    columns : Columns

    Returns
    -------
    list of Warned
        That of most cases first.
    """
    found: dict[str, tuple[str, dict[str, None]]] = {}
    for case, said in dict.fromkeys(zip(columns["case"], columns["warnings"], strict=True)):
        for sentence in json.loads(said or "[]"):
            code, message = sentence.split(": ", 1)
            found.setdefault(code, (message, {}))[1][case] = None
    made = [Warned(code, message, tuple(cases)) for code, (message, cases) in found.items()]
    return sorted(made, key=lambda one: -len(one.cases))


def failure_shots(found: Sequence[Reason], cases: Sequence[Case], most: int = 6) -> list[Shot]:
    """Pictures of skulls that runs failed on, of each reason one before any gets a second.

    Parameters
    ----------
    found : sequence of Reason
    cases : sequence of Case
        Those that can still be read; others have no picture.
    most : int
        Pictures at most.

    Returns
    -------
    list of Shot
    """
    known = {case.name: case for case in cases}
    codes: dict[str, list[str]] = {}
    for turn in range(max((len(reason.cases) for reason in found), default=0)):
        for reason in found:
            if turn < len(reason.cases) and reason.cases[turn] in known:
                codes.setdefault(reason.cases[turn], []).append(reason.code)
    shots: list[Shot] = []
    for name, why in codes.items():
        if len(shots) < most and (made := _case_shot(known[name], ", ".join(dict.fromkeys(why)))) is not None:
            shots.append(made)
    return shots


def _case_shot(case: Case, why: str) -> Shot | None:
    """A case from the side of what is missing; None where it cannot be read or holds no bone."""
    try:
        made = load_case(case)
        bone, truth = segment(made.scan), made.truth
    except Exception:  # whatever keeps it from being read is among the reasons already
        return None
    missing = Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.intp)) if truth is None else extract_surface(truth)
    view = figures.skull_view(skull_surface(bone), _towards(bone, truth), px_mm=_PX_MM)
    alt = f"Shaded view of the skull of {case.name} in ivory, and what is missing in blue where it is known; bar 50 mm."
    return shot(figures.view_figure(view, missing), alt=alt, caption=f"{case.name}: {why}")


def _towards(bone: Volume, truth: Volume | None) -> NDArray[np.float64]:
    """From the middle of the bone to what is missing; up and to the front where that is not known."""
    if truth is None:
        return np.array([0.4, -0.6, 0.7])
    middle, missing = (mask.to_world(np.argwhere(mask.voxels)).mean(axis=0) for mask in (bone, truth))
    return np.asarray(missing - middle)
