"""Encodings that give the same numbers, and compressed streams that are refused."""

from pathlib import Path

import jpeg_ls
import numpy as np
import pytest
from dicom_series import head, refusal, save, series
from pydicom.dataset import Dataset
from pydicom.encaps import encapsulate, get_frame
from pydicom.uid import (
    DeflatedExplicitVRLittleEndian,
    ExplicitVRBigEndian,
    ImplicitVRLittleEndian,
    JPEG2000Lossless,
    JPEGBaseline8Bit,
    JPEGExtended12Bit,
    JPEGLossless,
    JPEGLosslessSV1,
    JPEGLSLossless,
    RLELossless,
)

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from cranio_nb.readers.dicom.codecs import COMPRESSED, find_missing_decoder
from cranio_nb.readers.dicom.parse import parse_file
from cranio_nb.readers.dicom.pixel_data import read_stack
from cranio_nb.readers.dicom.slice_header import read_headers


def big_endian(ds: Dataset) -> None:
    ds.PixelData = np.frombuffer(ds.PixelData, "<u2").astype(">u2").tobytes()


def jpeg2000(ds: Dataset) -> None:
    import openjpeg

    stored = np.frombuffer(ds.PixelData, "<u2").reshape(ds.Rows, ds.Columns)
    ds.PixelData = encapsulate([bytes(openjpeg.encode(stored, bits_stored=16))])
    ds["PixelData"].is_undefined_length = True


def lossless_jpeg(ds: Dataset) -> None:
    import imagecodecs

    stored = np.frombuffer(ds.PixelData, "<u2").reshape(ds.Rows, ds.Columns)
    ds.PixelData = encapsulate([imagecodecs.jpeg8_encode(stored, lossless=True, bitspersample=16)])
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
    "JPEG": (JPEGLosslessSV1, lossless_jpeg),
    "JPEG, any predictor": (JPEGLossless, lossless_jpeg),
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


@pytest.mark.parametrize("signed", [False, True])
def test_a_stream_of_few_bits_fills_the_whole_number(signed: bool, tmp_path: Path) -> None:
    # a slice of air needs six bits, and its stream may then hold single bytes
    hu = head((9, 42, 48))
    datasets = series(hu, signed=signed, intercept=-1024)
    for ds in datasets:
        stored = np.frombuffer(ds.PixelData, "<u2").reshape(ds.Rows, ds.Columns)
        stored = stored.astype("u1") if stored.max() < 256 else stored
        ds.PixelData = encapsulate([bytes(jpeg_ls.encode_array(stored))])
        ds["PixelData"].is_undefined_length = True
    volume, _ = read_ct(save(tmp_path / "scan", datasets, syntax=JPEGLSLossless))
    np.testing.assert_array_equal(volume.voxels, hu)


def jpeg_series(bits: int, lossless: bool) -> list[Dataset]:
    """A head in 8 or 12 bits, as JPEG streams of one fragment."""
    import imagecodecs

    datasets = series(head() // (16 if bits == 8 else 1), bits=bits, intercept=-64 if bits == 8 else -1024)
    for ds in datasets:
        stored = np.frombuffer(ds.PixelData, "u1" if bits == 8 else "<u2").reshape(ds.Rows, ds.Columns)
        stream = imagecodecs.jpeg8_encode(stored, level=100, bitspersample=bits, lossless=lossless)
        ds.RescaleIntercept, ds.RescaleSlope = -1024, 16 if bits == 8 else 1
        ds.PixelData = encapsulate([stream])
        ds["PixelData"].is_undefined_length = True
    return datasets


@pytest.mark.parametrize(("syntax", "bits"), [(JPEGBaseline8Bit, 8), (JPEGExtended12Bit, 8), (JPEGExtended12Bit, 12)])
def test_lossy_jpeg_stays_near_and_is_reported(syntax: str, bits: int, tmp_path: Path) -> None:
    volume, report = read_ct(save(tmp_path / "scan", jpeg_series(bits, lossless=False), syntax=syntax))
    # at quality 100 the cosine transform's rounding is left: a few steps of the stored numbers
    assert np.abs(volume.voxels.astype(int) - head()).max() <= (6 * 16 if bits == 8 else 12)
    assert "LossyCompression" in {f.code for f in report.findings}


def test_twelve_bits_without_loss_are_exact(tmp_path: Path) -> None:
    volume, _ = read_ct(save(tmp_path / "scan", jpeg_series(12, lossless=True), syntax=JPEGLosslessSV1))
    np.testing.assert_array_equal(volume.voxels, head())


@pytest.mark.parametrize("syntax", [JPEGBaseline8Bit, JPEGExtended12Bit])
def test_jpeg_of_another_process_is_refused(syntax: str, tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", jpeg_series(12, lossless=True), syntax=syntax)
    assert refusal(folder).code == "CorruptPixelData"


@pytest.mark.parametrize("cut", [2, 3, 40, 300])
@pytest.mark.parametrize("lossless", [True, False])
def test_jpeg_stream_cut_inside_its_item_is_refused(cut: int, lossless: bool, tmp_path: Path) -> None:
    # the item is as long as it says, so only the stream itself tells; its decoder fills what is missing
    datasets = jpeg_series(12, lossless)
    frame = get_frame(datasets[5].PixelData, 0, number_of_frames=1).rstrip(b"\0")
    datasets[5].PixelData = encapsulate([frame[:-cut]])
    folder = save(tmp_path / "scan", datasets, syntax=JPEGLosslessSV1 if lossless else JPEGExtended12Bit)
    assert refusal(folder).code == "CorruptPixelData"


@pytest.mark.parametrize("with_table", [True, False])
@pytest.mark.parametrize("pieces", [1, 3])
def test_frames_of_one_file_are_told_apart(with_table: bool, pieces: int, tmp_path: Path) -> None:
    datasets = jpeg_series(12, lossless=True)
    frames = [get_frame(ds.PixelData, 0, number_of_frames=1) for ds in datasets]
    whole, count = datasets[0], len(frames)
    whole.PixelData = encapsulate(frames, fragments_per_frame=pieces, has_bot=with_table)
    whole.NumberOfFrames = count
    path = next(save(tmp_path / "scan", [whole], syntax=JPEGLosslessSV1).iterdir())
    dataset, place = parse_file(path, 0)
    header = read_headers(dataset, place, 0)
    if pieces > 1 and not with_table:
        with pytest.raises(InputRefused):
            next(read_stack(header))
        return
    stored = dict(read_stack(header))
    np.testing.assert_array_equal(np.stack([stored[k] for k in range(count)]).astype(int) - 1024, head())


def test_many_empty_fragments_are_refused_at_once(tmp_path: Path) -> None:
    datasets = jpeg_series(12, lossless=True)
    datasets[5].PixelData = b"\xfe\xff\x00\xe0\0\0\0\0" * 400_000
    assert refusal(save(tmp_path / "scan", datasets, syntax=JPEGLosslessSV1)).code == "LimitExceeded"


def test_missing_decoder_names_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    datasets = series(head())
    for ds in datasets:
        ds.compress(JPEGLSLossless, encoding_plugin="pyjpegls")
    folder = save(tmp_path / "scan", datasets)
    monkeypatch.setattr("cranio_nb.readers.dicom.codecs.find_spec", lambda name: None)
    error = refusal(folder)
    assert error.code == "UnsupportedTransferSyntax" and "pyjpegls" in error.remedy


def test_only_compressed_syntaxes_need_a_decoder() -> None:
    assert find_missing_decoder("1.2.840.10008.1.2.1") == ""
    assert RLELossless in COMPRESSED and find_missing_decoder(RLELossless) == ""
