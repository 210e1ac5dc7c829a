"""Inputs of `speed.py`: a real series with a hole cut into it, and the same head on other grids.

Everything is written below one folder and made once. Without real data the head is one that `data_synth` makes.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pydicom
from numpy.typing import NDArray

from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.readers import read_ct
from cranio_nb.volume import Volume
from data_synth import cut_case, face_case, phantom_case
from data_synth.series import write_dicom

HOLE = ("parietal", 1)
"""Kind and seed of the hole that is cut."""
_SERIES = "dicom/dryskull_multiseries/S2020"
_SKULL = "skullfix/cases/000"
_SLOPE = "1.25"  # of one slice of the slope case; all others have 1


@dataclass(frozen=True, eq=False)
class Head:
    """An intact head on its grid, int16 HU."""

    hu: NDArray[np.int16]
    affine: NDArray[np.float64]

    def cut(self, diameter_mm: float | None = None) -> Head:
        """With a hole in its vault."""
        kind, seed = HOLE
        case = cut_case(self.hu, self.affine, kind, seed, is_mask=False, diameter=diameter_mm)
        assert case.hu is not None
        return replace(self, hu=case.hu)

    def resampled(self, axis: int, n: int) -> Head:
        """The same head with n voxels along an axis, linear between its own."""
        length = self.hu.shape[axis]
        place = np.linspace(0, length - 1, n)
        low = np.minimum(place.astype(int), length - 2)
        values = np.moveaxis(self.hu, axis, 0)
        out = np.empty((n, *values.shape[1:]), np.int16)
        for i, (k, part) in enumerate(zip(low, place - low, strict=True)):  # a plane at a time: no float volume
            out[i] = np.rint((1 - part) * values[k] + part * values[k + 1])
        affine = self.affine.copy()
        affine[:3, axis] *= (length - 1) / (n - 1)
        return Head(np.ascontiguousarray(np.moveaxis(out, 0, axis)), affine)

    def write(self, folder: Path) -> Path:
        """As a series of DICOM files; kept where it is there already."""
        if not folder.exists():
            write_dicom(folder, self.hu, self.affine)
        return folder


def head() -> tuple[Head, str]:
    """The intact head, and its name."""
    if home := os.environ.get("CRANIO_NB_DATA"):
        scan = read_ct(Path(home) / _SERIES)[0]
        return Head(scan.voxels.astype(np.int16), scan.affine), "dry skull (Philips, 1 mm slices)"
    case = face_case("full", 1, holes=0)
    assert case.hu is not None
    return Head(case.hu, case.affine), "synthetic head, size full"


def series(folder: Path) -> tuple[Path, str, tuple[int, ...]]:
    """The series that everything is measured on: its folder, its name and its shape (planes, rows, columns)."""
    intact, name = head()
    return intact.cut().write(folder / "ct"), name, intact.hu.shape


def slope_case(folder: Path, ct: Path) -> Path:
    """The series with another rescale slope in its middle slice, the stored values as they are."""
    out = folder / "slope"
    if not out.exists():
        out.mkdir()
        paths = sorted(ct.iterdir())
        for i, path in enumerate(paths):
            data = pydicom.dcmread(path)
            if i == len(paths) // 2:
                data.RescaleSlope = _SLOPE
            data.save_as(out / path.name)
    return out


def skull() -> Path | None:
    """A real skull of the size of a CT as a bone mask, with its hole, where there is one."""
    home = os.environ.get("CRANIO_NB_DATA")
    return Path(home) / _SKULL / "defective.nrrd" if home else None


def patch_mask(folder: Path) -> Path:
    """A patch whose surface is taken: the true implant of the skull, or that of a phantom."""
    if (path := skull()) is not None:
        return path.with_name("implant.nrrd")
    out = folder / "implant.nii.gz"
    if not out.exists():
        case = phantom_case("full", "unilateral", 1)
        write_nifti(Volume(case.implant, case.affine), out)
    return out
