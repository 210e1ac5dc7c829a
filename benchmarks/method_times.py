"""Time and peak memory of every method on a skull of a CT's full size: prints a table, tests nothing.

    python benchmarks/method_times.py [--methods slicewise ...] [--planes 240]

The skull is the phantom `data_synth` makes, sampled on 512 x 512 x 240 voxels of 0.45 x 0.45 x 0.71 mm; beside it the
first case of skullfix/cases, where CRANIO_NB_DATA names the folder of real scans. Each design runs alone, on at most
two cores, in a process of its own (see `cranio_nb.pipeline.trial`). Finding bone and openings comes before and is
timed apart.
"""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

from cranio_nb.pipeline.trial import Contender, attempt_apart, contenders
from cranio_nb.readers import read_ct
from cranio_nb.stages.segmentation import segment
from cranio_nb.vault.opening_search import find_openings
from cranio_nb.volume import Volume
from data_synth import phantom_case, scan


def phantom(planes: int) -> Volume:
    """The full phantom's skull with its hole on a grid of more planes over the same height."""
    case = phantom_case("full", "unilateral", 1)
    assert case.head is not None
    affine = case.affine.copy()
    affine[:3, 0] *= len(case.bone) / planes
    return Volume(scan(case.head, affine, (planes, *case.bone.shape[1:]))[1], affine)


def measure(name: str, bone: Volume, asked: tuple[Contender, ...]) -> None:
    """A line for each contender."""
    began = time.perf_counter()
    bone = segment(bone)
    openings = find_openings(bone)
    spacing = " x ".join(f"{s:.2f}" for s in bone.spacing[::-1])
    shape = " x ".join(map(str, bone.shape[::-1]))
    print(f"\n== {name}: {shape} voxels of {spacing} mm; bone and openings {time.perf_counter() - began:.1f} s")
    print(f"   {'method':18s} {'time (s)':>9s} {'CPU (s)':>9s} {'peak memory (MB)':>17s}")
    for contender in asked:
        trial = attempt_apart(bone, openings, contender)
        numbers = f"{trial.seconds:9.1f} {trial.cpu:9.1f} {trial.memory:17.0f}"
        print(f"   {contender.name:18s} {numbers}  {trial.message}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--methods", nargs="+", metavar="NAME", default=[], help="default: all")
    parser.add_argument("--planes", type=int, default=240)
    asked = parser.parse_args()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:2])
    rivals = contenders(asked.methods)
    measure("phantom", phantom(asked.planes), rivals)
    if home := os.environ.get("CRANIO_NB_DATA"):
        measure("SkullFix case 000", read_ct(Path(home) / "skullfix/cases/000/defective.nrrd", mask=True)[0], rivals)


if __name__ == "__main__":
    main()
