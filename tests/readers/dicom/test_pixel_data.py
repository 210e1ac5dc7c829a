"""Stored numbers of every width and sign, and formats that are refused before anything is decoded."""

import struct
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from dicom_series import head, patch, refusal, save, series

from cranio_nb.readers import read_ct

SMALL = (9, 22, 26)


@pytest.mark.parametrize(("bits", "signed"), [*product((12, 14, 16, 32), (False, True))])
def test_every_width_and_sign_is_read_exactly(bits: int, signed: bool, tmp_path: Path) -> None:
    hu = head(SMALL)
    datasets = series(hu, bits=bits, signed=signed, intercept=0 if signed else -1024)
    volume, _ = read_ct(save(tmp_path / "scan", datasets))
    np.testing.assert_array_equal(volume.voxels, hu)


@pytest.mark.parametrize("signed", [False, True])
def test_rubbish_above_the_stored_bits_is_ignored(signed: bool, tmp_path: Path) -> None:
    hu = head(SMALL)
    datasets = series(hu, bits=12, signed=signed, intercept=0 if signed else -1024)
    for ds in datasets:
        stored = np.frombuffer(ds.PixelData, "<u2").copy()
        stored ^= (np.arange(stored.size) % 16 << 12).astype("<u2")
        ds.PixelData = stored.tobytes()
    volume, _ = read_ct(save(tmp_path / "scan", datasets))
    np.testing.assert_array_equal(volume.voxels, hu)


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


def test_element_of_four_gigabytes_is_refused(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    for path in folder.iterdir():
        content = path.read_bytes()
        at = content.index(b"\xe0\x7f\x10\x00OW")
        path.write_bytes(content[: at + 8] + struct.pack("<L", 0xFFFFFFF0) + content[at + 12 :])
    assert refusal(folder).code == "CorruptPixelData"
