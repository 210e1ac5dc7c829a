"""What a compressed stream says of itself, and damage of every kind: refused, or never other numbers without a word."""

from pathlib import Path

import imagecodecs
import numpy as np
import openjpeg
import pytest
from dicom_series import head, save, series
from pydicom.encaps import encapsulate, get_frame
from pydicom.uid import JPEG2000Lossless, JPEGBaseline8Bit, JPEGLosslessSV1, JPEGLSLossless, RLELossless

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from cranio_nb.readers.dicom.compressed_stream import CompressedStream, check_stream

END = b"\xff\xd9"


def stored(ds):
    return np.frombuffer(ds.PixelData, "<u2").reshape(ds.Rows, ds.Columns)


def run_lengths(ds):
    ds.compress(RLELossless, encoding_plugin="pydicom", generate_instance_uid=False)
    return get_frame(ds.PixelData, 0)


def jpeg_ls(ds):
    ds.compress(JPEGLSLossless, encoding_plugin="pyjpegls")
    return get_frame(ds.PixelData, 0)


STREAMS = {
    JPEGLosslessSV1: lambda ds: imagecodecs.jpeg8_encode(stored(ds), lossless=True, bitspersample=16),
    JPEG2000Lossless: lambda ds: bytes(openjpeg.encode(stored(ds), bits_stored=16)),
    JPEGLSLossless: jpeg_ls,
    RLELossless: run_lengths,
}


def written(folder, syntax, change):
    """A series with one slice's stream changed; and its true HU."""
    hu = head((9, 42, 48))
    datasets = series(hu)
    for place, ds in enumerate(datasets):
        stream = STREAMS[syntax](ds)
        ds.PixelData = encapsulate([change(stream) if place == 4 else stream])
        ds["PixelData"].is_undefined_length = True
    return save(folder, datasets, syntax=syntax), hu


