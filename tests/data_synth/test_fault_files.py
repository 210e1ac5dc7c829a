"""Edits of files."""

from pathlib import Path

import pydicom
import pytest
from pydicom.uid import JPEGLSLossless

from data_synth.fault_files import cut_file, nested_sequences, patch_bytes, relabel_syntax
from data_synth.fault_series import Recipe, write_folder


def test_files_are_cut_and_patched(tmp_path: Path) -> None:
    write_folder(tmp_path, Recipe())
    size = (tmp_path / "image0005.dcm").stat().st_size
    cut_file(5, 0.5)(tmp_path)
    cut_file(6, 100)(tmp_path)
    assert (tmp_path / "image0005.dcm").stat().st_size == size // 2
    assert (tmp_path / "image0006.dcm").stat().st_size == 100
    with pytest.raises(ValueError):
        patch_bytes(7, b"nowhere in it", b"nowhere in it")(tmp_path)


def test_a_relabelled_file_is_whole_but_for_its_label(tmp_path: Path) -> None:
    write_folder(tmp_path, Recipe())
    before = pydicom.dcmread(tmp_path / "image0003.dcm")
    relabel_syntax(JPEGLSLossless)(tmp_path)
    after = pydicom.dcmread(tmp_path / "image0003.dcm", stop_before_pixels=True)
    assert after.file_meta.TransferSyntaxUID == JPEGLSLossless
    assert after.ImagePositionPatient == before.ImagePositionPatient


def test_nested_sequences_are_as_deep_as_asked() -> None:
    assert nested_sequences(7).count(b"\xfe\xff\x00\xe0") == 7
