"""Faulty DICOM folders: every one is refused by its code, or recovered with a finding; none is silently wrong."""

import copy
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from dicom_series import (
    SHAPE,
    STEP,
    as_unsigned_without_rescale,
    codes,
    head,
    refusal,
    save_changed,
    set_pixels,
    shift_hu,
)
from pydicom.dataset import Dataset
from pydicom.sequence import Sequence
from pydicom.uid import generate_uid

from cranio_nb.readers import read_ct
from data_synth.fault_edits import chain, drop, set_elements

EVERY = slice(None)


def move(index: int, by: tuple[float, float, float]) -> Callable[[list[Dataset]], None]:
    def change(datasets: list[Dataset]) -> None:
        old = datasets[index].ImagePositionPatient
        datasets[index].ImagePositionPatient = [float(a) + b for a, b in zip(old, by, strict=True)]

    return change


def repeat_with_other_pixels(datasets: list[Dataset]) -> None:
    twin = copy.deepcopy(datasets[5])
    twin.SOPInstanceUID, twin.PixelData = generate_uid(), datasets[6].PixelData
    datasets.append(twin)


def second_phase(datasets: list[Dataset]) -> None:
    for ds in list(datasets):
        twin = copy.deepcopy(ds)
        twin.SOPInstanceUID, twin.AcquisitionNumber = generate_uid(), 2
        twin.PixelData = bytes(len(ds.PixelData) - 2) + b"\1\0"
        datasets.append(twin)


def two_blocks_of_sizes(below: int) -> Callable[[list[Dataset]], None]:
    return set_elements(slice(below, None), PixelSpacing=[0.45, 0.45])


def lut(datasets: list[Dataset]) -> None:
    for ds in datasets:
        item = Dataset()
        item.LUTDescriptor, item.LUTData, item.ModalityLUTType = [2, 0, 16], b"\0\0\1\0", "HU"
        ds.ModalityLUTSequence = Sequence([item])


def floats(datasets: list[Dataset]) -> None:
    for ds in datasets:
        ds.FloatPixelData = np.zeros(ds.Rows * ds.Columns, "<f4").tobytes()
        ds.BitsAllocated = 32
        del ds.PixelData


SKEWED = [1.0, 0.0, 0.0, 0.1, 1.0, 0.0]


