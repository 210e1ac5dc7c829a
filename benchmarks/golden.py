"""Do two checkouts design the same prostheses, bit by bit? Every method and preset on tiny phantoms.

    python benchmarks/golden.py OTHER_CHECKOUT [THIS_CHECKOUT] [--renamed old=new ...]

Each checkout runs in a process of its own, with the same interpreter on the same machine and one BLAS thread. A line
for each case says "identical", or what differs: bone, patch, vertices, faces and sides by type, shape and bytes, the
parameters by ==, a refusal by its code. The exit code is 1 where anything differs. Options and parameters that THIS
checkout names otherwise are given as `--renamed`; a value of another unit is a difference.
"""

from __future__ import annotations

import argparse
import os
import pickle
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from functools import partial
from importlib import import_module
from importlib.machinery import BuiltinImporter, FrozenImporter, PathFinder
from pathlib import Path
from typing import Any

import numpy as np

Found = dict[str, Any]
"""What a case gave: arrays and parameters by name, or the code of a refusal under "refused"."""

DEFECTS = ("unilateral", "large", "multiple", "vertex")
DESIGNS: tuple[tuple[str, str, dict[str, Any]], ...] = (
    *((method, "default", {}) for method in ("slicewise", "hull", "reflection", "you", "thin-plate", "dnurbs")),
    *((method, "paper", {}) for method in ("slicewise", "hull", "reflection")),
)
VARIANTS: tuple[tuple[str, str, str, dict[str, Any]], ...] = (
    ("burr_hole", "dnurbs", "default", {"free_weights": True}),
    ("unilateral", "slicewise", "default", {"axial": True}),
    ("unilateral", "slicewise", "default", {"directions": 1}),
    ("unilateral", "thin-plate", "default", {"smooth": False}),
)
CASES = (*((defect, *design) for defect in DEFECTS for design in DESIGNS), *VARIANTS)
"""Defect of the tiny phantom, method, preset, options."""

# The names of one thing in the layouts before the package had a face; the first that is there is taken.
FIND = ("cranio_nb.lesion:find", "cranio_nb.vault.opening_search:find_openings")
CATALOGUE = ("cranio_nb.catalogue:method_module", "cranio_nb.methods.catalogue:method_module")
VOLUME = ("cranio_nb.volume:Volume",)


def named(places: tuple[str, ...], face: str) -> Any:
    """A name of the package's face, or else the first of some places "module:name" that exists."""
    package = import_module("cranio_nb")
    if callable(found := getattr(package, face, None)):
        return found
    for place in places:
        module, _, name = place.partition(":")
        try:
            return getattr(import_module(module), name)
        except (ModuleNotFoundError, AttributeError):
            continue
    raise SystemExit(f"{package.__file__} has neither cranio_nb.{face} nor any of {', '.join(places)}.")


def designer() -> Callable[..., Any]:
    """`design(bone, openings, method, preset, options)` of the checkout that runs."""
    if callable(face := getattr(import_module("cranio_nb"), "design", None)):
        return lambda bone, openings, method, preset, options: face(
            bone, openings, method=method, preset=preset, **options
        )
    method_module = named(CATALOGUE, "design")

    def design(bone: Any, openings: Any, method: str, preset: str, options: dict[str, Any]) -> Any:
        module = method_module(method)
        start = module.paper_options(bone) if preset == "paper" else {}
        return module.design(bone, openings, **(start | options))

    return design


def run_all(renamed: Mapping[str, str]) -> dict[str, Found]:
    """Every case of the checkout that is imported, by name."""
    volume, find, design = named(VOLUME, "Volume"), named(FIND, "find_openings"), designer()
    phantom_case = import_module("data_synth").phantom_case
    found: dict[str, Found] = {}
    skulls = {}
    for defect in dict.fromkeys(defect for defect, *_ in CASES):
        case = phantom_case("tiny", defect, 0)
        bone = volume(case.bone, case.affine)
        skulls[defect] = bone, find(bone)
        found[f"{defect} bone"] = {"bone": case.bone, "affine": case.affine}
    for defect, method, preset, options in CASES:
        name = " ".join([defect, method, preset, *(f"{key}={value}" for key, value in options.items())])
        asked = {renamed.get(key, key): value for key, value in options.items()}
        found[name] = outcome(partial(design, *skulls[defect], method, preset, asked))
    return found


def outcome(design: Callable[[], Any]) -> Found:
    """What a design gave; an error without a code is a fault and is raised."""
    try:
        made = design()
    except ValueError as error:
        if not hasattr(error, "code"):
            raise
        return {"refused": error.code}
    return {
        "patch": made.patch.voxels,
        "vertices": made.mesh.vertices,
        "faces": made.mesh.faces,
        "sides": made.sides,
        "parameters": dict(made.parameters),
    }


