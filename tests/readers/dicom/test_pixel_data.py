"""Stored numbers of every width and sign, and formats that are refused before anything is decoded."""

import struct
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from dicom_series import head, patch, refusal, save, series
from pydicom.encaps import encapsulate, get_frame
from pydicom.uid import DeflatedExplicitVRLittleEndian, RLELossless

from cranio_nb.readers import read_ct
from cranio_nb.readers.dicom import pixel_data
from cranio_nb.readers.dicom.inflated import open_dataset
from cranio_nb.readers.dicom.parse import parse_file
from cranio_nb.readers.dicom.pixel_data import read_stack
from cranio_nb.readers.dicom.slice_header import read_headers
from data_synth.fault_edits import set_elements

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
    volume, report = read_ct(save(tmp_path / "scan", datasets))
    np.testing.assert_array_equal(volume.voxels, hu)
    assert ("UnusedBits", "corrected") in {(f.code, f.severity) for f in report.findings}


@pytest.mark.parametrize("signed", [False, True])
@pytest.mark.parametrize("which", [slice(None), slice(5, 6)])
def test_numbers_that_need_more_bits_than_declared_are_refused(signed: bool, which: slice, tmp_path: Path) -> None:
    datasets = series(head(SMALL), bits=12, signed=signed, intercept=0 if signed else -1024)
    set_elements(which, BitsStored=10, HighBit=9)(datasets)
    assert refusal(save(tmp_path / "scan", datasets)).code == "CorruptPixelData"


@pytest.mark.parametrize("extra", [1, 3, 10, 40])
def test_some_bytes_behind_the_pixels_are_left_with_a_warning(extra: int, tmp_path: Path) -> None:
    hu = head(SMALL)
    datasets = series(hu)
    for ds in datasets:
        ds.PixelData += bytes(extra)
    volume, report = read_ct(save(tmp_path / "scan", datasets))
    np.testing.assert_array_equal(volume.voxels, hu)
    assert [f.code for f in report.findings if f.severity == "warning"] == ["ExcessPixels"]


@pytest.mark.parametrize("change", [{"Rows": SMALL[1] - 1}, {"Columns": SMALL[2] - 1}, {"Columns": SMALL[2] - 2}])
def test_a_row_or_a_column_too_few_is_refused(change: dict[str, int], tmp_path: Path) -> None:
    datasets = series(head(SMALL))
    set_elements(slice(None), **change)(datasets)
    assert refusal(save(tmp_path / "scan", datasets)).code == "CorruptPixelData"


def test_a_run_that_is_longer_than_the_image_is_a_warning(tmp_path: Path) -> None:
    hu = head(SMALL)
    datasets = series(hu)
    for ds in datasets:
        ds.compress(RLELossless, encoding_plugin="pydicom", generate_instance_uid=False)
    frame = get_frame(datasets[4].PixelData, 0, number_of_frames=1)
    datasets[4].PixelData = encapsulate([frame + bytes.fromhex("0701020304050607080708")])
    volume, report = read_ct(save(tmp_path / "scan", datasets))
    np.testing.assert_array_equal(volume.voxels, hu)
    assert "DecoderRemarks" in {f.code for f in report.findings}


def test_a_deflated_file_of_many_frames_is_inflated_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    hu = head((60, 22, 26))
    datasets = series(hu)
    whole = datasets[0]
    whole.NumberOfFrames, whole.PixelData = len(hu), b"".join(ds.PixelData for ds in datasets)
    folder = save(tmp_path / "scan", [whole], syntax=DeflatedExplicitVRLittleEndian)
    parsed = parse_file(folder / "image0000.dcm", 0)
    assert parsed is not None
    opened = []
    monkeypatch.setattr(pixel_data, "open_dataset", lambda *a: opened.append(1) or open_dataset(*a))
    stored = dict(read_stack(read_headers(*parsed, 0)))
    np.testing.assert_array_equal(np.stack([stored[k] for k in range(60)]).astype(int) - 1024, hu)
    assert len(opened) == 1


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
