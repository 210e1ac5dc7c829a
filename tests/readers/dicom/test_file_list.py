"""Folders with other things in them: listed in order, skipped and counted, or refused."""

import os
from pathlib import Path

import numpy as np
import pytest
from dicom_series import head, refusal, save, series

from cranio_nb.readers import read_ct
from cranio_nb.readers.dicom.file_list import MAX_DEPTH, list_files, looks_like_dicom


def test_empty_file_is_refused(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    (folder / "image0005.dcm").write_bytes(b"")
    assert refusal(folder).code == "CorruptDicom"


def test_folder_without_permission_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def closed(path: object) -> None:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr("cranio_nb.readers.dicom.file_list.os.scandir", closed)
    assert refusal(save(tmp_path / "scan", series(head()))).code == "PermissionDenied"


def test_too_many_files_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cranio_nb.readers.dicom.file_list.MAX_FILES", 20)
    assert refusal(save(tmp_path / "scan", series(head()))).code == "LimitExceeded"


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
    assert (skipped["not_dicom"], skipped["link"], skipped["special file"], skipped["empty"]) == (3, 2, 1, 1)


def test_files_are_listed_by_name_down_to_a_depth(tmp_path: Path) -> None:
    deep = tmp_path / "scan"
    for level in range(MAX_DEPTH + 2):
        deep.mkdir()
        (deep / "b").write_bytes(bytes(200))
        (deep / "a").write_bytes(bytes(200))
        deep /= f"c{level}"
    files, findings = list_files(tmp_path / "scan")
    assert files == sorted(files) and len(files) == 2 * (MAX_DEPTH + 1)
    assert findings[0].values == {"folder too deep": 1}


def test_a_mark_in_the_wrong_place_does_not_make_a_dicom_file() -> None:
    assert looks_like_dicom(bytes(128) + b"DICM" + b"\x02\x00\x00\x00")
    assert not looks_like_dicom(b"DICM" * 40)
