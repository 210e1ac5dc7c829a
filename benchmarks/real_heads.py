"""Openings of real heads: intact ones as they lie and turned, and one with virtual craniectomies.

    python benchmarks/real_heads.py [--only complete|living|dry|cuts]

Real data is looked for in the folder named by CRANIO_NB_DATA. A head is turned by resampling it about its middle.
Prints for each head and pose what would be designed; the cuts are closed by the thin plate and scored.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy import ndimage

from cranio_nb.errors import CranioError
from cranio_nb.evaluation import scores
from cranio_nb.methods.design import design
from cranio_nb.readers import read_ct
from cranio_nb.stages.segmentation import bone_of
from cranio_nb.vault.head_frame import find_head_frame
from cranio_nb.vault.opening_search import find_openings
from cranio_nb.volume import Volume
from data_synth import Pose, cut_case

POSES = [Pose(n, 0, 0) for n in (-30, -20, -10, 10, 20, 30)] + [Pose(0, r, 0) for r in (-20, 20)] + [Pose(0, 0, 45)]
_MM = 1.5  # voxels of a head that is turned
_CUTS = [(kind, seed, mm) for kind in ("frontal", "parietal", "occipital") for seed, mm in enumerate((40, 55, 70))]


def turned(scan: Volume, pose: Pose) -> Volume:
    """A head in another pose, on a grid of its own; what lies outside the scan is air."""
    air = False if scan.voxels.dtype == bool else -1000
    corners = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)]) * (np.array(scan.shape) - 1)
    world = scan.to_world(corners)
    middle, turn = world.mean(axis=0), pose.rotation()
    reach = np.abs((world - middle) @ turn.T).max(axis=0)
    count = 2 * np.ceil(reach / _MM).astype(int) + 1
    affine = np.zeros((4, 4))
    affine[:3, :3], affine[3, 3] = np.eye(3)[:, ::-1] * _MM, 1  # planes along z, rows along y, columns along x
    affine[:3, 3] = middle - affine[:3, :3] @ ((count[::-1] - 1) / 2)
    # new voxel -> new world -> old world -> old voxel
    back = np.linalg.inv(scan.affine)
    matrix = back[:3, :3] @ turn.T @ affine[:3, :3]
    offset = back[:3, :3] @ (turn.T @ (affine[:3, 3] - middle) + middle) + back[:3, 3]
    values = scan.voxels.astype(np.float32)
    moved = ndimage.affine_transform(values, matrix, offset, tuple(count[::-1]), order=1, cval=float(air))
    return Volume(moved > 0.5 if scan.voxels.dtype == bool else moved.round().astype(np.int16), affine)


def outcome(scan: Volume) -> str:
    """What would be designed."""
    try:
        found = find_openings(bone_of(scan, None), scan=scan)
    except CranioError as error:
        return error.code
    return f"{len(found)} designed in planes " + ", ".join(str(one.planes) for one in found)


def intact(data: Path, only: str) -> Iterator[tuple[str, Path, bool]]:
    """Name, path and whether it is a mask, of each intact head."""
    if only in ("", "complete"):
        for path in [*sorted((data / "skullfix/complete").glob("*.nrrd")), data / "skullfix/intact_odd/066.nrrd"]:
            yield path.stem, path, True
    if only in ("", "living"):
        yield "living", data / "dicom/living_head", False
    if only in ("", "dry"):
        for name in ("dryskull_multiseries/S2010", "dryskull_multiseries/S2020", "dryskull_tilt"):
            yield name, data / "dicom" / name, False


def cuts(data: Path) -> None:
    """Nine virtual craniectomies in the living head, each found and closed."""
    whole = read_ct(data / "dicom/living_head")[0]
    # the places are named in the head's own directions: this one's chin lies on its chest
    straight = np.eye(4)
    straight[:3, :3] = find_head_frame(bone_of(whole, None)).axes
    for kind, seed, diameter_mm in _CUTS:
        case = cut_case(whole.voxels, straight @ whole.affine, kind, seed, is_mask=False, diameter=diameter_mm)
        scan = whole.with_voxels(case.hu)
        bone = bone_of(scan, None)
        try:
            found = find_openings(bone, scan=scan)
        except CranioError as error:
            print(f"{kind} {diameter_mm} mm: {error.code}: {error}", flush=True)
            continue
        made = design(bone, found, method="thin-plate")
        dice = scores.dice(made.patch, bone.with_voxels(case.implant))
        print(f"{kind} {diameter_mm} mm: {len(found)} found, DSC {dice:.3f}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=("complete", "living", "dry", "cuts"), default="")
    asked = parser.parse_args()
    data = Path(os.environ["CRANIO_NB_DATA"])
    for name, path, is_mask in intact(data, asked.only):
        scan = read_ct(path, mask=is_mask or None)[0]
        told = [("as it lies", outcome(scan))]
        told += [(f"{p.nod_deg} {p.roll_deg} {p.turn_deg}", outcome(turned(scan, p))) for p in POSES]
        wrong = [f"{pose}: {what}" for pose, what in told if what != "NoOpening"]
        print(f"{name}: {len(told) - len(wrong)} of {len(told)} none; " + "; ".join(wrong), flush=True)
    if asked.only in ("", "cuts"):
        cuts(data)


if __name__ == "__main__":
    main()
