"""A prepared skull and contenders -> what each of them made, measured alike, and how far they lie apart.

Frames: meshes in world mm (LPS), patches on the bone's grid; distances in mm, those of Table 3 in voxels.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import evaluate
from .errors import CranioError, NoOpening
from .fit import rim_gap
from .prosthesis import INNER, OUTER, RIM, Prosthesis
from .run import Prepared
from .trial import Attempt, Contender, Trial, attempt_apart
from .truth import against, true_prosthesis
from .volume import Volume

SIDES = {"outer": OUTER, "inner": INNER}
_UNKNOWN = float("nan")


@dataclass(frozen=True)
class Measure:
    """A column of the comparison.

    Parameters
    ----------
    label, unit : str
        Words of its head.
    digits : int
        Decimals shown.
    best : {"high", "low", ""}
        Which end is better; empty where neither is.
    needs_truth : bool
        Whether it says how near a known truth is.
    """

    label: str
    unit: str
    digits: int
    best: str = ""
    needs_truth: bool = False


MEASURES = {
    "dice": Measure("DSC", "", 3, "high", True),
    "border_dice": Measure("Border DSC", "", 3, "high", True),
    "hd95": Measure("HD95", "mm", 2, "low", True),
    "assd": Measure("ASSD", "mm", 2, "low", True),
    "thickness_rmse": Measure("Thickness RMSE", "mm", 2, "low", True),
    "top_mean": Measure("Table 3, top: mean", "voxels", 2, "low", True),
    "inner_mean": Measure("Table 3, inner: mean", "voxels", 2, "low", True),
    "volume_ratio": Measure("Volume ratio", "", 3, "", True),
    "volume": Measure("Volume", "cm³", 2),
    "thickness": Measure("Thickness", "mm", 2),
    "rim_gap": Measure("Rim gap: mean", "mm", 2, "low"),
    "rim_gap_p95": Measure("Rim gap: 95 %", "mm", 2, "low"),
    "overlap": Measure("Overlap with bone", "voxels", 0, "low"),
    "seconds": Measure("Time", "s", 1, "low"),
    "memory": Measure("Peak memory", "MB", 0, "low"),
}
"""Every column by its name in files: accuracy against a truth, the implant itself, its cost (`Trial`)."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Several methods on one skull.

    Parameters
    ----------
    case : Prepared
    trials : tuple of Trial
        One for each contender, in the order asked for.
    rows : tuple of dict
        For each trial its values of `MEASURES`; nan where there is none.
    reference : str
        "truth", or the name of the first contender that made a prosthesis; empty if none did.
    true : Prosthesis or None
        The missing bone, where it is known.
    distances : dict
        Name of each contender but the reference -> side ("outer", "inner") -> distance in mm of each node of that
        side to the reference's, shape (nodes,).
    pairs : dict
        Two names -> Dice and mean surface distance (mm) between their patches.
    """

    case: Prepared
    trials: tuple[Trial, ...]
    rows: tuple[dict[str, float], ...]
    reference: str
    true: Prosthesis | None
    distances: dict[str, dict[str, NDArray[np.float64]]]
    pairs: dict[tuple[str, str], tuple[float, float]]

    @property
    def made(self) -> dict[str, Prosthesis]:
        """The prostheses by the names of their contenders."""
        return {t.contender.name: t.prosthesis for t in self.trials if t.prosthesis is not None}

    @property
    def top(self) -> float:
        """Upper end of the one colour scale of all distance maps, mm: a round number above 99 % of all distances."""
        every = [d for sides in self.distances.values() for d in sides.values()]
        high = float(np.percentile(np.concatenate(every), 99)) if every else 0.0
        return max(0.5, float(np.ceil(2 * high) / 2))


def compare(
    case: Prepared,
    contenders: Sequence[Contender],
    *,
    attempt: Attempt = attempt_apart,
    progress: Callable[[str, float], None] | None = None,
) -> Comparison:
    """Let contenders close the same openings, and measure what they make.

    Parameters
    ----------
    case : Prepared
        Read and segmented once, for all of them.
    contenders : sequence of Contender
    attempt : callable
        How a trial is run; by default each in a process of its own, one after the other.
    progress : callable, optional
        Called with (name of the contender, fraction done).
    """
    tell = progress or (lambda step, done: None)
    true = None if case.truth is None else true_prosthesis(case.truth, case.bone, case.lesions[0])
    trials, rows = [], []
    for i, contender in enumerate(contenders):
        tell(contender.name, i / len(contenders))
        trials.append(attempt(case.bone, case.lesions, contender))
        rows.append(measure(trials[-1], case.bone, true))
    made = {t.contender.name: t.prosthesis for t in trials if t.prosthesis is not None}
    reference = "truth" if true is not None else next(iter(made), "")
    base = true or made.get(reference)
    distances = {name: surface_distances(p, base) for name, p in made.items() if base and p is not base}
    return Comparison(case, tuple(trials), tuple(rows), reference, true, distances, agreement(made))


def measure(trial: Trial, bone: Volume, true: Prosthesis | None = None) -> dict[str, float]:
    """Values of the `MEASURES` of a trial; nan where there is none, and all of them nan unless it was done.

    Parameters
    ----------
    trial : Trial
    bone : Volume
        The skull it was given.
    true : Prosthesis, optional
        The missing bone, from `truth.true_prosthesis`.
    """
    found = dict.fromkeys(MEASURES, _UNKNOWN)
    made = trial.prosthesis
    if made is None or made.patch is None:
        return found
    found |= {"seconds": trial.seconds, "memory": trial.memory}
    if true is not None:
        found |= _accuracy(made, true, bone)
    gap = rim_gap(made.surface(RIM), bone) if (made.sides == RIM).any() else None
    return found | {
        "volume": made.mesh.volume / 1000,
        "thickness": float(evaluate.thickness(made).mean()) if _has_sides(made) else _UNKNOWN,
        "rim_gap": gap.mean if gap else _UNKNOWN,
        "rim_gap_p95": gap.p95 if gap else _UNKNOWN,
        "overlap": evaluate.overlap(made.patch, bone),
    }


def _accuracy(made: Prosthesis, true: Prosthesis, bone: Volume) -> dict[str, float]:
    check = against(made, true, bone)
    score = check.score
    return {
        "dice": score.dice,
        "border_dice": score.border_dice,
        "hd95": score.hd95,
        "assd": score.assd,
        "volume_ratio": score.volume_ratio,
        "thickness_rmse": evaluate.thickness_rmse(made, true) if _has_sides(made) and _has_sides(true) else _UNKNOWN,
        "top_mean": check.table3["outer"].mean if "outer" in check.table3 else _UNKNOWN,
        "inner_mean": check.table3["inner"].mean if "inner" in check.table3 else _UNKNOWN,
    }


def surface_distances(made: Prosthesis, reference: Prosthesis) -> dict[str, NDArray[np.float64]]:
    """Side -> distance in mm of each of its nodes to the same side of a reference; sides that both have."""
    found = {}
    for name, side in SIDES.items():
        own, other = made.surface(side), reference.surface(side)
        if len(own.faces) and len(other.faces):
            found[name] = evaluate.surface_distance(own.vertices, other)
    return found


def agreement(made: dict[str, Prosthesis]) -> dict[tuple[str, str], tuple[float, float]]:
    """Dice and mean surface distance (mm) between the patches of each two prostheses."""
    patches = {name: p.patch for name, p in made.items() if p.patch is not None}
    return {
        (a, b): (evaluate.dice(patches[a], patches[b]), evaluate.assd(patches[a], patches[b]))
        for a, b in combinations(patches, 2)
    }


def _has_sides(made: Prosthesis) -> bool:
    return bool((made.sides == OUTER).any() and (made.sides == INNER).any())


def records(comparison: Comparison) -> list[dict[str, Any]]:
    """The table, one dict per contender: name, method, preset, parameters, status, fault, measures (None for none)."""
    return [
        {
            "name": trial.contender.name,
            "method": trial.contender.method,
            "preset": trial.contender.preset,
            "status": trial.status,
            "code": trial.code,
            "message": trial.message,
            **{key: None if np.isnan(value) else value for key, value in row.items()},
            "parameters": None if trial.prosthesis is None else trial.prosthesis.parameters,
        }
        for trial, row in zip(comparison.trials, comparison.rows, strict=True)
    ]


def refuse_if_none(comparison: Comparison) -> None:
    """Raise what every contender ran into, where none of them made anything.

    Raises
    ------
    NoOpening, CranioError
        The first contender's fault.
    """
    if comparison.made:
        return
    first = comparison.trials[0]
    kind = NoOpening if first.status == "no patch" else CranioError
    raise kind(first.code, first.message)
