"""Damaged copies of small valid inputs through the reader: what dies, raises, is slow, or takes memory.

    python benchmarks/mutants.py [--count N] [--seed S] [--keep FOLDER]

One file of each input gets one to four other bytes, in half of the mutants among its first 1,600; one in ten is also
cut short. They are read by a child process, so that a death of the process is counted and the rest goes on. What is
read as other values without a warning is listed too: bytes of plain pixels carry no check, and such a change is
nobody's to see. With --keep, the files that were slow or raised something foreign are kept.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import numpy as np

from cranio_nb.errors import InputRefused
from cranio_nb.pipeline.trial import peak_memory
from data_synth.fault_free import valid_recipes
from data_synth.fault_series import head, write_folder

SERIES = ("plain", "JPEG", "JPEG-LS", "run length", "JPEG 2000", "deflated", "enhanced", "enhanced, deflated")
FILES = ("NIfTI", "NIfTI, packed", "NRRD", "NRRD, packed")
_SLOW_S = 1.0
_AHEAD = 1600  # bytes of a file that are headers


def main() -> None:
    """Run the mutants and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1200, help="of all inputs together")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path, help="folder for files that were slow or raised something foreign")
    parser.add_argument("--first", type=int, help=argparse.SUPPRESS)  # of a child
    asked = parser.parse_args()
    if asked.first is not None:
        _child(asked.first, asked.count, asked.seed, asked.keep)
        return
    lines, deaths = _run(asked.count, asked.seed, asked.keep)
    _print(lines, deaths)


def _run(count: int, seed: int, keep: Path | None) -> tuple[list[dict], int]:
    """Results of all mutants; a child that dies is followed by another, behind the mutant that killed it."""
    lines: list[dict] = []
    deaths = 0
    while len(lines) + deaths < count:
        first = len(lines) + deaths
        command = [sys.executable, __file__, "--first", str(first), "--count", str(count), "--seed", str(seed)]
        command += ["--keep", str(keep)] if keep else []
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as child:
            assert child.stdout is not None
            for line in child.stdout:
                lines.append(json.loads(line))
                if len(lines) % 5000 == 0:
                    print(f"{len(lines)} read", file=sys.stderr, flush=True)
        deaths += len(lines) + deaths < count
    return lines, deaths


def _print(lines: list[dict], deaths: int) -> None:
    """One row for each input, then what holds for all."""
    kinds = ("refused", "same", "said", "different", "not finite", "foreign")
    print(f"{'input':20}" + "".join(f"{kind:>12}" for kind in kinds))
    found = Counter((line["input"], line["kind"]) for line in lines)
    for name in (*SERIES, *FILES):
        print(f"{name:20}" + "".join(f"{found[name, kind]:12}" for kind in kinds))
    seconds = np.array([line["s"] for line in lines])
    print(f"{len(lines)} mutants read, {deaths} deaths, peak {max(line['mb'] for line in lines):.0f} MB")
    print(
        f"CPU seconds: median {np.median(seconds):.3f}, p99 {np.percentile(seconds, 99):.3f}, most {seconds.max():.2f}"
    )
    for line in lines:
        if line["kind"] in ("foreign", "not finite"):
            print("foreign:", line)


def _child(first: int, count: int, seed: int, keep: Path | None) -> None:
    """Read mutants from a number on, a line of JSON for each."""
    warnings.simplefilter("ignore")
    with tempfile.TemporaryDirectory(prefix="cranio-nb-mutants-") as home:
        inputs = _inputs(Path(home))
        for number in range(first, count):
            name = list(inputs)[number % len(inputs)]
            line = _mutant(name, *inputs[name], np.random.default_rng((seed, number)), keep, number)
            print(json.dumps(line), flush=True)


def _inputs(home: Path) -> dict[str, tuple[Path, Path, bytes, tuple]]:
    """What is read, the file that is damaged, its bytes, and the sound result."""
    inputs = {}
    for name in SERIES:
        folder = home / name
        write_folder(folder, valid_recipes()[name])
        files = sorted(folder.iterdir())
        inputs[name] = (folder, files[len(files) // 2])
    for name, path in _image_files(home).items():
        inputs[name] = (path, path)
    return {name: (path, victim, victim.read_bytes(), _read(path)) for name, (path, victim) in inputs.items()}


def _image_files(home: Path) -> dict[str, Path]:
    """The small head in one file of each other format."""
    import nibabel
    import nrrd

    paths = {name: home / f"head.{end}" for name, end in zip(FILES, ("nii", "nii.gz", "nrrd", "0.nrrd"), strict=True)}
    hu = head().transpose(2, 1, 0)
    for name in FILES[:2]:
        nibabel.save(nibabel.Nifti1Image(hu, np.diag([0.95, 0.9, 1.5, 1.0])), paths[name])
    for name, encoding in zip(FILES[2:], ("raw", "gzip"), strict=True):
        about = {"space": "left-posterior-superior", "space directions": np.diag([0.95, 0.9, 1.5])}
        nrrd.write(str(paths[name]), hu, {**about, "space origin": [0.0] * 3, "encoding": encoding})
    return paths


def _read(path: Path) -> tuple:
    """Volume and whether the reader warned."""
    from cranio_nb.readers import read_ct

    volume, report = read_ct(path)
    return volume, any(finding.severity != "info" for finding in report.findings)


def _mutant(
    name: str,
    path: Path,
    victim: Path,
    good: bytes,
    sound: tuple,
    rng: np.random.Generator,
    keep: Path | None,
    number: int,
) -> dict:
    """Damage a file, read, and say what came of it."""
    bad = _damaged(good, rng, 128 if victim.suffix == ".dcm" else 0)
    victim.write_bytes(bad)
    began = time.process_time()
    kind = _kind(lambda: _read(path), sound)
    spent = time.process_time() - began
    victim.write_bytes(good)
    if keep is not None and (spent > _SLOW_S or kind.startswith("foreign")):
        keep.mkdir(parents=True, exist_ok=True)
        (keep / f"{number}-{name}-{victim.name}").write_bytes(bad)
    more = {"error": kind.partition(" ")[2]} if kind.startswith("foreign") else {}
    return {"input": name, "kind": kind.split(" ")[0] if more else kind, "s": spent, "mb": peak_memory(), **more}


def _damaged(good: bytes, rng: np.random.Generator, start: int) -> bytes:
    """A copy with other bytes, now and then cut short."""
    bad = bytearray(good)
    end = len(bad) if rng.random() < 0.5 else min(len(bad), _AHEAD)
    for at in rng.integers(start, end, rng.integers(1, 5)):
        bad[at] = rng.integers(256)
    return bytes(bad[: rng.integers(len(bad))] if rng.random() < 0.1 else bad)


def _kind(read: Callable[[], tuple], sound: tuple) -> str:
    """What came of reading: the sound result, another, with a warning or without, a refusal, or something foreign."""
    try:
        volume, warned = read()
    except InputRefused as error:
        # these words stand for an exception that nobody foresaw
        return f"foreign {error}" if str(error).startswith("The input cannot be read") else "refused"
    except BaseException as error:  # whatever it is, it is what is counted here
        return f"foreign {type(error).__name__}"
    if volume.voxels.dtype.kind == "f" and not np.isfinite(volume.voxels).all():
        return "not finite"
    whole = sound[0]
    same = np.array_equal(volume.voxels, whole.voxels) and np.allclose(volume.affine, whole.affine)
    return "same" if same else "said" if warned and not sound[1] else "different"


if __name__ == "__main__":
    main()
