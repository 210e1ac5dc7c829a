"""Stray and damaged files beside a scan: left out with a warning, and fatal only where they may be slices."""

import struct
from pathlib import Path

import numpy as np
import pytest
from dicom_series import codes, head, refusal, save, series
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.uid import ExplicitVRLittleEndian, ImplicitVRLittleEndian

from cranio_nb.readers import read_ct
from cranio_nb.readers.dicom import scan
from data_synth.fault_edits import set_elements

DOSE_REPORT = "1.2.840.10008.5.1.4.1.1.88.67"


def report_bytes(tmp_path: Path) -> bytes:
    """A structured report, as scanners put beside a scan."""
    ds = Dataset()
    ds.file_meta = FileMetaDataset()
    ds.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
    ds.SOPClassUID = ds.file_meta.MediaStorageSOPClassUID = DOSE_REPORT
    ds.SOPInstanceUID = ds.file_meta.MediaStorageSOPInstanceUID = "1.2.3.9"
    ds.Modality, ds.SeriesInstanceUID = "SR", "1.2.3.10"
    ds.ContentSequence = [Dataset()]
    ds.ContentSequence[0].TextValue = "dose"
    ds.save_as(tmp_path / "report", enforce_file_format=True)
    return (tmp_path / "report").read_bytes()


APPLE_DOUBLE = struct.pack(">LL16sH", 0x00051607, 0x00020000, b"Mac OS X        ", 2).ljust(120, b"\0")
STRAYS = {
    "a Mac's second file": ("._image0003.dcm", APPLE_DOUBLE, "EntriesSkipped"),
    "a large one": ("._image0004.dcm", APPLE_DOUBLE + bytes(4000), "EntriesSkipped"),
    "what starts like DICOM": ("data.bin", b"\x08\x00\x01\x00" + bytes(400), "DamagedLeft"),
    "an empty preamble": ("fake.dcm", bytes(128) + b"DICM", "DamagedLeft"),
    "rubbish behind the preamble": ("fake", bytes(128) + b"DICM\x02\x00" + b"rubbish" * 40, "DamagedLeft"),
    "a few words": ("readme.dcm", b"no image", "FilesSkipped"),
    "a photograph": ("photo.dcm", b"\xff\xd8\xff\xe0" + bytes(5000), "FilesSkipped"),
}


@pytest.mark.parametrize("name", STRAYS)
def test_a_stray_file_is_left_out_with_a_warning(name: str, tmp_path: Path) -> None:
    file, content, code = STRAYS[name]
    folder = save(tmp_path / "scan", series(head()))
    (folder / file).write_bytes(content)
    volume, report = read_ct(folder)
    np.testing.assert_array_equal(volume.voxels, head())
    assert (code, "warning") in {(f.code, f.severity) for f in report.findings}


@pytest.mark.parametrize("keep", [1.0, 0.95, 0.5])
@pytest.mark.parametrize("tail", [0, 512])
def test_a_dose_report_whole_padded_or_cut_is_left_out(keep: float, tail: int, tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    content = report_bytes(tmp_path)
    (folder / "SR0001").write_bytes(content[: int(len(content) * keep)] + bytes(tail))
    volume, _ = read_ct(folder)
    np.testing.assert_array_equal(volume.voxels, head())


def test_a_damaged_slice_of_another_series_does_not_matter(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    other = save(tmp_path / "other", series(head())[:4])
    for number, path in enumerate(sorted(other.iterdir())):
        (folder / f"image9{number}.dcm").write_bytes(path.read_bytes()[:-100])
    volume, report = read_ct(folder)
    np.testing.assert_array_equal(volume.voxels, head())
    assert "DamagedLeft" in codes(report)


@pytest.mark.parametrize("implicit", [False, True])
@pytest.mark.parametrize("keep", [0, 1, 100, 132, 140, 300, 600, 1000])
def test_a_cut_topmost_slice_is_missed(keep: int, implicit: bool, tmp_path: Path) -> None:
    # no gap tells of it, and it says of no series: its name and its start do
    folder = save(tmp_path / "scan", series(head()), syntax=ImplicitVRLittleEndian if implicit else None)
    victim = folder / "image0023.dcm"
    victim.write_bytes(victim.read_bytes()[:keep])
    assert refusal(folder).code in {"CorruptDicom", "CorruptPixelData"}


def test_a_slice_that_lost_its_mark_is_missed(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    victim = folder / "image0023.dcm"
    victim.write_bytes(victim.read_bytes().replace(b"DICM", b"DICN", 1))
    assert refusal(folder).code == "CorruptDicom"


def test_an_empty_file_named_like_an_image_is_refused_and_another_is_not(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    (folder / "LOCK").write_bytes(b"")
    read_ct(folder)
    (folder / "extra.dcm").write_bytes(b"")
    assert refusal(folder).code == "CorruptDicom"


def test_frames_are_counted_over_the_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scan, "MAX_IMAGES", 20)
    assert refusal(save(tmp_path / "scan", series(head()))).code == "LimitExceeded"


def test_promised_frames_without_bytes_cost_nothing(tmp_path: Path) -> None:
    datasets = series(head())
    set_elements(slice(None), NumberOfFrames=4000, PixelData=b"\0\0", Rows=1, Columns=1)(datasets)
    assert refusal(save(tmp_path / "scan", datasets)).code == "CorruptPixelData"
