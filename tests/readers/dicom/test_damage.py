"""Damaged or hostile DICOM files: cut, mislabelled, inflated, nested or altered; refused, and never misread."""

import struct
import zlib
from pathlib import Path

import numpy as np
import pydicom
import pytest
from dicom_series import head, refusal, save, series
from pydicom.uid import JPEGLSLossless, RLELossless

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct


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

    monkeypatch.setattr("cranio_nb.readers.dicom.file_list.os.scandir", closed)
    assert refusal(save(tmp_path / "scan", series(head()))).code == "PermissionDenied"


def test_too_many_files_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cranio_nb.readers.dicom.file_list.MAX_FILES", 20)
    assert refusal(save(tmp_path / "scan", series(head()))).code == "LimitExceeded"


def test_missing_decoder_names_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    datasets = series(head())
    for ds in datasets:
        ds.compress(JPEGLSLossless, encoding_plugin="pyjpegls")
    folder = save(tmp_path / "scan", datasets)
    monkeypatch.setattr("cranio_nb.readers.dicom.codecs.find_spec", lambda name: None)
    error = refusal(folder)
    assert error.code == "UnsupportedTransferSyntax" and "pyjpegls" in error.remedy


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
