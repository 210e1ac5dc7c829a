"""How good the designs are: prints the tables of the paper beside ours, and scores on real skulls where there are any.

    python benchmarks/accuracy.py [--only phantom|skullfix|dryskull|tilt]

Real data is looked for in the folder named by CRANIO_NB_DATA; without it only the synthetic part is printed.
SkullFix (Kodym et al. 2021, doi 10.1016/j.dib.2021.106902) is non-commercial; nothing of it is part of this project.
"""

from __future__ import annotations

import argparse
import os
import time
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from scipy import ndimage

import data_synth
from cranio_nb.errors import CranioError
from cranio_nb.evaluation import scores
from cranio_nb.evaluation.against_truth import measure_against, table3, true_prosthesis
from cranio_nb.evaluation.paper_tables import PAPER_BALLOONS, PAPER_DISTANCES
from cranio_nb.geometry import voxel_pieces
from cranio_nb.methods.design import design
from cranio_nb.opening import Opening
from cranio_nb.pipeline.run import check_patch
from cranio_nb.pipeline.trial import contenders
from cranio_nb.prosthesis import DistanceStats, Prosthesis
from cranio_nb.readers import read_ct
from cranio_nb.stages import surface_reconstruction
from cranio_nb.stages.segmentation import BONE_HU, segment
from cranio_nb.vault import opening_search
from cranio_nb.volume import Volume

HALF_MAXIMUM = 620.0
"""HU midway between the phantom's cortical bone (1200) and its brain (35): where a blurred edge really lies."""

HEADING = f"{'min   max  mean   std     DSC  HD95, mm':>77s}"


def phantom(defect: str = "unilateral", seed: int = 1) -> None:
    case = data_synth.phantom_case("full", defect, seed)
    truth = Volume(case.implant, case.affine)
    planes = np.flatnonzero(case.implant.any(axis=(1, 2)))
    print(f"\n== Phantom, full (512 x 512 x 68), {defect}: loss in {len(planes)} of {len(case.hu)} slices (paper: 23)")
    for threshold in (BONE_HU, HALF_MAXIMUM):
        bone = segment(Volume(case.hu, case.affine), threshold=threshold)
        openings = opening_search.find_openings(bone)
        print(f"\n-- HU >= {threshold:g}; Table 3 in voxels against the truth\n{HEADING}")
        made = phantom_designs(bone, openings, true_prosthesis(truth, bone, openings[0].head_centre))
        print("   slicewise:paper against the reflection, as in the paper")
        mirrored = true_prosthesis(mirror(case, bone), bone, openings[0].head_centre)
        print_distances("", table3(made["slicewise:paper"], mirrored, bone))
        print_distances("printed in the paper", PAPER_DISTANCES)
        for name in ("slicewise", "slicewise:paper"):
            balloon_tables(name, made[name])


def phantom_designs(bone: Volume, openings: tuple[Opening, ...], truth: Prosthesis) -> dict[str, Prosthesis]:
    """Every method of the catalogue with each of its presets, measured: its name -> what it made."""
    made = {}
    for one in contenders():
        made[one.name] = design(bone, openings, method=one.method, preset=one.preset, **one.options)
        check_patch(made[one.name], openings)
        seen = measure_against(made[one.name], truth, bone)
        print_distances(one.name, seen.table3, f"   {seen.score.dice:.3f}  {seen.score.hd95:5.2f}")
    return made


def balloon_tables(name: str, made: Prosthesis) -> None:
    """Tables 1 and 2: range of angles, iterations; how the slices were filled, and the number of snaxels."""
    print(f"   {name}: slices {dict(Counter(s['status'] for s in made.record['slices']))}")
    slices = [s for s in made.record["slices"] if "theta0" in s]
    print(f"   snaxels {made.parameters['n_snaxels']} (paper: 21)")
    for side, name in enumerate(("outer", "inner")):
        parts = []
        for key, label in (("theta0", "theta0"), ("theta1", "theta1"), ("n_iter", "iterations")):
            values = [s[key][side] for s in slices]
            low, high = PAPER_BALLOONS[name][key]
            parts.append(f"{label} {min(values):.0f}..{max(values):.0f} (paper {low}..{high})")
        done = sum(s["converged"][side] for s in slices)
        print(f"   Table {side + 1}, {name}: " + ", ".join(parts) + f", converged {done} of {len(slices)}")


def print_distances(name: str, rows: dict[str, DistanceStats], more: str = "") -> None:
    """Rows of Table 3, the name and `more` on the first of them."""
    for side, s in rows.items():
        print(f"   {name:21s} {side:10s} {s.min:5.2f} {s.max:5.2f} {s.mean:5.2f} {s.std:5.2f}{more}", flush=True)
        name = more = ""


def mirror(case: Any, bone: Volume) -> Volume:
    """The paper's reference: the skull mirrored through the phantom's middle, off the bone, the piece in the hole."""
    middle = bone.to_voxel(case.head.centre)[2]
    columns = np.rint(2 * middle - np.arange(bone.shape[2])).astype(int)
    known = (columns >= 0) & (columns < bone.shape[2])
    flipped = np.zeros(bone.shape, bool)
    flipped[:, :, known] = bone.voxels[:, :, columns[known]]
    opening = opening_search.find_openings(bone)[0].sheet.voxels
    near = ndimage.binary_dilation(opening, np.ones((3, 13, 13)))
    return bone.with_voxels(
        voxel_pieces.keep_main_piece(ndimage.binary_opening(flipped & ~bone.voxels & near), opening)
    )


