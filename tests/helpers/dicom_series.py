"""A small head as a DICOM series, so that the reader tests can write any series and break it in any way."""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import pydicom
import pytest
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.uid import UID, ExplicitVRLittleEndian, generate_uid

from cranio_nb.errors import InputRefused
from cranio_nb.readers import LoadReport, read_ct
from cranio_nb.readers.dicom.parse import parse_file
from cranio_nb.readers.dicom.slice_header import SliceHeader, read_headers
from cranio_nb.volume import Volume
from data_synth.fault_series import Edit

CT_IMAGE = "1.2.840.10008.5.1.4.1.1.2"
AXIAL = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0)
ORIGIN = (-22.0, -18.5, 101.25)
SPACING = (0.9, 0.95)  # mm between rows, between columns
STEP = 1.5
SHAPE = (24, 42, 48)


def head(shape: tuple[int, int, int] = SHAPE) -> np.ndarray:
    """HU of a round head, int16, shape (planes, rows, cols): a skull of 900, 40 inside, and one bead on its left."""
    grid = np.meshgrid(*[np.linspace(-1, 1, n) for n in shape], indexing="ij")
    radius = np.sqrt(sum((g / s) ** 2 for g, s in zip(grid, (0.95, 0.8, 0.7), strict=True)))
    hu = np.where(radius > 1, -1000, np.where(radius > 0.8, 900, 40)).astype(np.int16)
    hu[shape[0] // 2, shape[1] // 2, -4:-2] = 1500
    # a pattern of its own for every voxel that no axis order repeats
    return hu + (np.arange(hu.size) * 7 % 31).reshape(shape).astype(np.int16)


def series(
    hu: np.ndarray,
    *,
    orientation: Iterable[float] = AXIAL,
    origin: Iterable[float] = ORIGIN,
    spacing: tuple[float, float] = SPACING,
    step: float = STEP,
    heights: Iterable[float] | None = None,
    direction: Iterable[float] | None = None,
    slope: float = 1,
    intercept: float = -1024,
    signed: bool = False,
    bits: int = 16,
) -> list[Dataset]:
    """One data set per plane, `step` mm apart along the normal (or along `direction`, or at `heights` along it)."""
    iop = np.array(list(orientation), float)
    along = np.cross(iop[:3], iop[3:]) if direction is None else np.array(list(direction), float)
    at = np.arange(len(hu)) * step if heights is None else np.array(list(heights), float)
    uids = {name: generate_uid() for name in ("study", "series", "frame")}
    made = []
    for k, (plane, height) in enumerate(zip(hu, at, strict=True)):
        ds = _common(uids, k)
        ds.ImageOrientationPatient = [f"{v:.10g}" for v in iop]
        ds.ImagePositionPatient = [f"{v:.10g}" for v in np.array(list(origin)) + height * along]
        ds.PixelSpacing = list(spacing)
        stored = np.rint((plane.astype(float) - intercept) / slope).astype(np.int64)
        set_pixels(ds, stored, signed=signed, bits=bits)
        ds.RescaleSlope, ds.RescaleIntercept = slope, intercept
        made.append(ds)
    return made


def _common(uids: dict[str, str], k: int) -> Dataset:
    ds = Dataset()
    ds.preamble, ds.file_meta = bytes(128), FileMetaDataset()
    ds.file_meta.FileMetaInformationGroupLength = 0  # the writer puts the true length
    ds.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
    ds.SOPClassUID, ds.SOPInstanceUID = CT_IMAGE, generate_uid()
    ds.Modality, ds.ImageType = "CT", ["ORIGINAL", "PRIMARY", "AXIAL"]
    ds.StudyInstanceUID, ds.SeriesInstanceUID = uids["study"], uids["series"]
    ds.FrameOfReferenceUID = uids["frame"]
    ds.PatientName, ds.PatientID, ds.PatientBirthDate = "Nobody^At^All", "SECRET-1", "19000101"
    ds.SeriesDescription = "../../<script>alert(1)</script> $(touch owned)"
    ds.SeriesNumber, ds.AcquisitionNumber, ds.InstanceNumber = 2, 1, k + 1
    ds.ConvolutionKernel, ds.SliceThickness = "H30s", STEP
    return ds


def set_pixels(ds: Dataset, stored: np.ndarray, *, signed: bool = False, bits: int = 16) -> None:
    """Put numbers into a data set, in as many bytes as their bits need."""
    allocated = 8 if bits <= 8 else 16 if bits <= 16 else 32
    ds.Rows, ds.Columns = stored.shape
    ds.SamplesPerPixel, ds.PhotometricInterpretation = 1, "MONOCHROME2"
    ds.BitsAllocated, ds.BitsStored, ds.HighBit = allocated, bits, bits - 1
    ds.PixelRepresentation = int(signed)
    ds.PixelData = stored.astype(f"<{'i' if signed else 'u'}{allocated // 8}").tobytes()
    ds["PixelData"].VR = "OW"


def save(folder: Path, datasets: Iterable[Dataset], *, syntax: str | None = None) -> Path:
    """Write the data sets as files of a folder and return it; `syntax` rewrites or relabels them."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, ds in enumerate(datasets):
        if syntax is not None:
            ds.file_meta.TransferSyntaxUID = syntax
        ds.file_meta.MediaStorageSOPClassUID = ds.SOPClassUID
        ds.file_meta.MediaStorageSOPInstanceUID = ds.SOPInstanceUID
        with warnings.catch_warnings():
            # it is the data set, not the writer, that says how it is encoded
            warnings.simplefilter("ignore")
            kind = UID(ds.file_meta.TransferSyntaxUID)
            order = {"implicit_vr": kind.is_implicit_VR, "little_endian": kind.is_little_endian}
            path = folder / f"image{number:04d}.dcm"
            pydicom.dcmwrite(path, ds, force_encoding=True, **order)
    return folder


def save_changed(folder: Path, change: Edit) -> Path:
    """A folder with the series of the head after an edit."""
    datasets = series(head())
    change(datasets)
    return save(folder / "scan", datasets)


def refusal(folder: Path, **options: object) -> InputRefused:
    """The refusal of a folder; its text must give nothing away."""
    with pytest.raises(InputRefused) as caught:
        read_ct(folder, **options)
    error = caught.value
    for secret in (str(folder), "SECRET", "Nobody", "image0", "script", "Traceback"):
        assert secret not in str(error)
    assert error.message.endswith(".") and len(error.message) < 300
    assert error.__cause__ is None
    return error


def codes(report: LoadReport) -> set[str]:
    """The findings' codes; whatever they hold can be stored as JSON."""
    json.dumps([finding.values for finding in report.findings], allow_nan=False)
    return {finding.code for finding in report.findings}


def truth(orientation: object = AXIAL) -> np.ndarray:
    """(plane, row, col) index -> LPS mm of `series(head())`."""
    iop = np.array(orientation, float)
    cols, rows = iop[:3], iop[3:]
    affine = np.eye(4)
    affine[:3] = np.stack([np.cross(cols, rows) * STEP, rows * SPACING[0], cols * SPACING[1], ORIGIN], axis=1)
    return affine


def assert_same_places(volume: Volume, hu: np.ndarray, affine: np.ndarray, tol: float = 1e-3) -> None:
    """Every voxel of (hu, affine) is in the volume, at its own place."""
    index = np.stack(np.meshgrid(*map(np.arange, hu.shape), indexing="ij"), axis=-1).reshape(-1, 3)
    at = volume.to_voxel(index @ affine[:3, :3].T + affine[:3, 3])
    assert np.abs(at - np.rint(at)).max() < tol
    np.testing.assert_array_equal(volume.voxels[tuple(np.rint(at).astype(int).T)], hu.ravel())


def patch(path: Path, old: bytes, new: bytes) -> None:
    content = path.read_bytes()
    assert content.count(old) == 1 and len(old) == len(new)
    path.write_bytes(content.replace(old, new))


def read_folder(folder: Path) -> list[SliceHeader]:
    """Headers of all images of a folder, by file name."""
    headers = []
    for index, path in enumerate(sorted(folder.iterdir())):
        parsed = parse_file(path, index)
        assert parsed is not None
        headers += read_headers(*parsed, index)
    return headers


def shift_hu(by: float, factor: float = 1) -> Callable[[list[Dataset]], None]:
    def change(datasets: list[Dataset]) -> None:
        for ds in datasets:
            stored = np.frombuffer(ds.PixelData, "<u2").reshape(ds.Rows, ds.Columns).astype(float)
            set_pixels(ds, ((stored - 1024) * factor + by + 8192).astype(int))
            ds.RescaleIntercept = -8192

    return change


def as_unsigned_without_rescale(datasets: list[Dataset]) -> None:
    for ds in datasets:
        del ds.RescaleSlope, ds.RescaleIntercept
