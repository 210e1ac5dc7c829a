"""A small head as data sets, one a slice, and data sets as files: what every faulty folder is made from."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pydicom
from numpy.typing import NDArray
from pydicom import uid
from pydicom.dataset import Dataset, FileMetaDataset

Slices = list[Dataset]
Edit = Callable[[Slices], None]
FileEdit = Callable[[Path], None]

SHAPE = (20, 44, 48)
SPACING_MM = (0.9, 0.95)  # between rows, between columns
STEP_MM = 1.5
ORIGIN_MM = (-22.0, -18.5, 101.25)
AXIAL = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
_CT = "1.2.840.10008.5.1.4.1.1.2"
ENHANCED = "1.2.840.10008.5.1.4.1.1.2.1"
SCREENSHOT = "1.2.840.10008.5.1.4.1.1.7"
EVERY = slice(None)


@dataclass(frozen=True, eq=False)
class Recipe:
    """How one folder is made: the series, edits of its slices, how it is written, edits of its files."""

    edit: Edit | None = None
    files: FileEdit | None = None
    orientation: tuple[float, ...] = AXIAL
    direction: tuple[float, ...] | None = None
    heights: tuple[float, ...] | None = None
    syntax: str = uid.ExplicitVRLittleEndian
    store: dict[str, Any] | None = None
    hu: Callable[[NDArray[np.int16]], NDArray[np.int16]] | None = None
    truth: Callable[[NDArray[np.int16]], NDArray[np.int16]] | None = None
    recovered: bool = False


def head(shape: tuple[int, int, int] = SHAPE) -> NDArray[np.int16]:
    """HU of a small round head: a skull of 900, 40 inside, and one bead on its left.

    Parameters
    ----------
    shape : tuple of int
        Planes, rows, columns.

    Returns
    -------
    ndarray of int16
        Every voxel has a pattern of its own that no order of the axes repeats.

    Examples
    --------
    >>> int(head().max()) > 1000, int(head().min())
    (True, -1000)
    """
    grid = np.meshgrid(*[np.linspace(-1, 1, n) for n in shape], indexing="ij")
    radius = np.sqrt(sum((g / s) ** 2 for g, s in zip(grid, (0.95, 0.8, 0.7), strict=True)))
    hu = np.where(radius > 1, -1000, np.where(radius > 0.8, 900, 40)).astype(np.int16)
    hu[shape[0] // 2, shape[1] // 2, -4:-2] = 1500
    return hu + (np.arange(hu.size) * 7 % 31).reshape(shape).astype(np.int16)


def write_folder(path: Path, recipe: Recipe) -> tuple[NDArray[np.int16], NDArray[np.float64]]:
    """Write one folder; its true HU and affine."""
    hu = head() if recipe.hu is None else recipe.hu(head())
    slices = make_series(hu, recipe)
    if recipe.edit is not None:
        recipe.edit(slices)
    path.mkdir(parents=True, exist_ok=True)
    for number, ds in enumerate(slices):
        save_file(path / f"image{number:04d}.dcm", ds, recipe.syntax)
    if recipe.files is not None:
        recipe.files(path)
    iop = np.array(recipe.orientation)
    along = np.cross(iop[:3], iop[3:]) if recipe.direction is None else np.array(recipe.direction)
    affine = np.eye(4)
    affine[:3] = np.stack([along * STEP_MM, iop[3:] * SPACING_MM[0], iop[:3] * SPACING_MM[1], ORIGIN_MM], axis=1)
    return (hu if recipe.truth is None else recipe.truth(hu)), affine


def make_series(hu: NDArray[np.int16], recipe: Recipe) -> Slices:
    """One data set per plane."""
    iop = np.array(recipe.orientation)
    along = np.cross(iop[:3], iop[3:]) if recipe.direction is None else np.array(recipe.direction)
    heights = np.arange(len(hu)) * STEP_MM if recipe.heights is None else np.array(recipe.heights)
    uids = [str(uid.generate_uid()) for _ in range(3)]
    slices = []
    for k, (plane, height) in enumerate(zip(hu, heights, strict=True)):
        ds = _common(uids, k)
        ds.ImageOrientationPatient = [f"{v:.10g}" for v in iop]
        ds.ImagePositionPatient = [f"{v:.10g}" for v in np.array(ORIGIN_MM) + height * along]
        store_hu(ds, plane, **(recipe.store or {}))
        slices.append(ds)
    return slices


def _common(uids: list[str], k: int) -> Dataset:
    ds = Dataset()
    ds.preamble, ds.file_meta = bytes(128), FileMetaDataset()
    ds.file_meta.FileMetaInformationGroupLength = 0  # the writer puts the true length
    ds.SOPClassUID, ds.SOPInstanceUID = _CT, uid.generate_uid()
    ds.Modality, ds.ImageType = "CT", ["ORIGINAL", "PRIMARY", "AXIAL"]
    ds.StudyInstanceUID, ds.SeriesInstanceUID, ds.FrameOfReferenceUID = uids
    ds.PatientName, ds.PatientID, ds.PatientBirthDate = "Nobody^At^All", "SYNTHETIC-1", "19000101"
    ds.SeriesNumber, ds.AcquisitionNumber, ds.InstanceNumber = 2, 1, k + 1
    ds.ConvolutionKernel, ds.SliceThickness = "H30s", STEP_MM
    ds.PixelSpacing = list(SPACING_MM)
    return ds


def store_hu(
    ds: Dataset,
    plane: NDArray,
    *,
    slope: float = 1,
    intercept: float = -1024,
    signed: bool = False,
    bits: int = 16,
    high: int | None = None,
) -> None:
    """Put HU into a data set as stored numbers."""
    stored = np.rint((plane.astype(float) - intercept) / slope).astype(np.int64)
    allocated = 8 if bits <= 8 else 16 if bits <= 16 else 32
    high = bits - 1 if high is None else high
    stored = (stored & (2**bits - 1)) << (high + 1 - bits) if high >= bits else stored
    ds.Rows, ds.Columns = plane.shape
    ds.SamplesPerPixel, ds.PhotometricInterpretation = 1, "MONOCHROME2"
    ds.BitsAllocated, ds.BitsStored, ds.HighBit, ds.PixelRepresentation = allocated, bits, high, int(signed)
    ds.PixelData = stored.astype(f"<{'i' if signed else 'u'}{allocated // 8}").tobytes()
    ds["PixelData"].VR = "OW"
    ds.RescaleSlope, ds.RescaleIntercept = slope, intercept


def save_file(path: Path, ds: Dataset, syntax: str) -> None:
    """Write one file; whoever edited the pixels says how they are encoded.

    Parameters
    ----------
    path : Path
    ds : Dataset
        Of one slice.
    syntax : str
        UID of its transfer syntax.
    """
    ds.file_meta.TransferSyntaxUID = uid.UID(syntax)
    ds.file_meta.MediaStorageSOPClassUID = ds.SOPClassUID
    ds.file_meta.MediaStorageSOPInstanceUID = ds.SOPInstanceUID
    kind = uid.UID(ds.file_meta.TransferSyntaxUID)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pydicom.dcmwrite(
            path,
            ds,
            force_encoding=True,
            implicit_vr=kind.is_implicit_VR,
            little_endian=kind.is_little_endian,
        )


def turned_axial(deg: float, axis: int) -> tuple[float, ...]:
    """The axial directions turned about a world axis."""
    c, s = float(np.cos(np.radians(deg))), float(np.sin(np.radians(deg)))
    turn = np.roll(np.array([[1, 0, 0], [0, c, -s], [0, s, c]]), (axis, axis), (0, 1))
    return tuple((turn @ np.array(AXIAL).reshape(2, 3).T).T.ravel().tolist())