def skullfix(folder: Path) -> None:
    print("\n== SkullFix cases (real skulls, true implants), no hints given")
    for label, options in (
        ("default, 6 directions", {}),
        ("one direction", {"directions": 1}),
        ("axial, as the paper", {"preset": "paper"}),
    ):
        rows = [skullfix_case(case, options) for case in sorted((folder / "skullfix/cases").iterdir())]
        print_scores(label, rows)
    print("\n== SkullFix varied (no truth): openings found, volume, slices")
    for path in sorted((folder / "skullfix/varied").glob("*.nrrd")):
        bone = segment(read_ct(path)[0])
        made = design(bone)
        volume = made.mesh.volume / 1000
        print(f"   {path.stem}: {volume:.1f} cm3, {dict(Counter(s['status'] for s in made.record['slices']))}")


def skullfix_case(case: Path, options: dict[str, Any]) -> dict[str, Any]:
    bone = segment(read_ct(case / "defective.nrrd")[0])
    truth = read_ct(case / "implant.nrrd")[0]
    return scored(case.name, bone, truth, **options)


def scored(
    name: str, bone: Volume, truth: Volume, *, method: str = "slicewise", preset: str = "default", **options: Any
) -> dict[str, Any]:
    """One row: the scores, the share of slices that were not bridged by themselves, the time."""
    began = time.perf_counter()
    try:
        openings = opening_search.find_openings(bone)
        made = design(bone, openings, method=method, preset=preset, **options)
        check_patch(made, openings)
    except CranioError as error:
        return {"name": name, "failed": error.code}
    seconds = time.perf_counter() - began
    score = scores.score(made.patch, truth, bone)
    slices = made.record.get("slices", [])
    why = Counter(s["reason"] for s in slices if s["status"] in ("carried", "skipped"))
    lost = sum(why.values()) / max(len(slices), 1)
    return {"name": name, "score": score, "lost": lost, "seconds": seconds, "why": why}


def print_scores(label: str, rows: list[dict[str, Any]]) -> None:
    print(f"\n-- {label}\n   case       DSC  border   HD95  ASSD  volume  overlap  carried     s")
    for row in rows:
        if "failed" in row:
            print(f"   {row['name']:9s} failed: {row['failed']}")
            continue
        s = row["score"]
        print(
            f"   {row['name']:9s} {s.dice:.3f}   {s.border_dice:.3f} {s.hd95:6.2f} {s.assd:5.2f}  {s.volume_ratio:6.2f}"
            f"  {s.overlap:7d}  {row['lost']:6.1%} {row['seconds']:6.1f}"
        )
        if row["why"]:
            print(f"             not bridged by themselves: {dict(row['why'])}")
    dice = np.array([row["score"].dice if "score" in row else 0.0 for row in rows])
    hd95 = np.array([row["score"].hd95 for row in rows if "score" in row])
    print(f"   mean DSC {dice.mean():.3f} (worst {dice.min():.3f}), mean HD95 {hd95.mean():.2f} mm")


def dryskull(folder: Path) -> None:
    ct, report = read_ct(folder / "dicom/dryskull_multiseries")
    print("\n== Dry skull (real CT):", next(f.message for f in report.findings if f.code == "SeriesChosen"))
    rows: dict[str, list[dict[str, Any]]] = {"slicewise": [], "thin-plate": []}
    for defect in ("temporal", "frontal", "vertex"):
        for seed in (1, 2, 3):
            case = data_synth.cut_case(ct.voxels, ct.affine, defect, seed, is_mask=False)
            bone, truth = segment(ct.with_voxels(case.hu)), ct.with_voxels(case.implant)
            thickness = {"thickness": mean_thickness(truth)}
            for method, own in rows.items():
                own.append(scored(f"{defect[:7]} {seed}", bone, truth, method=method) | thickness)
    for method, own in rows.items():
        print_scores(f"virtual craniectomies, {method}", own)
    print("   thickness of the cut bone, mm:", ", ".join(f"{r['name']} {r['thickness']:.1f}" for r in own))


def mean_thickness(implant: Volume) -> float:
    """Twice the volume over the surface: the mean thickness of a plate, mm."""
    mesh = surface_reconstruction.extract_surface(implant)
    return 2 * mesh.volume / float(mesh.areas.sum())


def tilt(folder: Path) -> None:
    print("\n== Gantry tilt: size of the vault (left-right x front-back of the slice 50 mm below its top, mm)")
    for name in ("dryskull_multiseries", "dryskull_tilt"):
        ct, report = read_ct(folder / "dicom" / name)
        bone = segment(ct)
        points = bone.to_world(np.argwhere(bone.voxels))
        level = points[np.abs(points[:, 2] - points[:, 2].max() + 50) < 2]
        width, depth = np.ptp(level[:, :2], axis=0)
        print(f"   {name}: {width:.1f} x {depth:.1f}, corner error {report.corner_error:.4f} mm")


PARTS = {"phantom": phantom, "skullfix": skullfix, "dryskull": dryskull, "tilt": tilt}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=PARTS, help="print one part")
    only = parser.parse_args().only
    folder = os.environ.get("CRANIO_NB_DATA")
    for name, part in PARTS.items():
        if only not in (None, name):
            continue
        if name == "phantom":
            part()
        elif folder:
            part(Path(folder))
        else:
            print(f"\n== {name}: skipped, CRANIO_NB_DATA names no folder of real scans")


if __name__ == "__main__":
    main()
