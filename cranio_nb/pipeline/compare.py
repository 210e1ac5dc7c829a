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

from ..evaluation import mesh_distances, scores
from ..evaluation.against_truth import side_distances, table3, true_prosthesis
from ..evaluation.rim_gap import rim_gap
from ..mesh import INNER, OUTER, RIM
from ..opening import Opening
from ..prosthesis import Prosthesis
from ..volume import Volume
from .preparation import Prepared
from .trial import Attempt, Contender, Trial, attempt_apart

_UNKNOWN = float("nan")


@dataclass(frozen=True)
class Measure:
    """A column of the comparison.

    Parameters
    ----------
    label, short, unit : str
        Words of its head, on a page and where there is little space.
    digits : int
        Decimals shown.
    best : {"high", "low", ""}
        Which end is better; empty where neither is.
    needs_truth : bool
        Whether it says how near a known truth is.
    """

    label: str
    short: str
    unit: str
    digits: int
    best: str = ""
    needs_truth: bool = False


MEASURES = {
    "dice": Measure("DSC", "DSC", "", 3, "high", True),
    "border_dice": Measure("Border DSC", "bDSC", "", 3, "high", True),
    "hd95": Measure("HD95", "HD95", "mm", 2, "low", True),
    "assd": Measure("ASSD", "ASSD", "mm", 2, "low", True),
    "thickness_rmse": Measure("Thickness RMSE", "tRMSE", "mm", 2, "low", True),
    "top_mean": Measure("Table 3, top: mean", "top", "voxels", 2, "low", True),
    "inner_mean": Measure("Table 3, inner: mean", "inner", "voxels", 2, "low", True),
    "volume_ratio": Measure("Volume ratio", "ratio", "", 3, "", True),
    "volume": Measure("Volume", "cm³", "cm³", 2),
    "thickness": Measure("Thickness", "thick", "mm", 2),
    "rim_gap": Measure("Rim gap: mean", "gap", "mm", 2, "low"),
    "rim_gap_p95": Measure("Rim gap: 95 %", "gap95", "mm", 2, "low"),
    "overlap": Measure("Overlap with bone", "over", "voxels", 0, "low"),
    "seconds": Measure("Time", "time", "s", 1, "low"),
    "cpu": Measure("CPU time", "CPU", "s", 1, "low"),
    "memory": Measure("Peak memory", "MB", "MB", 0, "low"),
}
"""Every column by its name in files: accuracy against a truth, the implant itself, its cost (`Trial`)."""


