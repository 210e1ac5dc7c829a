"""Edits of a series, of which valid and faulty folders are made; each takes the list of its data sets."""

from __future__ import annotations

import copy
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from pydicom import uid
from pydicom.dataset import Dataset
from pydicom.encaps import encapsulate
from pydicom.sequence import Sequence

from .fault_series import ENHANCED, EVERY, SCREENSHOT, Edit, Slices, store_hu


def set_elements(at: int | slice, **values: object) -> Edit:
    """Set elements of one or more slices; None deletes."""

    def change(slices: Slices) -> None:
        for ds in [slices[at]] if isinstance(at, int) else slices[at]:
            for name, value in values.items():
                if value is None:
                    del ds[name]
                else:
                    setattr(ds, name, value)

    return change


def chain(*edits: Edit) -> Edit:
    """Several edits, one after the other."""

    def change(slices: Slices) -> None:
        for one in edits:
            one(slices)

    return change


def drop(*indices: int) -> Edit:
    """Slices left out."""

    def change(slices: Slices) -> None:
        for index in sorted(indices, reverse=True):
            del slices[index]

    return change


def move(index: int, by: tuple[float, float, float]) -> Edit:
    """One slice moved by so many mm."""

    def change(slices: Slices) -> None:
        old = [float(v) for v in slices[index].ImagePositionPatient]
        slices[index].ImagePositionPatient = [a + b for a, b in zip(old, by, strict=True)]

    return change


def stored_pixels(ds: Dataset) -> NDArray:
    """The stored numbers of a slice."""
    kind = f"<{'i' if ds.PixelRepresentation else 'u'}{ds.BitsAllocated // 8}"
    return np.frombuffer(ds.PixelData, kind).reshape(ds.Rows, ds.Columns)


def edit_pixels(change_pixels: Callable[[NDArray, int], NDArray], at: slice = EVERY) -> Edit:
    """Edit the stored numbers of slices."""

    def change(slices: Slices) -> None:
        for k, ds in list(enumerate(slices))[at]:
            pixels = stored_pixels(ds)
            ds.PixelData = change_pixels(pixels.copy(), k).astype(pixels.dtype).tobytes()

    return change


def number_slices(numbers: Callable[[int], int]) -> Edit:
    """Slice numbers by a rule of their place."""

    def change(slices: Slices) -> None:
        for k, ds in enumerate(slices):
            ds.InstanceNumber = numbers(k)

    return change


def repeat_slices(indices: range, **values: object) -> Edit:
    """Add copies of slices, with other elements."""

    def change(slices: Slices) -> None:
        for index in indices:
            twin = copy.deepcopy(slices[index])
            for name, value in values.items():
                setattr(twin, name, value)
            if values:
                twin.SOPInstanceUID = uid.generate_uid()
            slices.append(twin)

    return change


def add_phase(slices: Slices) -> None:
    """A second scan at the same places, in the same series."""
    for ds in list(slices):
        twin = copy.deepcopy(ds)
        twin.SOPInstanceUID, twin.AcquisitionNumber = uid.generate_uid(), 2
        twin.PixelData = (stored_pixels(ds) + 40).astype("<u2").tobytes()
        slices.append(twin)


def add_scout(slices: Slices) -> None:
    """A scout view beside the slices, of their size."""
    scout = copy.deepcopy(slices[0])
    scout.ImageType, scout.ImageOrientationPatient = ["ORIGINAL", "PRIMARY", "LOCALIZER"], [0, 1, 0, 0, 0, -1]
    scout.SOPInstanceUID = uid.generate_uid()
    slices.append(scout)


def add_large_scout(slices: Slices) -> None:
    """A scout view of another size."""
    add_scout(slices)
    store_hu(slices[-1], np.zeros((60, 50)))


def add_screenshot(slices: Slices) -> None:
    """A colour picture without geometry."""
    picture = copy.deepcopy(slices[0])
    picture.SOPClassUID, picture.SOPInstanceUID = SCREENSHOT, uid.generate_uid()
    picture.SamplesPerPixel, picture.PhotometricInterpretation, picture.PlanarConfiguration = 3, "RGB", 0
    picture.BitsAllocated, picture.BitsStored, picture.HighBit = 8, 8, 7
    picture.PixelData = bytes(picture.Rows * picture.Columns * 3)
    for name in ("ImagePositionPatient", "ImageOrientationPatient", "PixelSpacing"):
        del picture[name]
    slices.append(picture)


def add_second_series(**values: object) -> Edit:
    """A second reconstruction in steps twice as wide."""

    def change(slices: Slices) -> None:
        series = uid.generate_uid()
        for ds in slices[::2]:
            twin = copy.deepcopy(ds)
            twin.SeriesInstanceUID, twin.SOPInstanceUID, twin.SeriesNumber = series, uid.generate_uid(), 9
            for name, value in values.items():
                setattr(twin, name, value)
            slices.append(twin)

    return change


def give_own_series(slices: Slices) -> None:
    """Every slice says that it is a series of its own."""
    for ds in slices:
        ds.SeriesInstanceUID = uid.generate_uid()


