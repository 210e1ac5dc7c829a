"""What each reader does with valid and faulty folders: read exactly, silently wrong, warned, refused or crashed.

    python benchmarks/readers.py [--every N]

Each reader is driven by its ordinary recipe, in a process of its own for every folder. Readers that are not installed
are left out: SimpleITK, highdicom and dicom2nifti come from PyPI, dcm2niix from Debian (or by DCM2NIIX=path).
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import re
import shutil
import subprocess
import tempfile
import time
import warnings
from collections import Counter
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from data_synth.faults import FaultCase, fault_cases

Grid = tuple[np.ndarray, np.ndarray]  # voxels and affine, index -> mm (LPS)
_LPS = np.diag([-1.0, -1.0, 1.0, 1.0])
_SECONDS = 60
COLUMNS = ("valid exact", "valid not", "silently wrong", "accepted, no message", "warned", "refused", "crash")


def read_ours(folder: Path) -> Grid:
    from cranio_nb.readers import read_ct

    volume, report = read_ct(folder)
    for finding in report.findings:
        if finding.severity != "info":
            print(finding.message)
    return volume.voxels, volume.affine


def read_simpleitk(folder: Path) -> Grid:
    import SimpleITK as sitk

    reader = sitk.ImageSeriesReader()
    reader.SetFileNames(reader.GetGDCMSeriesFileNames(str(folder)))
    image = reader.Execute()
    affine = np.eye(4)
    affine[:3, :3] = np.array(image.GetDirection()).reshape(3, 3) * image.GetSpacing()
    affine[:3, 3] = image.GetOrigin()
    return sitk.GetArrayFromImage(image).transpose(2, 1, 0), affine


def _data_sets(folder: Path) -> list:
    import pydicom

    found = []
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            try:
                found.append(pydicom.dcmread(path))
            except pydicom.errors.InvalidDicomError:
                continue
    return found


def read_pydicom_loop(folder: Path) -> Grid:
    slices = [ds for ds in _data_sets(folder) if "PixelData" in ds]
    slices.sort(key=lambda ds: float(ds.ImagePositionPatient[2]))
    hu = [ds.pixel_array * float(ds.get("RescaleSlope", 1)) + float(ds.get("RescaleIntercept", 0)) for ds in slices]
    first = slices[0]
    across, down = np.array(first.ImageOrientationPatient, float).reshape(2, 3)
    step = np.array(slices[1].ImagePositionPatient, float) - np.array(first.ImagePositionPatient, float)
    affine = np.eye(4)
    rows, cols = (float(v) for v in first.PixelSpacing)
    affine[:3] = np.column_stack([step, down * rows, across * cols, np.array(first.ImagePositionPatient, float)])
    return np.stack(hu), affine


def read_highdicom(folder: Path) -> Grid:
    import highdicom

    images = [ds for ds in _data_sets(folder) if "PixelData" in ds]
    if len(images) == 1 and "NumberOfFrames" in images[0]:
        volume = highdicom.Image.from_dataset(images[0]).get_volume()
    else:
        volume = highdicom.get_volume_from_series(images)
    return np.asarray(volume.array), np.asarray(volume.affine)


def read_dicom2nifti(folder: Path) -> Grid:
    import dicom2nifti

    with tempfile.TemporaryDirectory() as out:
        dicom2nifti.dicom_series_to_nifti(str(folder), f"{out}/a.nii", reorient_nifti=False)
        return _nifti(Path(out) / "a.nii")


def read_dcm2niix(folder: Path) -> Grid:
    with tempfile.TemporaryDirectory() as out:
        command = [_dcm2niix(), "-z", "n", "-b", "n", "-f", "a_%s", "-o", out, str(folder)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=_SECONDS, check=False)
        if done.returncode < 0:
            os.kill(os.getpid(), -done.returncode)
        said = [line for line in done.stdout.splitlines() if "arning" in line or "rror" in line]
        print("\n".join(said))
        made = sorted(Path(out).glob("*.nii"), key=lambda path: path.stat().st_size)
        if not made:
            raise ValueError("nothing was made")
        return _nifti(made[-1])


def _nifti(path: Path) -> Grid:
    import nibabel

    image = nibabel.nifti1.load(path)
    return np.asarray(image.dataobj), _LPS @ np.asarray(image.affine)


def _dcm2niix() -> str:
    return os.environ.get("DCM2NIIX") or shutil.which("dcm2niix") or ""


def readers() -> dict[str, Callable[[Path], Grid]]:
    """The readers that this machine has, ours first."""
    found: dict[str, Callable[[Path], Grid]] = {"cranio_nb": read_ours, "pydicom loop": read_pydicom_loop}
    for name, module, read in (
        ("SimpleITK", "SimpleITK", read_simpleitk),
        ("highdicom", "highdicom", read_highdicom),
        ("dicom2nifti", "dicom2nifti", read_dicom2nifti),
    ):
        if find_spec(module):
            found[name] = read
    if _dcm2niix():
        found["dcm2niix"] = read_dcm2niix
    return found


def is_exact(voxels: np.ndarray, affine: np.ndarray, case: FaultCase) -> bool:
    """Whether every voxel of the truth is read, at its own place; padding may be left as it was."""
    if voxels.ndim != 3 or voxels.size != case.hu.size or abs(np.linalg.det(affine)) < 1e-9:
        return False
    index = np.stack(np.meshgrid(*map(np.arange, case.hu.shape), indexing="ij"), axis=-1).reshape(-1, 3)
    world = index @ case.affine[:3, :3].T + case.affine[:3, 3]
    at = (world - affine[:3, 3]) @ np.linalg.inv(affine[:3, :3]).T
    nearest = np.rint(at).astype(int)
    if not np.isfinite(at).all() or np.abs(at - nearest).max() > 1e-2:
        return False
    if (nearest < 0).any() or (nearest >= voxels.shape).any():
        return False
    values, truth = voxels[tuple(nearest.T)].astype(float), case.hu.ravel()
    return bool(((np.abs(values - truth) < 1e-3) | ((truth == -1024) & (values < -1024))).all())


def _attempt(read: Callable[[Path], Grid], folder: Path, case: FaultCase, log: str, queue) -> None:
    """One reading, in a process of its own; all that it says goes to the log."""
    target = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(target, 1)
    os.dup2(target, 2)
    warnings.simplefilter("always")
    try:
        voxels, affine = read(folder)
    except Exception as error:
        queue.put(f"refused: {type(error).__name__}")
        return
    queue.put("exact" if is_exact(np.asarray(voxels), affine, case) else "other")


def verdict(read: Callable[[Path], Grid], folder: Path, case: FaultCase, usual: set[str]) -> str:
    """One of `COLUMNS` for one reader and one folder; what a reader says of sound folders (`usual`) is no warning."""
    context = multiprocessing.get_context("fork")
    with tempfile.NamedTemporaryFile() as log:
        queue = context.SimpleQueue()
        process = context.Process(target=_attempt, args=(read, folder, case, log.name, queue))
        process.start()
        process.join(_SECONDS)
        if process.is_alive() or process.exitcode:
            process.kill()
            process.join()
            return "valid not" if case.valid else "crash"
        result, said = queue.get(), _remarks(Path(log.name))
    if case.valid:
        usual |= said
        return "valid exact" if result == "exact" else "valid not"
    if result.startswith("refused"):
        return "refused"
    if said - usual:
        return "warned"
    # the fault is not in the voxels, or was mended: read as if nothing were
    return "accepted, no message" if result == "exact" else "silently wrong"


def _remarks(log: Path) -> set[str]:
    """The lines of a log without numbers and names of files."""
    lines = log.read_text(encoding="utf-8", errors="replace").splitlines()
    return {re.sub(r"\S*/\S*|[-\d.]+", "", line).strip() for line in lines} - {""}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--every", type=int, default=1, help="only every so many folders")
    parser.add_argument("--verbose", action="store_true", help="list what is not read exactly or not noticed")
    options = parser.parse_args()
    tried, seconds = readers(), Counter[str]()
    tally = {name: Counter[str]() for name in tried}
    usual: dict[str, set[str]] = {name: set() for name in tried}
    with tempfile.TemporaryDirectory() as folder:
        for case, path in fault_cases(folder, every=options.every):
            for name, read in tried.items():
                start = time.perf_counter()
                found = verdict(read, path, case, usual[name])
                seconds[name] += time.perf_counter() - start
                tally[name][found] += 1
                if options.verbose and found in ("valid not", "silently wrong", "crash"):
                    print(f"{name}: {case.name}: {found}", flush=True)
    print(f"{'reader':14}" + "".join(f"{column:>22}" for column in COLUMNS) + f"{'seconds':>10}")
    for name, counts in tally.items():
        print(f"{name:14}" + "".join(f"{counts[column]:>22}" for column in COLUMNS) + f"{seconds[name]:>10.1f}")


if __name__ == "__main__":
    main()