@dataclass(frozen=True, eq=False)
class Reference:
    """The missing bone, prepared once for many measurements.

    Parameters
    ----------
    prosthesis : Prosthesis
        With its mesh and sides.
    thickness : ndarray, shape (nodes of the outer side,)
        mm; empty where a side is missing.
    """

    prosthesis: Prosthesis
    thickness: NDArray[np.float64]

    @classmethod
    def of(cls, truth: Volume, bone: Volume, largest: Opening) -> Reference:
        """From the mask of the missing bone.

        Parameters
        ----------
        truth, bone : Volume
            Bool masks of the missing bone and of the skull with the hole, on one grid.
        largest : Opening
            From whose head centre the sides are told apart.

        Returns
        -------
        Reference
        """
        true = true_prosthesis(truth, bone, largest.head_centre)
        return cls(true, _thickness(true))


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
        """The prostheses by the names of their contenders.

        Returns
        -------
        dict of str to Prosthesis
        """
        return {t.contender.name: t.prosthesis for t in self.trials if t.prosthesis is not None}

    @property
    def top(self) -> float:
        """Upper end of the one colour scale of all distance maps: a round number above 99 % of all distances.

        Returns
        -------
        float
            mm.
        """
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

    Returns
    -------
    Comparison

    Examples
    --------
    >>> import cranio_nb as cn
    >>> from cranio_nb.output.nifti_files import write_nifti
    >>> from cranio_nb.pipeline.trial import attempt, contenders
    >>> from data_synth import phantom_case
    >>> case = phantom_case("tiny", "burr_hole", 0)
    >>> write_nifti(cn.Volume(case.bone, case.affine), "skull.nii.gz")
    >>> write_nifti(cn.Volume(case.implant, case.affine), "truth.nii.gz")
    >>> prepared = cn.prepare("skull.nii.gz", truth="truth.nii.gz")
    >>> found = cn.compare(prepared, contenders(["hull", "hull:paper"]), attempt=attempt)
    >>> {name: round(row["dice"], 1) for name, row in zip(found.made, found.rows)}
    {'hull': 1.0, 'hull:paper': 0.8}
    """
    report = progress or (lambda step, done: None)
    truth = None if case.truth is None else Reference.of(case.truth, case.bone, case.openings[0])
    trials, rows = [], []
    for i, contender in enumerate(contenders):
        report(contender.name, i / len(contenders))
        trials.append(attempt(case.bone, case.openings, contender))
        rows.append(measure(trials[-1], case.bone, truth))
    made = {t.contender.name: t.prosthesis for t in trials if t.prosthesis is not None}
    true = None if truth is None else truth.prosthesis
    reference = "truth" if true is not None else next(iter(made), "")
    base = true or made.get(reference)
    distances = {name: side_distances(p, base) for name, p in made.items() if base and p is not base}
    return Comparison(case, tuple(trials), tuple(rows), reference, true, distances, agreement(made))


def measure(trial: Trial, bone: Volume, truth: Reference | None = None) -> dict[str, float]:
    """Values of the `MEASURES` of a trial; nan where there is none, and all of them nan unless it was done.

    Parameters
    ----------
    trial : Trial
    bone : Volume
        The skull it was given.
    truth : Reference, optional
        The missing bone.

    Returns
    -------
    dict of str to float
        In the units of `MEASURES`.
    """
    found = dict.fromkeys(MEASURES, _UNKNOWN)
    made = trial.prosthesis
    if made is None or made.patch is None:
        return found
    gap = rim_gap(made.surface(RIM), bone) if (made.sides == RIM).any() else None
    walls = _thickness(made)
    found |= {
        "volume": made.mesh.volume / 1000,
        "thickness": float(walls.mean()) if len(walls) else _UNKNOWN,
        "rim_gap": gap.mean if gap else _UNKNOWN,
        "rim_gap_p95": gap.p95 if gap else _UNKNOWN,
        "overlap": scores.overlap(made.patch, bone),
        "seconds": trial.seconds,
        "cpu": trial.cpu,
        "memory": trial.memory,
    }
    return found if truth is None else found | _accuracy(made, walls, truth, bone)


def _accuracy(made: Prosthesis, walls: NDArray[np.float64], truth: Reference, bone: Volume) -> dict[str, float]:
    true = truth.prosthesis
    if made.patch is None or true.patch is None:
        return {}
    score, rows = scores.score(made.patch, true.patch, bone), table3(made, true, bone)
    walled = len(walls) and len(truth.thickness)
    return {
        "dice": score.dice,
        "border_dice": score.border_dice,
        "hd95": score.hd95,
        "assd": score.assd,
        "volume_ratio": score.volume_ratio,
        "thickness_rmse": mesh_distances.thickness_error(made, walls, true, truth.thickness) if walled else _UNKNOWN,
        "top_mean": rows["outer"].mean if "outer" in rows else _UNKNOWN,
        "inner_mean": rows["inner"].mean if "inner" in rows else _UNKNOWN,
    }


def _thickness(made: Prosthesis) -> NDArray[np.float64]:
    """Its `evaluate.thickness`; empty where a side is missing."""
    return (
        mesh_distances.thickness(made) if (made.sides == OUTER).any() and (made.sides == INNER).any() else np.empty(0)
    )


def agreement(made: dict[str, Prosthesis]) -> dict[tuple[str, str], tuple[float, float]]:
    """Dice and mean surface distance between the patches of each two prostheses.

    Parameters
    ----------
    made : dict
        Name -> prosthesis; those without a patch are left out.

    Returns
    -------
    dict
        Two names -> (Dice, mean surface distance in mm).
    """
    patches = {name: p.patch for name, p in made.items() if p.patch is not None}
    return {
        (a, b): (scores.dice(patches[a], patches[b]), scores.assd(patches[a], patches[b]))
        for a, b in combinations(patches, 2)
    }


def records(comparison: Comparison) -> list[dict[str, Any]]:
    """The table of a comparison, JSON-able.

    Parameters
    ----------
    comparison : Comparison

    Returns
    -------
    list of dict
        One per contender: name, method, preset, parameters, status, fault, measures (None for none).
    """
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
