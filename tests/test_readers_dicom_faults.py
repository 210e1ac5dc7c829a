"""Faulty DICOM folders: every one is refused by its code, or recovered with a finding; none is silently wrong."""

import copy
import json
import os
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pydicom
import pytest
from dicom_series import SHAPE, STEP, edit, head, save, series, set_pixels
from pydicom.dataset import Dataset
from pydicom.sequence import Sequence
from pydicom.uid import JPEGLSLossless, RLELossless, generate_uid

from cranio_nb.errors import InputRefused
from cranio_nb.readers import LoadReport, read_ct

EVERY = slice(None)


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


def drop(*indices: int) -> Callable[[list[Dataset]], None]:
    def change(datasets: list[Dataset]) -> None:
        for index in sorted(indices, reverse=True):
            del datasets[index]

    return change


def chain(*edits: Callable[[list[Dataset]], None]) -> Callable[[list[Dataset]], None]:
    def change(datasets: list[Dataset]) -> None:
        for one in edits:
            one(datasets)

    return change


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


def two_blocks_of_sizes(below: int) -> Callable[[list[Dataset]], None]:
    return edit(slice(below, None), PixelSpacing=[0.45, 0.45])


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
    "one missing, no numbers": (chain(drop(11), edit(EVERY, InstanceNumber=None)), "MissingSlices"),
    "a slice without pixels": (edit(4, PixelData=None), "MissingSlices"),
    "same place, other pixels": (repeat_with_other_pixels, "AmbiguousSeries"),
    "two phases": (second_phase, "AmbiguousSeries"),
    "slice on another's place": (move(7, (0, 0, STEP)), "AmbiguousSeries"),
    "slice pushed sideways": (move(7, (4.0, 0, 0)), "BadGeometry"),
    "slice far above": (move(SHAPE[0] - 1, (0, 0, 400.0)), "MissingSlices"),
    "all at one place": (edit(EVERY, ImagePositionPatient=[0, 0, 0]), "BadGeometry"),
    "no position": (edit(EVERY, ImagePositionPatient=None), "BadGeometry"),
    "no position in one": (edit(3, ImagePositionPatient=None), "BadGeometry"),
    "no orientation": (edit(EVERY, ImageOrientationPatient=None), "BadGeometry"),
    "no orientation in one": (edit(3, ImageOrientationPatient=None), "BadGeometry"),
    "orientation of zeros": (edit(EVERY, ImageOrientationPatient=[0] * 6), "BadGeometry"),
    "orientation not orthogonal": (edit(EVERY, ImageOrientationPatient=SKEWED), "BadGeometry"),
    "orientation too long": (edit(EVERY, ImageOrientationPatient=[1.1, 0, 0, 0, 1.1, 0]), "BadGeometry"),
    "one slice flipped": (edit(9, ImageOrientationPatient=[-1, 0, 0, 0, 1, 0]), "MissingSlices"),
    "no pixel spacing": (edit(EVERY, PixelSpacing=None), "BadGeometry"),
    "no pixel spacing in one": (edit(3, PixelSpacing=None), "BadGeometry"),
    "pixel spacing zero": (edit(EVERY, PixelSpacing=[0, 0]), "BadGeometry"),
    "pixel spacing negative": (edit(EVERY, PixelSpacing=[-0.5, 0.5]), "BadGeometry"),
    "pixel spacing of one number": (edit(EVERY, PixelSpacing=[0.5]), "BadGeometry"),
    "pixel spacing in metres": (edit(EVERY, PixelSpacing=[0.0005, 0.0005]), "BadGeometry"),
    "two pixel spacings": (two_blocks_of_sizes(9), "BadGeometry"),
    "two pixel spacings, half and half": (two_blocks_of_sizes(12), "AmbiguousSeries"),
    "one slice of other spacing": (edit(9, PixelSpacing=[0.5, 0.5]), "MissingSlices"),
    "slope missing in one": (edit(6, RescaleSlope=None, RescaleIntercept=None), "InconsistentRescale"),
    "no rescale, unsigned": (as_unsigned_without_rescale, "MissingRescale"),
    "slope zero": (edit(EVERY, RescaleSlope=0), "BadRescale"),
    "slope zero in one": (edit(6, RescaleSlope=0), "BadRescale"),
    "slope negative": (edit(EVERY, RescaleSlope=-1), "BadRescale"),
    "slope huge": (edit(EVERY, RescaleSlope="1e30"), "BadRescale"),
    "intercept huge": (edit(EVERY, RescaleIntercept="1e9"), "BadRescale"),
    "intercept of one slice gone astray": (edit(6, RescaleIntercept=0), "InconsistentRescale"),
    "air at 0": (shift_hu(1000), "ImplausibleHU"),
    "air at -2000": (shift_hu(-1000), "ImplausibleHU"),
    "twice the HU": (shift_hu(0, 2), "ImplausibleHU"),
    "inverted HU": (shift_hu(0, -1), "ImplausibleHU"),
    "wrong modality": (edit(EVERY, Modality="MR", SOPClassUID="1.2.840.10008.5.1.4.1.1.4"), "WrongModality"),
    "PET": (edit(EVERY, Modality="PT", SOPClassUID="1.2.840.10008.5.1.4.1.1.128"), "WrongModality"),
    "two patients": (edit(slice(0, 12), PatientID="SECRET-2"), "MixedPatients"),
    "two frames of reference": (edit(slice(0, 12), FrameOfReferenceUID=generate_uid()), "MixedFrameOfReference"),
    "seven slices": (drop(*range(7, SHAPE[0])), "TooFewSlices"),
    "one slice": (drop(*range(1, SHAPE[0])), "BadGeometry"),
    "every other slice missing": (drop(*range(1, SHAPE[0], 2)), "MissingSlices"),
    "a lookup table": (lut, "UnsupportedPixels"),
    "float pixels": (floats, "UnsupportedPixels"),
    "rows do not fit the pixels": (edit(EVERY, Rows=SHAPE[1] // 2), "CorruptPixelData"),
    "more rows than pixels": (edit(5, Rows=SHAPE[1] + 1), "MissingSlices"),
    "sides beyond all measure": (edit(EVERY, Rows=65535, Columns=65535), "LimitExceeded"),
    "no rows": (edit(EVERY, Rows=0), "CorruptDicom"),
    "colour pictures": (edit(EVERY, SamplesPerPixel=3, PhotometricInterpretation="RGB"), "NoImages"),
    "screenshots": (edit(EVERY, SOPClassUID="1.2.840.10008.5.1.4.1.1.7"), "NoImages"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_fault_is_refused(name: str, tmp_path: Path) -> None:
    change, code = REFUSED[name]
    datasets = series(head())
    change(datasets)
    assert refusal(save(tmp_path / "scan", datasets)).code == code


def test_slices_too_far_apart_are_refused(tmp_path: Path) -> None:
    assert refusal(save(tmp_path / "scan", series(head(), step=6.0))).code == "SlicesTooFarApart"


def test_uneven_slices_too_far_apart_are_refused(tmp_path: Path) -> None:
    heights = np.cumsum([3.0] * 12 + [7.0] * 12)
    assert refusal(save(tmp_path / "scan", series(head(), heights=heights))).code == "SlicesTooFarApart"


def test_slices_too_uneven_are_refused(tmp_path: Path) -> None:
    heights = np.cumsum([0.5] * 12 + [2.5] * 12)
    assert refusal(save(tmp_path / "scan", series(head(), heights=heights))).code == "UnevenSpacing"


def test_nan_text_in_a_position_is_refused(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    patch(folder / "image0005.dcm", b"-22\\-18.5\\", b"nan\\-18.5\\")
    assert refusal(folder).code == "BadGeometry"


def patch(path: Path, old: bytes, new: bytes) -> None:
    content = path.read_bytes()
    assert content.count(old) == 1 and len(old) == len(new)
    path.write_bytes(content.replace(old, new))


@pytest.mark.parametrize("keep", [0.999, 0.9, 0.3, 0.12, 0.06, 0.04])
def test_cut_file_is_refused(keep: float, tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    victim = folder / "image0005.dcm"
    victim.write_bytes(victim.read_bytes()[: int(victim.stat().st_size * keep)])
    assert refusal(folder).code in {"CorruptPixelData", "CorruptDicom", "MissingSlices"}


@pytest.mark.parametrize("cut", range(134, 1150, 41))
def test_file_cut_anywhere_in_its_header_is_refused(cut: int, tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    victim = folder / "image0023.dcm"  # the topmost: nothing but the file itself tells that a slice is lost
    victim.write_bytes(victim.read_bytes()[:cut])
    assert refusal(folder).code in {"CorruptPixelData", "CorruptDicom", "MissingSlices"}


def test_one_byte_short_is_refused(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    victim = folder / "image0023.dcm"
    victim.write_bytes(victim.read_bytes()[:-1])
    assert refusal(folder).code == "CorruptPixelData"


def test_empty_file_is_refused(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    (folder / "image0005.dcm").write_bytes(b"")
    assert refusal(folder).code == "CorruptDicom"


@pytest.mark.parametrize("syntax", ["1.2.840.10008.1.2.4.80", "1.2.840.10008.1.2.4.90", "1.2.840.10008.1.2.5"])
def test_wrong_syntax_label_is_refused(syntax: str, tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    for path in folder.iterdir():
        content = path.read_bytes()
        old = b"UI\x14\x001.2.840.10008.1.2.1\x00"
        padded = syntax.encode() + b"\0" * (len(syntax) % 2)
        new = b"UI" + struct.pack("<H", len(padded)) + padded
        assert content.count(old) == 1
        grown = content.replace(old, new)
        at = grown.index(b"\x02\x00\x00\x00UL\x04\x00") + 8
        length = struct.unpack_from("<L", grown, at)[0] + len(new) - len(old)
        path.write_bytes(grown[:at] + struct.pack("<L", length) + grown[at + 4 :])
    assert refusal(folder).code == "CorruptPixelData"


def test_unknown_syntax_is_refused(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    for path in folder.iterdir():
        patch(path, b"UI\x14\x001.2.840.10008.1.2.1\x00", b"UI\x14\x001.2.840.10008.1.9.1\x00")
    assert refusal(folder).code == "UnsupportedTransferSyntax"


def test_compressed_stream_of_other_size_is_refused(tmp_path: Path) -> None:
    small, large = series(head()), series(head((24, 84, 96)))
    for ds, other in zip(small, large, strict=True):
        other.compress(JPEGLSLossless, encoding_plugin="pyjpegls")
        ds.PixelData = other.PixelData
        ds["PixelData"].is_undefined_length = True
    assert refusal(save(tmp_path / "scan", small, syntax=JPEGLSLossless)).code == "CorruptPixelData"


@pytest.mark.parametrize("syntax", [JPEGLSLossless, RLELossless])
def test_cut_compressed_stream_is_refused(syntax: str, tmp_path: Path) -> None:
    datasets = series(head())
    for ds in datasets:
        ds.compress(syntax, encoding_plugin="pyjpegls" if syntax == JPEGLSLossless else "pydicom")
    folder = save(tmp_path / "scan", datasets)
    victim = folder / "image0005.dcm"
    victim.write_bytes(victim.read_bytes()[:-60])
    assert refusal(folder).code == "CorruptPixelData"


def test_element_of_four_gigabytes_is_refused(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    for path in folder.iterdir():
        content = path.read_bytes()
        at = content.index(b"\xe0\x7f\x10\x00OW")
        path.write_bytes(content[: at + 8] + struct.pack("<L", 0xFFFFFFF0) + content[at + 12 :])
    assert refusal(folder).code == "CorruptPixelData"


def test_deflate_bomb_is_refused(tmp_path: Path) -> None:
    bomb = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
    zeros = bytes(2**24)
    packed = b"".join(bomb.compress(zeros) for _ in range(20)) + bomb.flush()
    folder = save(tmp_path / "scan", series(head())[:1], syntax="1.2.840.10008.1.2.1.99")
    path = folder / "image0000.dcm"
    with open(path, "rb") as stream:
        meta = pydicom.filereader.read_file_meta_info(path)
        size = 144 + meta.FileMetaInformationGroupLength
        start = stream.read(size)
    path.write_bytes(start + packed)
    assert refusal(folder).code == "LimitExceeded"


@pytest.mark.parametrize("depth", [200, 2000, 20_000])
def test_deep_nesting_never_crashes(depth: int, tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    path = folder / "image0005.dcm"
    content = path.read_bytes()
    nested = b"\x08\x00\x40\x11SQ\0\0\xff\xff\xff\xff" + b"\xfe\xff\x00\xe0\xff\xff\xff\xff"
    at = content.index(b"\x08\x00\x60\x00CS")
    path.write_bytes(content[:at] + nested * depth + content[at:])
    assert refusal(folder).code == "CorruptDicom"


def test_lower_limits(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    assert refusal(tmp_path / "empty").code == "NoImages"
    assert refusal(tmp_path / "nowhere").code == "NotFound"
    folder = save(tmp_path / "scan", series(head()))
    error = refusal(folder / "image0003.dcm")
    assert error.code == "TooFewSlices" and "folder" in error.remedy
    (tmp_path / "note.txt").write_text("no scan at all")
    assert refusal(tmp_path / "note.txt").code == "UnsupportedFile"
    assert refusal(folder, allow=("everything",)).code == "UnknownAllowance"


def test_folder_without_permission_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def closed(path: object) -> None:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr("cranio_nb.readers.dicom_files.os.scandir", closed)
    assert refusal(save(tmp_path / "scan", series(head()))).code == "PermissionDenied"


def test_too_many_files_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cranio_nb.readers.dicom_files.MAX_FILES", 20)
    assert refusal(save(tmp_path / "scan", series(head()))).code == "LimitExceeded"


def test_missing_decoder_names_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    datasets = series(head())
    for ds in datasets:
        ds.compress(JPEGLSLossless, encoding_plugin="pyjpegls")
    folder = save(tmp_path / "scan", datasets)
    monkeypatch.setattr("cranio_nb.readers.dicom_codecs.find_spec", lambda name: None)
    error = refusal(folder)
    assert error.code == "UnsupportedTransferSyntax" and "pyjpegls" in error.remedy


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
    "inverted display": (edit(EVERY, PhotometricInterpretation="MONOCHROME1"), "Monochrome1"),
    "slices numbered from 5": (edit(0, InstanceNumber=40), "SliceNumbers"),
    "thin slices": (edit(EVERY, SliceThickness=0.5), "ThinSlices"),
    "thick slices": (edit(EVERY, SliceThickness=10), "SmallSteps"),
    "another unit": (edit(EVERY, RescaleType="US"), "RescaleType"),
}


@pytest.mark.parametrize("name", UNCHANGED)
def test_odd_series_is_read_exactly_and_reported(name: str, tmp_path: Path) -> None:
    change, code = UNCHANGED[name]
    datasets = series(head())
    change(datasets)
    volume, report = read_ct(save(tmp_path / "scan", datasets))
    assert code in codes(report)
    np.testing.assert_array_equal(volume.voxels, head())


def test_things_that_are_no_images_are_skipped_and_counted(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    (folder / ".DS_Store").write_bytes(b"\0\0\0\1Bud1" + bytes(200))
    (folder / "notes.txt").write_text("nothing")
    (folder / "LOCK").write_bytes(b"")
    (folder / "fake").write_bytes(bytes(128) + b"DICM" + b"rubbish" * 40)
    (folder / "DICOMDIR").write_bytes(b"../../../etc/passwd")
    (folder / "loop").symlink_to(folder)
    (folder / "copy.dcm").symlink_to(folder / "image0000.dcm")
    os.mkfifo(folder / "pipe")
    volume, report = read_ct(folder)
    np.testing.assert_array_equal(volume.voxels, head())
    skipped = {k: v for f in report.findings for k, v in f.values.items()}
    assert (skipped["not_dicom"], skipped["link"], skipped["special file"], skipped["empty file"]) == (3, 2, 1, 1)


def test_padding_becomes_air_with_its_tag_and_without(tmp_path: Path) -> None:
    hu = head()
    hu[:, :6, :6] = -2000
    named = series(hu, intercept=0, signed=True)
    edit(EVERY, PixelPaddingValue=-2000)(named)
    for folder, datasets, code in (("a", named, "Padding"), ("b", series(hu, intercept=-3000), "PaddingWithoutTag")):
        volume, report = read_ct(save(tmp_path / folder, datasets))
        assert code in codes(report)
        np.testing.assert_array_equal(volume.voxels, np.where(hu == -2000, -1024, hu))


def test_padding_value_within_the_head_is_ignored(tmp_path: Path) -> None:
    datasets = series(head())
    edit(EVERY, PixelPaddingValue=1024 + 900)(datasets)
    volume, _ = read_ct(save(tmp_path / "scan", datasets))
    np.testing.assert_array_equal(volume.voxels, head())


def test_missing_slice_is_interpolated_when_allowed(tmp_path: Path) -> None:
    hu = head()
    hu[...] = hu[12]  # the same in every plane, so that interpolation must be exact
    datasets = series(hu)
    drop(11)(datasets)
    volume, report = read_ct(save(tmp_path / "scan", datasets), allow=("gap_fill",))
    np.testing.assert_array_equal(volume.voxels, hu)
    filled = next(f for f in report.findings if f.code == "GapsFilled")
    assert filled.severity == "warning" and filled.values["planes_from_below"] == [11]


def test_allowances_turn_refusals_into_warnings(tmp_path: Path) -> None:
    for name, change, allow, code in (
        ("a", shift_hu(1000), "implausible_hu", "ImplausibleHU"),
        ("b", edit(EVERY, Modality="OT"), "wrong_modality", "WrongModality"),
    ):
        datasets = series(head())
        change(datasets)
        _, report = read_ct(save(tmp_path / name, datasets), allow=(allow,))
        assert next(f for f in report.findings if f.code == code).severity == "warning"
    datasets = series(head())
    as_unsigned_without_rescale(datasets)
    volume, report = read_ct(save(tmp_path / "c", datasets), allow=("no_rescale", "implausible_hu"))
    np.testing.assert_array_equal(volume.voxels, head() + 1024)
    assert "MissingRescale" in codes(report)


def test_report_holds_no_patient_text(tmp_path: Path) -> None:
    _, report = read_ct(save(tmp_path / "Nobody", series(head())))
    for secret in ("SECRET", "Nobody", "script", "touch", "1900", str(tmp_path)):
        assert secret not in repr(report)


def test_damaged_headers_are_refused_reported_or_harmless(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head((10, 16, 18))))
    whole, _ = read_ct(folder)
    victim = folder / "image0004.dcm"
    good = victim.read_bytes()
    pixels = good.index(b"\xe0\x7f\x10\x00OW")
    rng = np.random.default_rng(11)
    for _ in range(250):
        bad = bytearray(good)
        for at in rng.integers(128, pixels, rng.integers(1, 4)):
            bad[at] = rng.integers(256)
        victim.write_bytes(bad)
        try:
            volume, report = read_ct(folder)
        except InputRefused as error:
            assert error.code not in {"CorruptFile", "UnsupportedFile"}
            continue
        same = np.array_equal(volume.voxels, whole.voxels) and np.allclose(volume.affine, whole.affine)
        assert same or {f.severity for f in report.findings} - {"info"}


def test_positions_in_centimetres_are_remarked_upon(tmp_path: Path) -> None:
    _, report = read_ct(save(tmp_path / "scan", series(head(), step=STEP / 10)))
    assert next(f for f in report.findings if f.code == "SmallSteps").severity == "warning"
