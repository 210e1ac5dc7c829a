"""DICOM file -> its data set up to the pixels, and where the pixels lie. Nothing is decoded.

The file is not trusted: elements, sides and frames are capped here, before anything is allocated for them (`inflated`
caps the bytes of a deflated file).
"""

from __future__ import annotations

import io
import struct
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path
from typing import BinaryIO

from pydicom.datadict import tag_for_keyword
from pydicom.dataset import Dataset
from pydicom.filereader import read_dataset
from pydicom.tag import BaseTag
from pydicom.uid import ExplicitVRBigEndian, ImplicitVRLittleEndian

from .file_list import looks_like_dicom
from .file_refusals import corrupt, over_limit, refusing
from .inflated import Inflated, open_dataset

MAX_SIDE = 4096  # rows, columns
MAX_SLICES = 4000
_MAX_ELEMENTS = 50_000  # before the pixels; the standard knows some 5,000
_MAX_ITEMS, _MAX_ITEMS_PER_FRAME = 256, 16  # of encapsulated pixel data: so many, and so many more for each frame
UNDEFINED_LENGTH = 0xFFFFFFFF
# CT images, classic and multi-frame; some writers leave the class out
CT_CLASSES = {"", "1.2.840.10008.5.1.4.1.1.2", "1.2.840.10008.5.1.4.1.1.2.1", "1.2.840.10008.5.1.4.1.1.2.2"}
_FLOAT_PIXELS = (0x7FE00008, 0x7FE00009)
_PIXELS = frozenset({*_FLOAT_PIXELS, 0x7FE00010})
_ITEM, _SEQUENCE_END = 0xFFFEE000, 0xFFFEE0DD
_KEYWORDS = (
    "SOPClassUID Modality ImageType SeriesInstanceUID StudyInstanceUID SeriesNumber AcquisitionNumber InstanceNumber "
    "ContentTime ConvolutionKernel PatientID PatientName PatientBirthDate FrameOfReferenceUID Rows Columns "
    "SamplesPerPixel PhotometricInterpretation BitsAllocated BitsStored HighBit PixelRepresentation NumberOfFrames "
    "PixelSpacing ImagePositionPatient ImageOrientationPatient SliceThickness RescaleSlope RescaleIntercept "
    "RescaleType GantryDetectorTilt ModalityLUTSequence PixelPaddingValue PixelPaddingRangeLimit "
    "LossyImageCompression SharedFunctionalGroupsSequence PerFrameFunctionalGroupsSequence"
).split()
OVERLAY_BITS: list[BaseTag | int] = [
    BaseTag(0x60000102 + 0x20000 * i) for i in range(16)
]  # which bit of a pixel holds graphics
_TAGS: list[BaseTag | int] = [*(BaseTag(tag) for tag in map(tag_for_keyword, _KEYWORDS) if tag), *OVERLAY_BITS]


@dataclass(frozen=True)
class PixelPlace:
    """Where the pixel data of a file lie.

    Parameters
    ----------
    path : Path
        The file.
    file : int
        Its index among the folder's files, for messages.
    syntax : str
        UID of the transfer syntax.
    offset : int
        Bytes from the start of the file (inflated, where it is deflated) to the pixel data.
    length : int
        Bytes of pixel data; `UNDEFINED_LENGTH` for encapsulated data.
    is_float : bool
        Whether they are floating-point numbers.
    inflated : int
        Bytes that were inflated to find this place; 0 where it is not deflated.
    items : tuple of (int, int)
        Offset and bytes of each item of encapsulated data, the table of offsets first; else empty.
    """

    path: Path
    file: int
    syntax: str
    offset: int
    length: int
    is_float: bool
    inflated: int = 0
    items: tuple[tuple[int, int], ...] = ()


def parse_file(path: Path, file: int) -> tuple[Dataset, PixelPlace | None] | None:
    """Parse one file: the elements that matter, and the place of its pixels.

    Parameters
    ----------
    path : Path
        A regular file.
    file : int
        Its index among the folder's files.

    Returns
    -------
    (Dataset, PixelPlace or None) or None
        None where the file is not DICOM; no place where it holds no pixel data.

    Raises
    ------
    InputRefused
        ``CorruptDicom``, ``CorruptPixelData`` or ``LimitExceeded``, naming the file by its index.

    Examples
    --------
    >>> import numpy as np
    >>> from data_synth import write_dicom
    >>> path = write_dicom("scan", np.zeros((8, 4, 6), np.int16), np.eye(4)[[2, 1, 0, 3]])[0]
    >>> dataset, place = parse_file(path, 0)
    >>> dataset.Rows, dataset.Columns, place.length
    (4, 6, 48)
    """
    with open(path, "rb") as stream:
        if not looks_like_dicom(stream.read(136)):
            return None
        with refusing(file):
            return _parse_stream(stream, path, file)


