"""Openings on synthetic heads with faces: how often the right holes are found, none is made up, none is half lost.

    python benchmarks/heads.py [--heads 200] [--first 10000] [--size class] [--processes 2] [--out heads.csv]

For each seed from --first on one intact head and one with one to three holes of 10 to 120 mm. Drawn by the seed: nod
and roll within 30 degrees, any turn, every tenth head upside down, every tenth on its side; slices of 0.5 to 5 mm;
nothing, or one or two things around the head; how far the scan reaches. Seeds below 10000 were looked at while the
rules were made. Outcomes: "right" (as many openings designed as holes, each over its own hole; intact: none),
"doubtful" (what is missed is listed), "refused" (named by its code), "silent" (a hole missed without a word), "warned"
(what is missed is narrower than the width that slices so thick are said to hide), "false" (an opening designed where
there is no hole), "count" (each hole found, but in another number of openings), "not drawn" (the seed's holes do not
fit beside each other).
"""

from __future__ import annotations

import argparse
import csv
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from cranio_nb.errors import CranioError
from cranio_nb.stages.segmentation import bone_of
from cranio_nb.vault.opening_choice import JudgedOpening, choose_openings
from cranio_nb.vault.opening_search import survey_openings
from cranio_nb.vault.remarks import thickness_remarks
from cranio_nb.volume import Volume
from data_synth import AROUND, SIZES, Case, Pose, face_case

COLUMNS = ("seed", "kind", "outcome", "holes", "designed", "widths_mm", "parameters", "words")
_REACH_MM = 4.0  # an opening's sheet lies within the missing bone, or so near it


def draw(seed: int, size: str, holes: bool) -> Case:
    """The head of a seed."""
    rng = np.random.default_rng([seed, int(holes), 5])
    nod, roll, turn = rng.uniform(-30, 30), rng.uniform(-30, 30), rng.uniform(-180, 180)
    lies = rng.integers(10)
    nod, roll = (nod + 180 * (lies == 0), roll + 90 * (lies == 1))
    slice_mm = float(np.exp(rng.uniform(np.log(0.5), np.log(5)))) if size != "tiny" else float(rng.uniform(2, 5))
    around = tuple(rng.choice(list(AROUND), rng.integers(3), replace=False))
    return face_case(
        size,
        seed,
        holes=int(rng.integers(1, 4)) if holes else 0,
        pose=Pose(nod, roll, turn),
        slice_mm=slice_mm,
        reach=str(rng.choice(["vault", "neck"])),
        around=around,
    )


def judge_head(seed: int, size: str, holes: bool) -> dict[str, Any]:
    """One row of the table."""
    row = {"seed": seed, "kind": "holed" if holes else "intact"}
    try:
        case = draw(seed, size, holes)
    except ValueError as error:  # the drawn holes do not fit beside each other
        return row | {"outcome": "not drawn", "words": str(error)}
    true = _holes(case)
    row |= {"holes": len(true), "parameters": str(case.parameters), "widths_mm": _widths(case, true)}
    scan = Volume(case.hu, case.affine)
    try:
        survey = survey_openings(bone_of(scan, None), scan=scan)
        designed = choose_openings(survey)
    except CranioError as error:
        if error.code != "NoOpening":
            return row | {"outcome": "refused", "words": error.code}
        designed = ()
    return row | {"designed": len(designed)} | _compared(true, designed, survey, case)


def _holes(case: Case) -> list[NDArray[np.bool_]]:
    """The missing bone, one mask for each hole."""
    labels, count = ndimage.label(case.implant, np.ones((3, 3, 3)))
    masks = sorted((labels == n + 1 for n in range(count)), key=np.count_nonzero, reverse=True)
    drawn = 0 if case.defect == "intact" else int(case.defect.split()[0])
    return masks[:drawn]  # what is more are slivers that thick slices part from a hole


def _widths(case: Case, holes: Sequence[NDArray[np.bool_]]) -> str:
    return " ".join(f"{_width(case, hole):.0f}" for hole in holes)


def _width(case: Case, hole: NDArray[np.bool_]) -> float:
    """Diagonal of the box around a hole, mm: more than its width."""
    return float(np.linalg.norm(np.ptp(np.argwhere(hole) @ case.affine[:3, :3].T, axis=0)))


def _compared(
    true: list[NDArray[np.bool_]], designed: Sequence[JudgedOpening], survey: Sequence[JudgedOpening], case: Case
) -> dict[str, str]:
    """The outcome, and what was wrong in words."""
    spacing = np.linalg.norm(case.affine[:3, :3], axis=0)
    near = [ndimage.distance_transform_edt(~hole, sampling=spacing) <= _REACH_MM for hole in true]
    over = [[bool((one.opening.sheet.voxels & hole).any()) for hole in near] for one in designed]
    missed = [n for n in range(len(true)) if not any(row[n] for row in over)]
    false = [one for one, row in zip(designed, over, strict=True) if not any(row)]
    listed = [
        n
        for n in missed
        if any(one.verdict.kind == "doubtful" and (one.opening.sheet.voxels & near[n]).any() for one in survey)
    ]
    if false:
        return {"outcome": "false", "words": " ".join(one.verdict.reason for one in false)}
    unsaid = set(missed) - set(listed)
    if unsaid:
        hidden = max((one.values["missed_mm"] for one in thickness_remarks(spacing[0])), default=0.0)
        warned = all(_width(case, true[n]) < hidden for n in unsaid)
        return {"outcome": "warned" if warned else "silent", "words": f"missed: {missed}"}
    if listed:
        return {"outcome": "doubtful", "words": f"doubtful: {listed}"}
    return {"outcome": "right" if len(designed) == len(true) else "count", "words": ""}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--heads", type=int, default=200)
    parser.add_argument("--first", type=int, default=10000)
    parser.add_argument("--size", choices=SIZES, default="class")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--out", type=Path, default=Path("heads.csv"))
    asked = parser.parse_args()
    rows = []
    with (
        asked.out.open("w", newline="", encoding="utf-8") as file,
        ProcessPoolExecutor(asked.processes, mp_context=get_context("spawn")) as pool,
    ):
        table = csv.DictWriter(file, COLUMNS)
        table.writeheader()
        for holes in (False, True):
            for row in pool.map(
                partial(judge_head, size=asked.size, holes=holes), range(asked.first, asked.first + asked.heads)
            ):
                rows.append(row)
                table.writerow(row)
                file.flush()
    for kind in ("intact", "holed"):
        counts = Counter(row["outcome"] for row in rows if row["kind"] == kind)
        print(f"{kind}: " + ", ".join(f"{name} {n}" for name, n in counts.most_common()))


if __name__ == "__main__":
    main()