REFUSED = {
    "one slice missing": (drop(11), "MissingSlices"),
    "two neighbours missing": (drop(11, 12), "MissingSlices"),
    "second slice missing": (drop(1), "MissingSlices"),
    "last but one missing": (drop(SHAPE[0] - 2), "MissingSlices"),
    "two apart missing": (drop(5, 7), "MissingSlices"),
    "eight in a row missing": (drop(*range(8, 16)), "MissingSlices"),
    "every other of the top half missing": (drop(*range(13, 23, 2)), "MissingSlices"),
    "one missing, no numbers": (chain(drop(11), set_elements(EVERY, InstanceNumber=None)), "MissingSlices"),
    "a slice without pixels": (set_elements(4, PixelData=None), "MissingSlices"),
    "same place, other pixels": (repeat_with_other_pixels, "AmbiguousSeries"),
    "two phases": (second_phase, "AmbiguousSeries"),
    "slice on another's place": (move(7, (0, 0, STEP)), "AmbiguousSeries"),
    "slice pushed sideways": (move(7, (4.0, 0, 0)), "BadGeometry"),
    "slice far above": (move(SHAPE[0] - 1, (0, 0, 400.0)), "MissingSlices"),
    "all at one place": (set_elements(EVERY, ImagePositionPatient=[0, 0, 0]), "BadGeometry"),
    "no position": (set_elements(EVERY, ImagePositionPatient=None), "BadGeometry"),
    "no position in one": (set_elements(3, ImagePositionPatient=None), "BadGeometry"),
    "no orientation": (set_elements(EVERY, ImageOrientationPatient=None), "BadGeometry"),
    "no orientation in one": (set_elements(3, ImageOrientationPatient=None), "BadGeometry"),
    "orientation of zeros": (set_elements(EVERY, ImageOrientationPatient=[0] * 6), "BadGeometry"),
    "orientation not orthogonal": (set_elements(EVERY, ImageOrientationPatient=SKEWED), "BadGeometry"),
    "orientation too long": (set_elements(EVERY, ImageOrientationPatient=[1.1, 0, 0, 0, 1.1, 0]), "BadGeometry"),
    "one slice flipped": (set_elements(9, ImageOrientationPatient=[-1, 0, 0, 0, 1, 0]), "MissingSlices"),
    "no pixel spacing": (set_elements(EVERY, PixelSpacing=None), "BadGeometry"),
    "no pixel spacing in one": (set_elements(3, PixelSpacing=None), "BadGeometry"),
    "pixel spacing zero": (set_elements(EVERY, PixelSpacing=[0, 0]), "BadGeometry"),
    "pixel spacing negative": (set_elements(EVERY, PixelSpacing=[-0.5, 0.5]), "BadGeometry"),
    "pixel spacing of one number": (set_elements(EVERY, PixelSpacing=[0.5]), "BadGeometry"),
    "pixel spacing in metres": (set_elements(EVERY, PixelSpacing=[0.0005, 0.0005]), "BadGeometry"),
    "two pixel spacings": (two_blocks_of_sizes(9), "BadGeometry"),
    "two pixel spacings, half and half": (two_blocks_of_sizes(12), "AmbiguousSeries"),
    "one slice of other spacing": (set_elements(9, PixelSpacing=[0.5, 0.5]), "MissingSlices"),
    "slope missing in one": (set_elements(6, RescaleSlope=None, RescaleIntercept=None), "InconsistentRescale"),
    "no rescale, unsigned": (as_unsigned_without_rescale, "MissingRescale"),
    "slope zero": (set_elements(EVERY, RescaleSlope=0), "BadRescale"),
    "slope zero in one": (set_elements(6, RescaleSlope=0), "BadRescale"),
    "slope negative": (set_elements(EVERY, RescaleSlope=-1), "BadRescale"),
    "slope huge": (set_elements(EVERY, RescaleSlope="1e30"), "BadRescale"),
    "intercept huge": (set_elements(EVERY, RescaleIntercept="1e9"), "BadRescale"),
    "intercept of one slice gone astray": (set_elements(6, RescaleIntercept=0), "InconsistentRescale"),
    "air at 0": (shift_hu(1000), "ImplausibleHU"),
    "air at -2000": (shift_hu(-1000), "ImplausibleHU"),
    "twice the HU": (shift_hu(0, 2), "ImplausibleHU"),
    "inverted HU": (shift_hu(0, -1), "ImplausibleHU"),
    "wrong modality": (set_elements(EVERY, Modality="MR", SOPClassUID="1.2.840.10008.5.1.4.1.1.4"), "WrongModality"),
    "PET": (set_elements(EVERY, Modality="PT", SOPClassUID="1.2.840.10008.5.1.4.1.1.128"), "WrongModality"),
    "two patients": (set_elements(slice(0, 12), PatientID="SECRET-2"), "MixedPatients"),
    "two frames of reference": (
        set_elements(slice(0, 12), FrameOfReferenceUID=generate_uid()),
        "MixedFrameOfReference",
    ),
    "seven slices": (drop(*range(7, SHAPE[0])), "TooFewSlices"),
    "one slice": (drop(*range(1, SHAPE[0])), "BadGeometry"),
    "every other slice missing": (drop(*range(1, SHAPE[0], 2)), "MissingSlices"),
    "a lookup table": (lut, "UnsupportedPixels"),
    "float pixels": (floats, "UnsupportedPixels"),
    "rows do not fit the pixels": (set_elements(EVERY, Rows=SHAPE[1] // 2), "CorruptPixelData"),
    "more rows than pixels": (set_elements(5, Rows=SHAPE[1] + 1), "MissingSlices"),
    "sides beyond all measure": (set_elements(EVERY, Rows=65535, Columns=65535), "LimitExceeded"),
    "no rows": (set_elements(EVERY, Rows=0), "CorruptDicom"),
    "colour pictures": (set_elements(EVERY, SamplesPerPixel=3, PhotometricInterpretation="RGB"), "NoImages"),
    "screenshots": (set_elements(EVERY, SOPClassUID="1.2.840.10008.5.1.4.1.1.7"), "NoImages"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_fault_is_refused(name: str, tmp_path: Path) -> None:
    change, code = REFUSED[name]
    assert refusal(save_changed(tmp_path, change)).code == code


def duplicate(datasets: list[Dataset]) -> None:
    datasets += [copy.deepcopy(ds) for ds in datasets[3:7]]


def scout_and_screenshot(datasets: list[Dataset]) -> None:
    scout = copy.deepcopy(datasets[0])
    scout.ImageType, scout.ImageOrientationPatient = ["ORIGINAL", "PRIMARY", "LOCALIZER"], [0, 1, 0, 0, 0, -1]
    picture = copy.deepcopy(datasets[0])
    picture.SOPClassUID = "1.2.840.10008.5.1.4.1.1.7"
    for name in ("ImagePositionPatient", "ImageOrientationPatient", "PixelSpacing"):
        del picture[name]
    unnamed = copy.deepcopy(scout)
    unnamed.ImageType = ["ORIGINAL", "PRIMARY", "AXIAL"]
    datasets += [scout, picture, unnamed]


def signed_air_without_rescale(datasets: list[Dataset]) -> None:
    for ds in datasets:
        stored = np.frombuffer(ds.PixelData, "<u2").reshape(ds.Rows, ds.Columns).astype(int)
        set_pixels(ds, stored - 1024, signed=True)
        del ds.RescaleSlope, ds.RescaleIntercept


UNCHANGED = {
    "copies of slices": (duplicate, "DuplicatesDropped"),
    "scout and screenshot": (scout_and_screenshot, "ImagesSkipped"),
    "signed HU without rescale": (signed_air_without_rescale, "MissingRescale"),
    "inverted display": (set_elements(EVERY, PhotometricInterpretation="MONOCHROME1"), "Monochrome1"),
    "slices numbered from 5": (set_elements(0, InstanceNumber=40), "SliceNumbers"),
    "thin slices": (set_elements(EVERY, SliceThickness=0.5), "ThinSlices"),
    "thick slices": (set_elements(EVERY, SliceThickness=10), "SmallSteps"),
    "another unit": (set_elements(EVERY, RescaleType="US"), "RescaleType"),
}


@pytest.mark.parametrize("name", UNCHANGED)
def test_odd_series_is_read_exactly_and_reported(name: str, tmp_path: Path) -> None:
    change, code = UNCHANGED[name]
    volume, report = read_ct(save_changed(tmp_path, change))
    assert code in codes(report)
    np.testing.assert_array_equal(volume.voxels, head())
