"""Small inputs that promise much: seconds and memory until the reader has read or refused each.

    python benchmarks/bombs.py

Each is read by a process of its own. Memory is what the reading adds, beside that of the volume it gives: at most
twice the volume and 300 MB are wanted, and 5 seconds.
"""

from __future__ import annotations

import copy
import math
import multiprocessing
import tempfile
import time
import warnings
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
from pydicom import uid
from pydicom.dataset import Dataset

from cranio_nb.errors import CranioError
from cranio_nb.pipeline.trial import peak_memory
from data_synth.fault_edits import compress, encode_jpeg, make_enhanced
from data_synth.fault_series import Recipe, head, make_series, save_file

_MB = 1e6
_DEFLATED = uid.DeflatedExplicitVRLittleEndian


def main() -> None:
    """Write, read and print one after the other."""
    warnings.simplefilter("ignore")
    print(f"{'input':34}{'s':>7}{'MB':>8}{'of volume':>11}  outcome")
    for name, write in BOMBS.items():
        with tempfile.TemporaryDirectory(prefix="cranio-nb-bombs-") as home:
            path = write(Path(home) / "bomb")
            with multiprocessing.get_context("spawn").Pool(1) as pool:
                seconds, mb, volume, outcome = pool.apply(measure, (path,))
            print(f"{name:34}{seconds:7.2f}{mb:8.0f}{volume:11.0f}  {outcome[:70]}", flush=True)


def measure(path: Path) -> tuple[float, float, float, str]:
    """CPU seconds, MB that the reading added, MB of the volume, and what came of it."""
    import nibabel  # noqa: F401  (libraries are loaded before the memory is looked at)
    import nrrd  # noqa: F401

    from cranio_nb.prior.file import load_prior
    from cranio_nb.readers import dicom, image_file, read_ct  # noqa: F401

    warnings.simplefilter("ignore")
    before, began = peak_memory(), time.process_time()
    try:
        found = load_prior(path).radii if path.suffix == ".npz" else read_ct(path)[0].voxels
        volume, outcome = found.nbytes, f"read {found.shape} {found.dtype}"
    except CranioError as error:
        volume, outcome = 0, f"{error.code}: {error}"
    return time.process_time() - began, peak_memory() - before, volume / _MB, outcome


def _series(n: int = 20) -> list[Dataset]:
    return make_series(head((n, 44, 48)), Recipe())


def _save(folder: Path, slices: list[Dataset], syntax: str = uid.ExplicitVRLittleEndian) -> Path:
    folder.mkdir()
    for number, ds in enumerate(slices):
        save_file(folder / f"image{number:05d}.dcm", ds, syntax)
    return folder


def _many(n: int, change: Callable[[Dataset, int], None]) -> list[Dataset]:
    """So many tiny slices, each changed by its number."""
    (first, *_), slices = _series(), []
    first.Rows = first.Columns = 4
    first.PixelData = bytes(32)
    for number in range(n):
        ds = copy.deepcopy(first)
        ds.SOPInstanceUID, ds.InstanceNumber = uid.generate_uid(), number
        ds.ImagePositionPatient = [0, 0, number]
        change(ds, number)
        slices.append(ds)
    return slices


def _turn(ds: Dataset, number: int) -> None:
    cos, sin = math.cos(0.002 * number), math.sin(0.002 * number)
    ds.ImageOrientationPatient = [round(v, 9) for v in (cos, sin, 0, -sin, cos, 0)]


def _own_series(ds: Dataset, _: int) -> None:
    ds.SeriesInstanceUID = uid.generate_uid()


def _promise_frames(ds: Dataset, _: int) -> None:
    ds.NumberOfFrames, ds.Rows, ds.Columns, ds.PixelData = 4000, 1, 1, bytes(8000)


def _one_place(ds: Dataset, number: int) -> None:
    ds.ImagePositionPatient, ds.PixelData = [0, 0, 0], number.to_bytes(4, "little") * 8


