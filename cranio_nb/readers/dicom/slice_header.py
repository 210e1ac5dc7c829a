"""Data set -> one `SliceHeader` per image in it: what the image says about itself, without any patient text.

Lengths are mm, DICOM LPS. An absent value is None, a value that is no number is NaN: later steps refuse it, once it
is known whether the slice matters.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydicom.dataset import Dataset

from .file_refusals import refusing
from .parse import OVERLAY_BITS, PixelPlace

Vector = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SliceHeader:
    """What one image says about itself; `read_headers` makes it.

    Parameters
    ----------
    file : int
        Index among the folder's files.
    place : PixelPlace or None
        Where its pixels lie; None for an image without pixel data.
    frame, frames : int
        Index among the images of its file, and how many they are.
    sop_class, modality, series, study, frame_of_reference, acquisition, content_time, rescale_type, photometric : str
        The elements' own text; empty where absent.
    image_type : tuple of str
    series_number, instance : int or None
        Numbers of the series, and of the image in it.
    person : tuple of str
        Digests of the identity, good only for telling two patients apart.
    kernel : str
        Name of the reconstruction kernel.
    thickness : float or None
        mm.
    rows, cols : int
        px.
    position : ndarray, shape (3,), or None
        Centre of the first pixel, mm, LPS.
    orientation : ndarray, shape (6,), or None
        Unit directions in which the column and the row index grow, LPS.
    spacing : ndarray, shape (2,), or None
        mm between rows, and between columns.
    slope, intercept : float or None
        HU = stored * slope + intercept.
    tilt : float or None
        Degrees by which the gantry is said to be tilted.
    padding : tuple of float or None
        Closed range of stored values that mean "outside the field of view".
    samples : int
        Numbers a pixel.
    bits : tuple of int
        Allocated, stored, and the highest of the stored, counted from 0.
    signed, has_lut, lossy, overlay : bool
        Whether stored numbers have a sign; HU are given by a table; the pixels were compressed with loss; bits of
        the pixels hold graphics.
    """

    file: int
    place: PixelPlace | None
    frame: int
    frames: int
    sop_class: str
    modality: str
    image_type: tuple[str, ...]
    series: str
    series_number: int | None
    study: str
    frame_of_reference: str
    person: tuple[str, str, str]
    acquisition: str
    kernel: str
    content_time: str
    instance: int | None
    thickness: float | None
    rows: int
    cols: int
    position: Vector | None
    orientation: Vector | None
    spacing: Vector | None
    slope: float | None
    intercept: float | None
    rescale_type: str
    tilt: float | None
    padding: tuple[float, float] | None
    samples: int
    photometric: str
    bits: tuple[int, int, int]
    signed: bool
    has_lut: bool
    lossy: bool
    overlay: bool


def read_headers(dataset: Dataset, place: PixelPlace | None, file: int) -> list[SliceHeader]:
    """Read the header of each image in a file.

    Parameters
    ----------
    dataset : Dataset
        Its elements, from `parse.parse_file`.
    place : PixelPlace or None
        Where its pixels lie.
    file : int
        Index among the folder's files.

    Returns
    -------
    list of SliceHeader
        One for a classic file, one a frame for a multi-frame file, none for a file without images.

    Raises
    ------
    InputRefused
        ``CorruptDicom`` where the elements cannot be made sense of.

    Examples
    --------
    >>> from data_synth import write_dicom
    >>> from .parse import parse_file
    >>> affine = np.array([[0, 0, 0.5, -10], [0, 0.5, 0, -20], [2.5, 0, 0, 100], [0, 0, 0, 1]])
    >>> path = write_dicom("scan", np.zeros((8, 4, 6), np.int16), affine)[3]
    >>> (header,) = read_headers(*parse_file(path, 0), 0)
    >>> header.position, header.spacing, (header.rows, header.cols)
    (array([-10. , -20. , 107.5]), array([0.5, 0.5]), (4, 6))
    """
    with refusing(file):
        return _headers_of(dataset, place, file)


def count_frames(dataset: Dataset, file: int) -> int:
    """Count the images that a file declares, before a header is made for each.

    Parameters
    ----------
    dataset : Dataset
        Its elements, from `parse.parse_file`.
    file : int
        Index among the folder's files.

    Returns
    -------
    int
        0 for a file without images.

    Examples
    --------
    >>> count_frames(Dataset(), 0)
    0
    """
    with refusing(file):
        return int(dataset.get("NumberOfFrames") or 1) if "Rows" in dataset and "Columns" in dataset else 0


def _headers_of(dataset: Dataset, place: PixelPlace | None, file: int) -> list[SliceHeader]:
    if "Rows" not in dataset or "Columns" not in dataset:
        return []
    frames = int(dataset.get("NumberOfFrames") or 1)
    # what a multi-frame file says of all frames, and of each
    shared = _first(dataset, "SharedFunctionalGroupsSequence")
    per_frame = dataset.get("PerFrameFunctionalGroupsSequence") or []
    common = _common(dataset, place, file, frames)
    headers = []
    for frame in range(frames):
        groups = [per_frame[frame] if frame < len(per_frame) else None, shared]
        headers.append(SliceHeader(frame=frame, **common, **_placement(dataset, groups, frame)))
    return headers


def _common(dataset: Dataset, place: PixelPlace | None, file: int, frames: int) -> dict[str, Any]:
    # of bits, the defaults of the standard
    allocated = _int(dataset, "BitsAllocated") or 0
    stored = _int(dataset, "BitsStored") or allocated
    high = _int(dataset, "HighBit")
    return {
        "file": file,
        "place": place,
        "frames": frames,
        "sop_class": _text(dataset, "SOPClassUID"),
        "modality": _text(dataset, "Modality"),
        "series": _text(dataset, "SeriesInstanceUID"),
        "series_number": _int(dataset, "SeriesNumber"),
        "study": _text(dataset, "StudyInstanceUID"),
        "frame_of_reference": _text(dataset, "FrameOfReferenceUID"),
        "person": _person(dataset),
        "acquisition": _text(dataset, "AcquisitionNumber"),
        "kernel": _kernel(dataset),
        "content_time": _text(dataset, "ContentTime"),
        "rows": int(dataset.Rows),
        "cols": int(dataset.Columns),
        "padding": _padding(dataset),
        "samples": _int(dataset, "SamplesPerPixel") or 1,
        "photometric": _text(dataset, "PhotometricInterpretation"),
        "bits": (allocated, stored, stored - 1 if high is None else high),
        "signed": _int(dataset, "PixelRepresentation") == 1,
        "has_lut": "ModalityLUTSequence" in dataset,
        "lossy": _text(dataset, "LossyImageCompression") == "01",
        "overlay": any(tag in dataset for tag in OVERLAY_BITS),
    }


def _placement(dataset: Dataset, groups: list[Dataset | None], frame: int) -> dict[str, Any]:
    """What may differ between the frames of one file: read from the functional groups, else from the file."""

    def source(sequence: str) -> Dataset:
        return next((item for g in groups if g is not None and (item := _first(g, sequence)) is not None), dataset)

    # a frame's own group goes before the shared one, and both before the file's own elements
    rescale = source("PixelValueTransformationSequence")
    measures = source("PixelMeasuresSequence")
    frame_type = _texts(source("CTImageFrameTypeSequence"), "FrameType")
    return {
        "position": _floats(source("PlanePositionSequence"), "ImagePositionPatient", 3),
        "orientation": _floats(source("PlaneOrientationSequence"), "ImageOrientationPatient", 6),
        "spacing": _floats(measures, "PixelSpacing", 2),
        "thickness": _float(measures, "SliceThickness"),
        "slope": _float(rescale, "RescaleSlope"),
        "intercept": _float(rescale, "RescaleIntercept"),
        "tilt": _float(source("CTAcquisitionDetailsSequence"), "GantryDetectorTilt"),
        "rescale_type": _text(rescale, "RescaleType"),
        "image_type": frame_type or _texts(dataset, "ImageType"),
        "instance": _int(dataset, "InstanceNumber") if groups == [None, None] else frame,
    }


def _first(dataset: Dataset, keyword: str) -> Dataset | None:
    sequence = dataset.get(keyword)
    return sequence[0] if sequence else None


def _value(dataset: Dataset, keyword: str) -> Any:
    """An element's value; None where absent or empty, NaN where its text is not of its kind."""
    try:
        value = dataset.get(keyword)
    except Exception:
        # a value that cannot be converted, e.g. letters in a number
        return float("nan")
    return None if value is None or (isinstance(value, str) and not value.strip()) else value