def give_table(slices: Slices) -> None:
    """HU by a table instead of slope and intercept."""
    for ds in slices:
        item = Dataset()
        item.LUTDescriptor, item.LUTData, item.ModalityLUTType = [2, 0, 16], b"\0\0\1\0", "HU"
        ds.ModalityLUTSequence = Sequence([item])


def make_floats(slices: Slices) -> None:
    """Pixels as floating-point numbers."""
    for ds in slices:
        ds.FloatPixelData = np.zeros(ds.Rows * ds.Columns, "<f4").tobytes()
        ds.BitsAllocated = 32
        del ds.PixelData


def make_big_endian(slices: Slices) -> None:
    """Pixels in big-endian order; the syntax is the recipe's."""
    for ds in slices:
        ds.PixelData = stored_pixels(ds).astype(">u2").tobytes()


def shift_hu(by: float, factor: float = 1) -> Edit:
    """Another scale than HU, with a header that says HU."""

    def change(slices: Slices) -> None:
        for ds in slices:
            hu = (stored_pixels(ds).astype(float) + float(ds.RescaleIntercept)) * factor + by
            store_hu(ds, hu, intercept=-8192)

    return change


def rescale_each(slices: Slices) -> None:
    """Every slice has a slope and an intercept of its own, and the same HU."""
    for k, ds in enumerate(slices):
        hu = stored_pixels(ds).astype(float) - 1024
        store_hu(ds, hu, intercept=-1024 - k)


def compress(encode: Callable[[Dataset], bytes], pieces: int = 1) -> Edit:
    """Encode every slice; the syntax is the recipe's."""

    def change(slices: Slices) -> None:
        for ds in slices:
            ds.PixelData = encapsulate([encode(ds)], fragments_per_frame=pieces)
            ds["PixelData"].is_undefined_length = True
            ds["PixelData"].VR = "OB"

    return change


def encode_rle(ds: Dataset) -> bytes:
    """The run-length stream of a slice."""
    from pydicom.encaps import get_frame

    twin = copy.deepcopy(ds)
    twin.file_meta.TransferSyntaxUID = uid.ExplicitVRLittleEndian
    twin.compress(uid.RLELossless, encoding_plugin="pydicom", generate_instance_uid=False)
    return get_frame(twin.PixelData, 0, number_of_frames=1)


def encode_jpeg_ls(ds: Dataset) -> bytes:
    """The JPEG-LS stream of a slice."""
    import jpeg_ls

    return bytes(jpeg_ls.encode_buffer(ds.PixelData, ds.Rows, ds.Columns, 1, 16))


def encode_jpeg2000(ds: Dataset) -> bytes:
    """The JPEG 2000 stream of a slice."""
    import openjpeg

    return bytes(openjpeg.encode(stored_pixels(ds), bits_stored=16))


def encode_jpeg(ds: Dataset) -> bytes:
    """The lossless JPEG stream of a slice."""
    import imagecodecs

    return bytes(imagecodecs.jpeg8_encode(stored_pixels(ds), lossless=True, bitspersample=16))


def make_enhanced(
    order: Callable[[int], list[int]] = lambda n: list(range(n)), *, shared_rescale: bool = True, lose: str = ""
) -> Edit:
    """All slices as the frames of one file."""

    def change(slices: Slices) -> None:
        whole, frames = copy.deepcopy(slices[0]), [slices[i] for i in order(len(slices))]
        whole.SOPClassUID, whole.NumberOfFrames = ENHANCED, len(frames)
        whole.PixelData = b"".join(ds.PixelData for ds in frames)
        names = ("ImagePositionPatient", "ImageOrientationPatient", "PixelSpacing", "SliceThickness")
        for name in (*names, "RescaleSlope", "RescaleIntercept"):
            del whole[name]
        shared = Dataset()
        _group(shared, "PlaneOrientationSequence", frames[0], "ImageOrientationPatient")
        _group(shared, "PixelMeasuresSequence", frames[0], "PixelSpacing", "SliceThickness")
        if shared_rescale:
            _group(shared, "PixelValueTransformationSequence", frames[0], "RescaleSlope", "RescaleIntercept")
        whole.SharedFunctionalGroupsSequence = Sequence([shared])
        items = []
        for ds in frames:
            item = Dataset()
            if lose != "position":
                _group(item, "PlanePositionSequence", ds, "ImagePositionPatient")
            if not shared_rescale and lose != "rescale":
                _group(item, "PixelValueTransformationSequence", ds, "RescaleSlope", "RescaleIntercept")
            items.append(item)
        whole.PerFrameFunctionalGroupsSequence = Sequence(items)
        slices[:] = [whole]

    return change


def _group(into: Dataset, sequence: str, source: Dataset, *names: str) -> None:
    item = Dataset()
    for name in names:
        setattr(item, name, source[name].value)
    setattr(into, sequence, Sequence([item]))


def move_far_away(slices: Slices) -> None:
    """Positions farther away than any scanner is large."""
    for ds in slices:
        ds.ImagePositionPatient = [1e6, 0, float(ds.ImagePositionPatient[2])]
