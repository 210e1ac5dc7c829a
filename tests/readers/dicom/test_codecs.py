"""Encodings that give the same numbers, and compressed streams that are refused."""

from pathlib import Path

import numpy as np
import pytest
from dicom_series import head, refusal, save, series
from pydicom.dataset import Dataset
from pydicom.encaps import encapsulate
from pydicom.uid import (
    DeflatedExplicitVRLittleEndian,
    ExplicitVRBigEndian,
    ImplicitVRLittleEndian,
    JPEG2000Lossless,
    JPEGLSLossless,
    RLELossless,
)

from cranio_nb.readers import read_ct
from cranio_nb.readers.dicom.codecs import COMPRESSED, find_missing_decoder, read_frame_size


def big_endian(ds: Dataset) -> None:
    ds.PixelData = np.frombuffer(ds.PixelData, "<u2").astype(">u2").tobytes()


def jpeg2000(ds: Dataset) -> None:
    import openjpeg

    stored = np.frombuffer(ds.PixelData, "<u2").reshape(ds.Rows, ds.Columns)
    ds.PixelData = encapsulate([bytes(openjpeg.encode(stored, bits_stored=16))])
    ds["PixelData"].is_undefined_length = True


ENCODINGS = {
    "implicit": (ImplicitVRLittleEndian, lambda ds: None),
    "big endian": (ExplicitVRBigEndian, big_endian),
    "deflated": (DeflatedExplicitVRLittleEndian, lambda ds: None),
    "run length": (
        RLELossless,
        lambda ds: ds.compress(RLELossless, encoding_plugin="pydicom", generate_instance_uid=False),
    ),
    "JPEG-LS": (JPEGLSLossless, lambda ds: ds.compress(JPEGLSLossless, encoding_plugin="pyjpegls")),
    "JPEG 2000": (JPEG2000Lossless, jpeg2000),
}


@pytest.mark.parametrize("name", ENCODINGS)
def test_encoding_does_not_matter(name: str, tmp_path: Path) -> None:
    syntax, encode = ENCODINGS[name]
    hu = head((9, 42, 48))
    datasets = series(hu)
    for ds in datasets:
        encode(ds)
    volume, report = read_ct(save(tmp_path / "scan", datasets, syntax=syntax))
    np.testing.assert_array_equal(volume.voxels, hu)
    assert [f.severity for f in report.findings] == ["info"]


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


def test_missing_decoder_names_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    datasets = series(head())
    for ds in datasets:
        ds.compress(JPEGLSLossless, encoding_plugin="pyjpegls")
    folder = save(tmp_path / "scan", datasets)
    monkeypatch.setattr("cranio_nb.readers.dicom.codecs.find_spec", lambda name: None)
    error = refusal(folder)
    assert error.code == "UnsupportedTransferSyntax" and "pyjpegls" in error.remedy


@pytest.mark.parametrize("size", [(42, 48), (300, 7), (1, 65535)])
@pytest.mark.parametrize("marker", [0xC0, 0xC3, 0xF7])
def test_the_size_in_a_stream_is_read_past_other_segments(marker: int, size: tuple[int, int]) -> None:
    comment = b"\xff\xfe\x00\x06text" + b"\xff"  # a comment, then a byte of filling
    frame = bytes([0xFF, marker, 0, 11, 12]) + size[0].to_bytes(2, "big") + size[1].to_bytes(2, "big")
    assert read_frame_size(b"\xff\xd8" + comment + frame + bytes(30)) == size


def test_a_stream_without_a_size_has_none() -> None:
    assert read_frame_size(b"") is None
    assert read_frame_size(b"\xff\xd8" + bytes(100)) is None


def test_only_compressed_syntaxes_need_a_decoder() -> None:
    assert find_missing_decoder("1.2.840.10008.1.2.1") == ""
    assert RLELossless in COMPRESSED and find_missing_decoder(RLELossless) == ""