def _fragments(folder: Path) -> Path:
    slices = _series()
    compress(encode_jpeg)(slices)
    slices[5].PixelData = b"\xfe\xff\x00\xe0\0\0\0\0" * 5_000_000
    return _save(folder, slices, uid.JPEGLosslessSV1)


def _enhanced(folder: Path) -> Path:
    slices = _series(1500)
    make_enhanced()(slices)
    return _save(folder, slices, _DEFLATED)


def _deflated(folder: Path) -> Path:
    """Sixty files that inflate to 1.3 GB each."""
    ds = _series()[0]
    ds.Rows = ds.Columns = 4096
    ds.NumberOfFrames, ds.PixelData = 40, bytes(4096 * 4096 * 2 * 40)
    _save(folder, [ds], _DEFLATED)
    data = (folder / "image00000.dcm").read_bytes()
    for number in range(1, 60):
        (folder / f"image{number:05d}.dcm").write_bytes(data)
    return folder


def _fractional(folder: Path) -> Path:
    """A large series, the first slice of which alone has a slope that is no whole number."""
    hu = np.tile(head((20, 44, 48)), (15, 12, 11))[:, :512, :512]
    slices = make_series(hu, Recipe())
    slices[0].RescaleSlope = "1.0001"
    return _save(folder, slices)


def _nifti_header(shape: tuple[int, int, int], code: str) -> bytes:
    import nibabel

    header = nibabel.Nifti1Header()
    header.set_data_dtype(code)
    header["dim"], header["pixdim"][1:4] = [3, *shape, 1, 1, 1, 1], 1
    header["vox_offset"], header["sform_code"], header["xyzt_units"] = 352, 1, 2
    header["srow_x"], header["srow_y"], header["srow_z"] = np.eye(4)[:3]
    header["magic"] = b"n+1"
    return bytes(header.binaryblock) + bytes(4)


def _empty_nifti(path: Path) -> Path:
    path = path.with_suffix(".nii")
    path.write_bytes(_nifti_header((1024, 1024, 1024), "f8"))
    return path


def _zeros_nifti(path: Path, n_bytes: int = 3 * 2**30) -> Path:
    """Voxels of 210 MB, and zeros behind them."""
    packer, path = zlib.compressobj(9, zlib.DEFLATED, 31), path.with_suffix(".nii.gz")
    parts = [packer.compress(_nifti_header((512, 512, 400), "i2"))]
    parts += [packer.compress(bytes(2**24)) for _ in range(n_bytes >> 24)]
    path.write_bytes(b"".join(parts) + packer.flush())
    return path


def _prior(path: Path) -> Path:
    """A prior of 1.5 GB of zeros."""
    path = path.with_suffix(".npz")
    zeros = np.zeros((125_000_000, 3), np.float32)
    np.savez_compressed(path, version=np.int64(1), inside=zeros, outside=zeros[:9], radii=zeros[:9])
    return path


BOMBS: dict[str, Callable[[Path], Path]] = {
    "3,000 slices, all turned": lambda folder: _save(folder, _many(3000, _turn)),
    "3,000 slices, a series each": lambda folder: _save(folder, _many(3000, _own_series)),
    "3,000 slices at one place": lambda folder: _save(folder, _many(3000, _one_place)),
    "100 files of 4,000 frames": lambda folder: _save(folder, _many(100, _promise_frames)),
    "enhanced, deflated, 1,500 frames": _enhanced,
    "60 files inflating to 1.3 GB": _deflated,
    "5 million empty fragments": _fragments,
    "a fractional slope in one slice": _fractional,
    "NIfTI, 8.6 GB in 352 bytes": _empty_nifti,
    "NIfTI, 3 GB of zeros": _zeros_nifti,
    "prior, 1.5 GB of zeros": _prior,
}


if __name__ == "__main__":
    main()
