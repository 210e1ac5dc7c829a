"""DICOM files that end too early or nest too deep, and the place of the pixels in those that do not."""

from pathlib import Path

import numpy as np
import pytest
from dicom_series import head, refusal, save, series

from cranio_nb.readers.dicom.parse import parse_file


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


@pytest.mark.parametrize("depth", [200, 2000, 20_000])
def test_deep_nesting_never_crashes(depth: int, tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    path = folder / "image0005.dcm"
    content = path.read_bytes()
    nested = b"\x08\x00\x40\x11SQ\0\0\xff\xff\xff\xff" + b"\xfe\xff\x00\xe0\xff\xff\xff\xff"
    at = content.index(b"\x08\x00\x60\x00CS")
    path.write_bytes(content[:at] + nested * depth + content[at:])
    assert refusal(folder).code == "CorruptDicom"


def test_the_place_of_the_pixels_is_where_they_are(tmp_path: Path) -> None:
    hu = head((9, 22, 26))
    path = save(tmp_path / "scan", series(hu)) / "image0004.dcm"
    parsed = parse_file(path, 4)
    assert parsed is not None
    dataset, place = parsed
    assert place is not None and (dataset.Rows, dataset.Columns) == hu.shape[1:]
    content = path.read_bytes()[place.offset : place.offset + place.length]
    np.testing.assert_array_equal(np.frombuffer(content, "<u2").reshape(22, 26).astype(int) - 1024, hu[4])


def test_other_files_are_not_parsed(tmp_path: Path) -> None:
    (tmp_path / "note").write_text("no scan at all" * 20)
    assert parse_file(tmp_path / "note", 0) is None