def _text(dataset: Dataset, keyword: str) -> str:
    value = _value(dataset, keyword)
    return "" if value is None else str(value).strip()


def _texts(dataset: Dataset, keyword: str) -> tuple[str, ...]:
    value = _value(dataset, keyword)
    values = [] if value is None else [value] if isinstance(value, str | float) else value
    return tuple(str(v).strip().upper() for v in values)


def _float(dataset: Dataset, keyword: str) -> float | None:
    value = _value(dataset, keyword)
    try:
        return None if value is None else float(value)
    except (TypeError, ValueError):
        return float("nan")


def _int(dataset: Dataset, keyword: str) -> int | None:
    value = _float(dataset, keyword)
    return None if value is None or not np.isfinite(value) else int(value)


def _floats(dataset: Dataset, keyword: str, count: int) -> Vector | None:
    """`count` numbers of an element; NaN where there are fewer, more, or other things."""
    value = _value(dataset, keyword)
    if value is None:
        return None
    try:
        numbers = np.array([float(v) for v in value])
    except (TypeError, ValueError):
        numbers = np.array([])
    return numbers if numbers.shape == (count,) else np.full(count, np.nan)


def _padding(dataset: Dataset) -> tuple[float, float] | None:
    value, limit = _float(dataset, "PixelPaddingValue"), _float(dataset, "PixelPaddingRangeLimit")
    if value is None or not np.isfinite(value):
        return None
    limit = value if limit is None or not np.isfinite(limit) else limit
    return min(value, limit), max(value, limit)


def _person(dataset: Dataset) -> tuple[str, str, str]:
    texts = [_text(dataset, k) for k in ("PatientID", "PatientName", "PatientBirthDate")]
    digests = [hashlib.sha256(t.rstrip("^ ").encode()).hexdigest() if t else "" for t in texts]
    return digests[0], digests[1], digests[2]


def _kernel(dataset: Dataset) -> str:
    """The kernel's name, cut down to characters that are safe to show."""
    joined = "/".join(_texts(dataset, "ConvolutionKernel"))
    return "".join(c for c in joined if c.isascii() and (c.isalnum() or c in "+-./_ "))[:16]