def _parse_stream(stream: BinaryIO, path: Path, file: int) -> tuple[Dataset, PixelPlace | None]:
    """The elements before the pixels; the reading stops at the pixels and notes where that is."""
    meta, data = open_dataset(stream, file)
    syntax = str(meta.get("TransferSyntaxUID") or ImplicitVRLittleEndian)
    places: list[PixelPlace] = []
    elements = count()

    def at_pixels(tag: int, vr: str | None, length: int) -> bool:
        # 256 MB of inflated zeros would be 32 million empty elements, which take a minute
        if next(elements) >= _MAX_ELEMENTS:
            raise over_limit(file, "elements", f"more than {_MAX_ELEMENTS}", _MAX_ELEMENTS)
        if tag in _PIXELS:
            places.append(PixelPlace(path, file, syntax, data.tell(), length, tag in _FLOAT_PIXELS))
        return tag in _PIXELS

    implicit, little = syntax == ImplicitVRLittleEndian, syntax != ExplicitVRBigEndian
    dataset = read_dataset(data, implicit, little, stop_when=at_pixels, specific_tags=_TAGS)

    # what is declared must be there
    if not places:
        _check_end(data, meta, dataset, file)
    if "Rows" in dataset or "Columns" in dataset:
        _check_sides(dataset, file)
    return dataset, _completed(data, places[0], dataset) if places else None


def _check_end(data: BinaryIO, meta: Dataset, dataset: Dataset, file: int) -> None:
    """A file without pixel data must end where its last element does, and must not be one that has an image."""
    if not _ends_here(data) or _last_is_cut(meta) or _last_is_cut(dataset):
        raise corrupt(file, "ends in the middle of an element")
    sop_class = dataset.get("SOPClassUID") or meta.get("MediaStorageSOPClassUID") or ""
    if "Rows" not in dataset and sop_class in CT_CLASSES:
        raise corrupt(file, "ends before its image")


def _ends_here(data: BinaryIO) -> bool:
    """Whether a stream ends where it stands, and not before or behind."""
    position = data.tell()
    if isinstance(data, Inflated):
        return not data.read(1) and data.size == position
    return position == data.seek(0, io.SEEK_END)


def _last_is_cut(dataset: Dataset) -> bool:
    """Whether the last element holds fewer bytes than it declares."""
    tags = list(dataset.keys())
    last = dataset.get_item(tags[-1]) if tags else None
    value, length = getattr(last, "value", None), getattr(last, "length", 0)
    return isinstance(value, bytes) and len(value) != length


def _check_sides(dataset: Dataset, file: int) -> None:
    """Refuse images without size, or with one beyond the limits."""
    sides = (("rows", "Rows", MAX_SIDE), ("columns", "Columns", MAX_SIDE), ("frames", "NumberOfFrames", MAX_SLICES))
    for what, keyword, cap in sides:
        declared = dataset.get(keyword, 1 if what == "frames" else None)
        if declared is None or int(declared) < 1:
            raise corrupt(file, f"declares no {what}")
        if int(declared) > cap:
            raise over_limit(file, what, int(declared), cap)


def _completed(data: BinaryIO, place: PixelPlace, dataset: Dataset) -> PixelPlace:
    """The place with its items; the declared pixel data must lie inside the file, encapsulated data reach their end."""
    frames = int(dataset.get("NumberOfFrames") or 1)
    if isinstance(data, Inflated):
        # whether all is there shows when it is read: nothing is inflated before it is wanted
        if place.length == UNDEFINED_LENGTH or place.length < frames:
            raise corrupt(place.file, "is cut short: pixel data are missing", "CorruptPixelData")
        return replace(place, inflated=data.size)
    size = data.seek(0, io.SEEK_END)
    if place.length != UNDEFINED_LENGTH:
        # a header that promises more frames than bytes is not believed
        complete = place.offset + place.length <= size and place.length >= frames
        items: tuple[tuple[int, int], ...] | None = ()
    else:
        items = _items(data, place, size, frames)
        complete = items is not None
    if not complete or items is None:
        raise corrupt(place.file, "is cut short: pixel data are missing", "CorruptPixelData")
    return replace(place, items=items)


def _items(data: BinaryIO, place: PixelPlace, size: int, frames: int) -> tuple[tuple[int, int], ...] | None:
    """The items of encapsulated pixel data up to their end mark; None where there is no such mark."""
    items: list[tuple[int, int]] = []
    offset, cap = place.offset, _MAX_ITEMS + _MAX_ITEMS_PER_FRAME * frames
    while offset + 8 <= size:
        data.seek(offset)
        group, element, length = struct.unpack("<HHL", data.read(8))
        tag = group << 16 | element
        # an end mark, or an item with its own length
        if tag == _SEQUENCE_END:
            return tuple(items) if len(items) > frames else None
        if tag != _ITEM or length == UNDEFINED_LENGTH:
            return None
        if len(items) == cap:
            raise over_limit(place.file, "items of pixel data", f"more than {cap}", cap)
        items.append((offset + 8, length))
        offset += 8 + length
    return None
