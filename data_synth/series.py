"""HU and affine -> a folder of DICOM files, one CT series with fictional header data.

Frames: voxel (plane, row, col) -> world mm, DICOM LPS. The headers follow the affine whatever its axes are; a shear
between planes becomes a gantry tilt.
"""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.uid import (
    CTImageStorage,
    DeflatedExplicitVRLittleEndian,
    ExplicitVRLittleEndian,
    ImplicitVRLittleEndian,
    JPEG2000Lossless,
    JPEGLSLossless,
    RLELossless,
    generate_uid,
)

from .phantom import leaning

Array = NDArray[np.float64]

SYNTAXES = {
    "explicit": ExplicitVRLittleEndian,
    "implicit": ImplicitVRLittleEndian,
    "deflated": DeflatedExplicitVRLittleEndian,
    "rle": RLELossless,
    "jpegls": JPEGLSLossless,
    "jpeg2000": JPEG2000Lossless,
}
"""Names of the transfer syntaxes, all lossless; "jpeg2000" needs an encoder that pydicom does not bring."""
_ORDERS = {
    "axial": ((0, 1, 2), (1, 1, 1)),
    "prone": ((0, 1, 2), (1, -1, -1)),
    "mirrored": ((0, 1, 2), (1, 1, -1)),
    "coronal": ((1, 0, 2), (1, -1, 1)),
    "sagittal": ((2, 0, 1), (1, -1, 1)),
}
ORIENTATIONS = tuple(_ORDERS)
"""How the voxels may be laid out in the files; every voxel keeps its place in the world."""


def write_dicom(
    folder: str | Path,
    hu: NDArray[np.int16],
    affine: ArrayLike,
    *,
    tilt_deg: float = 0.0,
    positions: ArrayLike | None = None,
    orientation: str = "axial",
    transfer_syntax: str = "explicit",
    series_description: str = "HEAD 2.5 SYNTHETIC",
    shuffle_names: bool = False,
) -> list[Path]:
    """Write a CT series.

    Parameters
    ----------
    folder : path
        A new or an empty folder; it is written whole or not at all.
    hu : ndarray of int16, shape (P, R, C)
        Stored exactly.
    affine : array_like, shape (4, 4)
        Voxel -> world mm (LPS). Rows and columns must be at right angles; planes may be sheared (gantry tilt).
    tilt_deg : float
        Extra lean of the planes about x; the voxels are taken as they are. `phantom_case(tilt_deg=...)` makes
        voxels that were sampled so, and an affine that already leans.
    positions : array_like, shape (P,), optional
        mm of each plane from plane 0 along the plane direction (uneven spacing); see `scan`.
    orientation : str
        One of `ORIENTATIONS`; `positions` go with "axial", "prone" and "mirrored" only.
    transfer_syntax : str
        A key of `SYNTAXES`.
    series_description : str
        Free text of the header.
    shuffle_names : bool
        Whether file names and instance numbers come in another order than the planes.

    Returns
    -------
    list of Path
        The files, in the order of the planes as stored.

    Raises
    ------
    ValueError
        If an option is unknown or does not fit the others.
    FileExistsError
        If the folder holds files, or is a file.

    Notes
    -----
    Equal arguments give equal bytes: the identifiers are derived from the voxels and the geometry.
    """
    affine = leaning(affine, tilt_deg)
    _check(hu, orientation, transfer_syntax, positions)
    voxels, grid = _reordered(hu, affine, orientation)
    starts = _plane_starts(grid, len(voxels), positions)
    common = _common_header(voxels, grid, starts, transfer_syntax, series_description)
    order = np.random.default_rng(len(voxels)).permutation(len(voxels)) if shuffle_names else np.arange(len(voxels))
    names = [f"IM{number + 1:04d}.dcm" for number in order]
    with new_folder(folder) as part:
        for dataset, name in zip(_slices(common, voxels, starts, order), names, strict=True):
            dataset.save_as(part / name, enforce_file_format=True)
    return [Path(folder) / name for name in names]


