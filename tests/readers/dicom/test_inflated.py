"""Deflated DICOM files that unpack too far or end too early."""

import io
import zlib
from pathlib import Path

import pydicom
import pytest
from dicom_series import head, refusal, save, series

from cranio_nb.readers.dicom.inflated import Inflated


@pytest.mark.parametrize("element", [b"", b"\x09\x00\x10\x10OB\0\0\0\0\0\x10"], ids=["elements", "bytes"])
def test_deflate_bomb_is_refused(element: bytes, tmp_path: Path) -> None:
    """320 MB of zeros: each 8 of them are an empty element, or all belong to one that declares 256 MB."""
    bomb = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
    zeros = bytes(2**24)
    packed = bomb.compress(element) + b"".join(bomb.compress(zeros) for _ in range(20)) + bomb.flush()
    folder = save(tmp_path / "scan", series(head())[:1], syntax="1.2.840.10008.1.2.1.99")
    path = folder / "image0000.dcm"
    with open(path, "rb") as stream:
        meta = pydicom.filereader.read_file_meta_info(path)
        size = 144 + meta.FileMetaInformationGroupLength
        start = stream.read(size)
    path.write_bytes(start + packed)
    error = refusal(folder)
    assert error.code == "LimitExceeded"
    assert ("bytes" if element else "elements") in str(error)


def test_a_packed_stream_that_ends_early_ends_the_reading() -> None:
    packer = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
    packed = packer.compress(bytes(300_000) + b"end") + packer.flush()
    data = Inflated(io.BytesIO(packed + bytes(100_000)), 0)
    assert data.read(400_000) == bytes(300_000) + b"end" and data.read(1) == b""
    assert data.seek(300_001) == 300_001 and data.read(9) == b"nd"
    # a stream that was cut gives what it holds
    assert 0 < len(Inflated(io.BytesIO(packed[: len(packed) // 2]), 0).read(400_000)) < 300_003