def differences(other: Found, this: Found, renamed: Mapping[str, str]) -> list[str]:
    """What differs between two outcomes of a case, a phrase for each; empty where they are identical."""
    if "refused" in other or "refused" in this:
        codes = [found.get("refused", "a design") for found in (other, this)]
        return [] if codes[0] == codes[1] else [f"{codes[0]} became {codes[1]}"]
    phrases = []
    for key in (key for key in other if key != "parameters"):
        if phrase := array_difference(other[key], this[key]):
            phrases.append(f"{key}: {phrase}")
    before = {renamed.get(key, key): value for key, value in other.get("parameters", {}).items()}
    after = this.get("parameters", {})
    for key in before.keys() | after.keys():
        old, new = before.get(key, "nothing"), after.get(key, "nothing")
        if old != new:
            phrases.append(f"parameter {key}: {old!r} became {new!r}")
    return phrases


def array_difference(other: np.ndarray, this: np.ndarray) -> str:
    """How two arrays differ in type, shape or bytes; empty where they do not."""
    if (other.dtype, other.shape) != (this.dtype, this.shape):
        return f"{other.dtype} {other.shape} became {this.dtype} {this.shape}"
    if other.tobytes() == this.tobytes():
        return ""
    apart = np.abs(other.astype(float) - this.astype(float))
    return f"{np.count_nonzero(apart)} of {apart.size} differ, by at most {np.nanmax(apart):.3g}"


def start(checkout: Path, renamed: list[str], out: Path) -> subprocess.Popen[bytes]:
    """Begin a process in which `checkout` is the one that is imported."""
    own = {"PYTHONPATH": str(checkout), "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "PYTHONHASHSEED": "0"}
    flags = [f"--renamed={pair}" for pair in renamed]
    return subprocess.Popen(
        [sys.executable, "-P", __file__, str(checkout), *flags, "--run-to", str(out)],
        env=os.environ | own,
        cwd=out.parent,
    )


def work(checkout: Path, renamed: Mapping[str, str], out: Path) -> None:
    """The task of a process: run every case of a checkout and write what came out."""
    # an editable install has a finder of its own, which would serve what the checkout does not have
    sys.meta_path[:] = [BuiltinImporter, FrozenImporter, PathFinder]
    check_origin(checkout)
    found = run_all(renamed)
    check_origin(checkout)
    out.write_bytes(pickle.dumps(found))


def check_origin(checkout: Path) -> None:
    """Stop where a module of the package or the witness was imported from elsewhere."""
    for package in ("cranio_nb", "data_synth"):
        import_module(package)
    for name, module in list(sys.modules.items()):
        if name.split(".")[0] in ("cranio_nb", "data_synth"):
            path = Path(module.__file__ or "").resolve()
            if not path.is_relative_to(checkout):
                raise SystemExit(f"{name} was imported from {path}, not from {checkout}.")


def report(other: dict[str, Found], this: dict[str, Found], renamed: Mapping[str, str]) -> int:
    """Print a line for each case; the number of cases that differ."""
    n_different = 0
    for name in other:
        phrases = differences(other[name], this[name], renamed)
        n_different += bool(phrases)
        same = f"identical (refused: {other[name]['refused']})" if "refused" in other[name] else "identical"
        print(f"{name:45s} {'; '.join(phrases) or same}")
    print(f"{n_different} of {len(other)} cases differ")
    return n_different


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("other", type=Path, metavar="OTHER_CHECKOUT")
    parser.add_argument("this", type=Path, metavar="THIS_CHECKOUT", nargs="?", default=Path(__file__).parents[1])
    parser.add_argument("--renamed", action="append", default=[], metavar="old=new", help="may be given several times")
    parser.add_argument("--run-to", type=Path, help=argparse.SUPPRESS)
    asked = parser.parse_args()
    renamed = dict(pair.split("=", 1) for pair in asked.renamed)
    other, this = asked.other.resolve(), asked.this.resolve()
    if asked.run_to:
        work(other, renamed, asked.run_to)
        return
    with tempfile.TemporaryDirectory() as folder:
        outs = [Path(folder) / name for name in ("other.pickle", "this.pickle")]
        runs = [start(other, [], outs[0]), start(this, asked.renamed, outs[1])]
        if any([run.wait() for run in runs]):
            raise SystemExit("A checkout could not be run; see above.")
        found = [pickle.loads(out.read_bytes()) for out in outs]
    raise SystemExit(1 if report(*found, renamed) else 0)


if __name__ == "__main__":
    main()
