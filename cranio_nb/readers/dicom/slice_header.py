"""Data set -> one `SliceHeader` per image in it: what the image says about itself, without any patient text.

Lengths are mm, DICOM LPS. An absent value is None, a value that is no number is NaN: later steps refuse it, once it
is known whether the slice matters.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydicom.dataset import Dataset

from .elements import Converted, Elements, Vector
from .file_refusals import refusing
from .parse import OVERLAY_BITS, PixelPlace


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


def read_headers(
    dataset: Dataset, place: PixelPlace | None, file: int, converted: Converted | None = None
) -> list[SliceHeader]:
    """Read the header of each image in a file.

    Parameters
    ----------
    dataset : Dataset
        Its elements, from `parse.parse_file`.
    place : PixelPlace or None
        Where its pixels lie.
    file : int
        Index among the folder's files.
    converted : dict, optional
        Of the folder: what its other files said, as `Elements` takes it.

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
        return _headers_of(Elements(dataset, converted), place, file)


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


def _headers_of(elements: Elements, place: PixelPlace | None, file: int) -> list[SliceHeader]:
    if "Rows" not in elements or "Columns" not in elements:
        return []
    frames = int(elements.value("NumberOfFrames") or 1)
    # what a multi-frame file says of all frames, and of each
    shared = elements.first("SharedFunctionalGroupsSequence")
    per_frame = elements.items("PerFrameFunctionalGroupsSequence")
    common = _common(elements, place, file, frames)
    headers = []
    for frame in range(frames):
        groups = [per_frame[frame] if frame < len(per_frame) else None, shared]
        headers.append(SliceHeader(frame=frame, **common, **_placement(elements, groups, frame)))
    return headers


def _common(elements: Elements, place: PixelPlace | None, file: int, frames: int) -> dict[str, Any]:
    # of bits, the defaults of the standard
    allocated = elements.integer("BitsAllocated") or 0
    stored = elements.integer("BitsStored") or allocated
    high = elements.integer("HighBit")
    return {
        "file": file,
        "place": place,
        "frames": frames,
        "sop_class": elements.text("SOPClassUID"),
        "modality": elements.text("Modality"),
        "series": elements.text("SeriesInstanceUID"),
        "series_number": elements.integer("SeriesNumber"),
        "study": elements.text("StudyInstanceUID"),
        "frame_of_reference": elements.text("FrameOfReferenceUID"),
        "person": _person(elements),
        "acquisition": elements.text("AcquisitionNumber"),
        "kernel": _kernel(elements),
        "content_time": elements.text("ContentTime"),
        "rows": int(elements.value("Rows")),
        "cols": int(elements.value("Columns")),
        "padding": _padding(elements),
        "samples": elements.integer("SamplesPerPixel") or 1,
        "photometric": elements.text("PhotometricInterpretation"),
        "bits": (allocated, stored, stored - 1 if high is None else high),
        "signed": elements.integer("PixelRepresentation") == 1,
        "has_lut": "ModalityLUTSequence" in elements,
        "lossy": elements.text("LossyImageCompression") == "01",
        "overlay": any(tag in elements for tag in OVERLAY_BITS),
    }


def _placement(elements: Elements, groups: list[Elements | None], frame: int) -> dict[str, Any]:
    """What may differ between the frames of one file: read from the functional groups, else from the file."""

    def source(sequence: str) -> Elements:
        return next((item for g in groups if g is not None and (item := g.first(sequence)) is not None), elements)

    # a frame's own group goes before the shared one, and both before the file's own elements
    rescale = source("PixelValueTransformationSequence")
    measures = source("PixelMeasuresSequence")
    frame_type = source("CTImageFrameTypeSequence").texts("FrameType")
    return {
        "position": source("PlanePositionSequence").vector("ImagePositionPatient", 3),
        "orientation": source("PlaneOrientationSequence").vector("ImageOrientationPatient", 6),
        "spacing": measures.vector("PixelSpacing", 2),
        "thickness": measures.number("SliceThickness"),
        "slope": rescale.number("RescaleSlope"),
        "intercept": rescale.number("RescaleIntercept"),
        "tilt": source("CTAcquisitionDetailsSequence").number("GantryDetectorTilt"),
        "rescale_type": rescale.text("RescaleType"),
        "image_type": frame_type or elements.texts("ImageType"),
        "instance": elements.integer("InstanceNumber") if groups == [None, None] else frame,
    }


def _padding(elements: Elements) -> tuple[float, float] | None:
    value, limit = elements.number("PixelPaddingValue"), elements.number("PixelPaddingRangeLimit")
    if value is None or not np.isfinite(value):
        return None
    limit = value if limit is None or not np.isfinite(limit) else limit
    return min(value, limit), max(value, limit)


def _person(elements: Elements) -> tuple[str, str, str]:
    texts = [elements.text(keyword) for keyword in ("PatientID", "PatientName", "PatientBirthDate")]
    digests = [hashlib.sha256(t.rstrip("^ ").encode()).hexdigest() if t else "" for t in texts]
    return digests[0], digests[1], digests[2]


def _kernel(elements: Elements) -> str:
    """The kernel's name, cut down to characters that are safe to show."""
    joined = "/".join(elements.texts("ConvolutionKernel"))
    return "".join(c for c in joined if c.isascii() and (c.isalnum() or c in "+-./_ "))[:16]