@contextmanager
def new_folder(folder: str | Path) -> Iterator[Path]:
    """A temporary folder beside `folder` that takes its place at the end, or vanishes after an error.

    Parameters
    ----------
    folder : path
        A new or an empty folder.

    Returns
    -------
    context manager
        Gives the path of the temporary folder.

    Raises
    ------
    FileExistsError
        If `folder` holds files, or is a file.
    """
    folder = Path(folder).absolute()
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise FileExistsError(f"{folder.name!r} exists and is not empty; nothing was written. Give a new folder.")
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=f".{folder.name}-", dir=folder.parent) as temporary:
        part = Path(temporary) / folder.name
        part.mkdir()
        yield part
        if folder.exists():
            folder.rmdir()
        part.rename(folder)


def _check(hu: NDArray, orientation: str, transfer_syntax: str, positions: ArrayLike | None) -> None:
    if hu.ndim != 3 or hu.dtype != np.int16:
        raise ValueError(f"HU of type int16 and shape (P, R, C) are wanted, not {hu.dtype} {hu.shape}.")
    if orientation not in _ORDERS:
        raise ValueError(f"There is no orientation {orientation!r}; choose one of {', '.join(_ORDERS)}.")
    if transfer_syntax not in SYNTAXES:
        raise ValueError(f"There is no transfer syntax {transfer_syntax!r}; choose one of {', '.join(SYNTAXES)}.")
    if positions is not None and (np.shape(positions) != hu.shape[:1] or _ORDERS[orientation][0][0] != 0):
        raise ValueError(f"positions needs one value for each of {hu.shape[0]} planes, and planes as files.")


def _reordered(hu: NDArray[np.int16], affine: Array, orientation: str) -> tuple[NDArray[np.int16], Array]:
    """Voxels with permuted and flipped axes, and the affine that keeps each at its place."""
    axes, signs = _ORDERS[orientation]
    voxels = hu.transpose(axes)[tuple(slice(None, None, sign) for sign in signs)]
    steps = affine[:3, list(axes)]
    last = np.where(np.array(signs) < 0, np.array(voxels.shape) - 1, 0)
    grid = np.eye(4)
    grid[:3, :3], grid[:3, 3] = steps * signs, affine[:3, 3] + steps @ last
    return np.ascontiguousarray(voxels), grid


def _plane_starts(grid: Array, count: int, positions: ArrayLike | None) -> Array:
    """World mm (P, 3) of each plane's first voxel."""
    step = grid[:3, 0]
    at = np.arange(count) if positions is None else np.asarray(positions, float) / np.linalg.norm(step)
    return grid[:3, 3] + at[:, None] * step


def _common_header(
    voxels: NDArray[np.int16], grid: Array, starts: Array, transfer_syntax: str, description: str
) -> Dataset:
    """Everything the slices share."""
    geometry = repr((grid.tolist(), starts.tolist(), transfer_syntax, description)).encode()
    seed = hashlib.sha256(voxels.tobytes() + geometry).hexdigest()
    ds = Dataset()
    ds.file_meta = FileMetaDataset()
    ds.file_meta.TransferSyntaxUID = SYNTAXES[transfer_syntax]
    ds.file_meta.MediaStorageSOPClassUID = ds.SOPClassUID = CTImageStorage
    ds.StudyInstanceUID = generate_uid(entropy_srcs=[seed, "study"])
    ds.SeriesInstanceUID = generate_uid(entropy_srcs=[seed, "series"])
    ds.FrameOfReferenceUID = generate_uid(entropy_srcs=[seed, "frame"])
    _add_fiction(ds, description)
    _add_geometry(ds, grid, starts)
    return ds