CUTS = {
    "behind its middle": lambda s: s[: len(s) // 2],
    "behind its middle, with an end": lambda s: s[: len(s) // 2] + END,
    "its last tenth, with an end": lambda s: s[: -len(s) // 10] + END,
    "its last 8 bytes, with an end": lambda s: s[:-10] + END,
    "a piece of its middle": lambda s: s[: len(s) // 2] + s[len(s) // 2 + 40 :],
    "a piece put in": lambda s: s[: len(s) // 2] + bytes(range(40)) + s[len(s) // 2 :],
    "a piece of zeros": lambda s: s[: len(s) // 2] + bytes(60) + s[len(s) // 2 + 60 :],
    "twice": lambda s: s + s,
    "something behind its end": lambda s: s + b"more than padding",
    "nearly empty": lambda s: s[:2],
    "its head alone": lambda s: s[:60],
}
# other bytes within the coded data of JPEG 2000 are other numbers: nothing in the stream tells
DAMAGE = [(s, c) for s in STREAMS for c in CUTS if (s, c) != (JPEG2000Lossless, "a piece of zeros")]


@pytest.mark.parametrize(("syntax", "cut"), DAMAGE)
def test_a_damaged_stream_is_refused_or_said(syntax, cut, tmp_path: Path):
    folder, hu = written(tmp_path / "scan", syntax, CUTS[cut])
    try:
        volume, report = read_ct(folder)
    except InputRefused as error:
        assert error.code in ("CorruptPixelData", "CorruptDicom")
        return
    assert np.array_equal(volume.voxels, hu) or [f for f in report.findings if f.severity != "info"]


@pytest.mark.parametrize("syntax", STREAMS, ids=lambda syntax: syntax.name.split(" (")[0])
def test_padding_behind_a_stream_is_none_of_its_damage(syntax, tmp_path: Path):
    folder, hu = written(tmp_path / "scan", syntax, lambda stream: stream + bytes(2))
    volume, _ = read_ct(folder)
    np.testing.assert_array_equal(volume.voxels, hu)


@pytest.mark.parametrize("seed", range(40))
def test_a_lossless_jpeg_out_of_step_is_refused(seed):
    """A stream that goes out of step at one place reads as other numbers by each decoder from there on."""
    (ds,) = series(head((1, 42, 48)))
    stream = STREAMS[JPEGLosslessSV1](ds)
    at = int(np.random.default_rng(seed).integers(len(stream) // 3, len(stream) - 60))
    bad = stream[:at] + stream[at + 7 :]
    check_stream(CompressedStream(bad), JPEGLosslessSV1, 42, 48, 16)
    a, b = imagecodecs.jpeg8_decode(bad), imagecodecs.jpegsof3_decode(bad)
    assert not np.array_equal(a, b)


def in_parts(rows, n_parts, lost=()):
    """A lossless JPEG whose parts are alike, coded one by one; and its numbers."""
    part = (np.add.outer(np.arange(rows), np.arange(31)) * 37 % 4001).astype(np.uint16)
    stream = imagecodecs.jpeg8_encode(part, lossless=True, bitspersample=12)
    begin = stream.index(b"\xff\xda")
    data = stream[begin + 2 + int.from_bytes(stream[begin + 2 : begin + 4], "big") : -2]
    ahead = stream[:begin]
    size = ahead.index(b"\xff\xc3") + 5
    ahead = ahead[:size] + (rows * n_parts).to_bytes(2, "big") + ahead[size + 2 :]
    ahead += b"\xff\xdd\x00\x04" + (rows * 31).to_bytes(2, "big") + stream[begin : stream.index(data)]
    marks = [(data + (bytes([0xFF, 0xD0 + i % 8]) if i < n_parts - 1 else b"")) for i in range(n_parts)]
    return ahead + b"".join(mark for i, mark in enumerate(marks) if i not in lost) + END, np.tile(part, (n_parts, 1))


def test_a_stream_in_parts_is_read_and_misses_none():
    stream, numbers = in_parts(4, 11)
    assert CompressedStream(stream).part_length == 124
    check_stream(CompressedStream(stream), JPEGLosslessSV1, 44, 31, 16)
    np.testing.assert_array_equal(imagecodecs.jpeg8_decode(stream), numbers)
    for lost in ((3,), (10,), tuple(range(1, 9))):
        with pytest.raises(ValueError, match="parts"):
            check_stream(CompressedStream(in_parts(4, 11, lost)[0]), JPEGLosslessSV1, 44, 31, 16)


def test_a_baseline_stream_of_other_form_is_refused():
    grey = np.add.outer(np.arange(24), np.arange(40)).astype(np.uint8)
    stream = imagecodecs.jpeg8_encode(grey)
    check_stream(CompressedStream(stream), JPEGBaseline8Bit, 24, 40, 8)
    colours = imagecodecs.jpeg8_encode(np.dstack([grey] * 3))
    for bad, syntax, allocated, word in (
        (stream, JPEGLosslessSV1, 8, "process"),
        (colours, JPEGBaseline8Bit, 8, "colours"),
        (stream[:-40], JPEGBaseline8Bit, 8, "no end"),
        (stream + stream, JPEGBaseline8Bit, 8, "behind"),
        (stream, JPEGBaseline8Bit, 4, "more bits"),
        (b"", JPEGBaseline8Bit, 8, "process"),
    ):
        with pytest.raises(ValueError, match=word):
            check_stream(CompressedStream(bad), syntax, 24, 40, allocated)
    with pytest.raises(ValueError, match="size"):
        check_stream(CompressedStream(stream), JPEGBaseline8Bit, 40, 24, 8)


@pytest.mark.parametrize("size", [(42, 48), (300, 7), (1, 65535)])
@pytest.mark.parametrize("marker", [0xC0, 0xC3, 0xF7])
def test_the_size_in_a_stream_is_read_past_other_segments(marker, size):
    comment = b"\xff\xfe\x00\x06text" + b"\xff"  # a comment, then a byte of filling
    frame = bytes([0xFF, marker, 0, 11, 12]) + size[0].to_bytes(2, "big") + size[1].to_bytes(2, "big") + b"\1"
    found = CompressedStream(b"\xff\xd8" + comment + frame + bytes(50)).image
    assert (found.rows, found.cols, found.bits, found.components) == (*size, 12, 1)


def test_a_stream_without_a_size_has_none():
    assert all(CompressedStream(data).image is None for data in (b"", b"\xff\xd8" + bytes(100)))
