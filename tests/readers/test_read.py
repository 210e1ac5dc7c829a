"""What is no scan at all, and what the report says."""

import bz2
import gzip
import tarfile
import zipfile
from pathlib import Path

from dicom_series import head, refusal, save, series
from image_files import file_refusal


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


def test_files_of_other_kinds_are_refused(tmp_path: Path) -> None:
    for name, content in (
        ("a.nii", b"no scan"),
        ("a.nii.gz", gzip.compress(b"no scan at all" * 100)),
        ("a.nrrd", b"NRRD"),
        ("empty.nii", b""),
        ("a.bz2", bz2.compress(b"x")),
    ):
        (tmp_path / name).write_bytes(content)
        assert file_refusal(tmp_path / name).code == "UnsupportedFile"


def test_archives_and_indices_say_what_to_give(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.write(folder / "image0003.dcm")
    with tarfile.open(tmp_path / "a.tar", "w") as archive:
        archive.add(folder / "image0003.dcm")
    for name in ("a.zip", "a.tar"):
        error = file_refusal(tmp_path / name)
        assert error.code == "UnsupportedFile" and "folder" in error.remedy
    (folder / "DICOMDIR").write_bytes((folder / "image0003.dcm").read_bytes())
    error = refusal(folder / "DICOMDIR")
    assert error.code == "UnsupportedFile" and "folder" in error.remedy