def _add_fiction(ds: Dataset, description: str) -> None:
    ds.SpecificCharacterSet = "ISO_IR 192"
    ds.ImageType = ["ORIGINAL", "PRIMARY", "AXIAL"]
    ds.PatientName, ds.PatientID, ds.PatientSex, ds.PatientBirthDate = "Phantom^Head", "SYNTHETIC-0", "O", "19000101"
    ds.StudyDate = ds.SeriesDate = ds.AcquisitionDate = ds.ContentDate = "20000102"
    ds.StudyTime = ds.SeriesTime = ds.AcquisitionTime = ds.ContentTime = "101500"
    ds.StudyID, ds.AccessionNumber, ds.ReferringPhysicianName = "1", "", ""
    ds.Modality, ds.Manufacturer, ds.ManufacturerModelName = "CT", "Fictional", "Phantom"
    ds.StudyDescription, ds.SeriesDescription, ds.BodyPartExamined = "SYNTHETIC HEAD", description, "HEAD"
    ds.SeriesNumber, ds.AcquisitionNumber, ds.KVP, ds.PatientPosition = 2, 1, "120", "HFS"
    ds.ConvolutionKernel, ds.PositionReferenceIndicator, ds.Laterality = "STANDARD", "", ""


def _add_geometry(ds: Dataset, grid: Array, starts: Array) -> None:
    rows, cols = (float(np.linalg.norm(grid[:3, axis])) for axis in (1, 2))
    down, across = grid[:3, 1] / rows, grid[:3, 2] / cols
    normal = np.cross(across, down)
    step = grid[:3, 0] / np.linalg.norm(grid[:3, 0])
    ds.ImageOrientationPatient = [_decimal(v) for v in (*across, *down)]
    ds.PixelSpacing = [_decimal(rows), _decimal(cols)]
    ds.SliceThickness = _decimal(float(np.median(np.abs(np.diff(starts @ normal)))) if len(starts) > 1 else 1.0)
    lean = np.rad2deg(np.arcsin(np.clip(step @ down, -1, 1)))  # positive: the rows at the back are raised
    ds.GantryDetectorTilt = _decimal(round(float(lean), 6) + 0.0)


def _slices(common: Dataset, voxels: NDArray[np.int16], starts: Array, order: NDArray[np.intp]) -> Iterator[Dataset]:
    """One dataset per plane; HU are stored as unsigned numbers above an intercept, as most scanners do."""
    intercept = -1024 if voxels.min() >= -1024 else -32768
    bits = 12 if voxels.max() - np.int64(intercept) < 4096 else 16
    for k, (plane, number) in enumerate(zip(voxels, order, strict=True)):
        ds = Dataset(common)
        ds.file_meta = FileMetaDataset(common.file_meta)
        uid = generate_uid(entropy_srcs=[common.SeriesInstanceUID, str(k)])
        ds.SOPInstanceUID = ds.file_meta.MediaStorageSOPInstanceUID = uid
        ds.InstanceNumber = int(number) + 1
        ds.ImagePositionPatient = [_decimal(v) for v in starts[k]]
        ds.RescaleIntercept, ds.RescaleSlope, ds.RescaleType = intercept, 1, "HU"
        ds.WindowCenter, ds.WindowWidth = 400, 1800
        _add_pixels(ds, (plane.astype(np.int32) - intercept).astype("<u2"), bits)
        yield ds


def _add_pixels(ds: Dataset, stored: NDArray[np.uint16], bits: int) -> None:
    ds.SamplesPerPixel, ds.PhotometricInterpretation = 1, "MONOCHROME2"
    ds.Rows, ds.Columns = stored.shape
    ds.BitsAllocated, ds.BitsStored, ds.HighBit, ds.PixelRepresentation = 16, bits, bits - 1, 0
    syntax = ds.file_meta.TransferSyntaxUID
    ds.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
    ds.PixelData = stored.tobytes()
    ds["PixelData"].VR = "OW"
    if syntax.is_encapsulated:
        ds.compress(syntax, generate_instance_uid=False)
    ds.file_meta.TransferSyntaxUID = syntax


def _decimal(value: float) -> str:
    """A decimal string of at most 16 characters, as the standard asks."""
    text = f"{value:.10f}".rstrip("0").rstrip(".")
    return text if len(text) <= 16 else f"{value:.9g}"
