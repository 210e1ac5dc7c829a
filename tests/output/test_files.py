"""Text and JSON are written whole or not at all."""

import dataclasses
import errno
import json
import os
from pathlib import Path

import numpy as np
import pytest

from cranio_nb.errors import CannotWrite
from cranio_nb.grid import AxisOrder
from cranio_nb.output import files
from cranio_nb.output.files import jsonable, write_json


def test_json_is_strict_and_holds_dataclasses_and_arrays(tmp_path):
    data = {"order": AxisOrder((2, 0, 1), (True, False, False)), "gap": np.float32(0.25), "path": (np.inf, np.nan)}
    write_json(tmp_path / "a.json", data)
    found = json.loads((tmp_path / "a.json").read_text(), parse_constant=pytest.fail)
    assert found == {
        "order": dataclasses.asdict(data["order"]) | {"axes": [2, 0, 1], "flips": [True, False, False]},
        "gap": 0.25,
        "path": [None, None],
    }
    with pytest.raises(CannotWrite):
        jsonable({"what": object()})


def test_text_is_utf8(tmp_path):
    files.write_text(tmp_path / "a.txt", "Schädel µm\n")
    assert (tmp_path / "a.txt").read_bytes().decode("utf-8") == "Schädel µm\n"


class TestFailures:
    def test_a_read_only_system_is_refused_in_words_without_the_path(self, tmp_path, monkeypatch):
        def refuse(self, *args, **kwargs):
            raise OSError(errno.EROFS, "Read-only file system", str(self))

        monkeypatch.setattr(Path, "open", refuse)
        with pytest.raises(CannotWrite) as refusal:
            files.write_text(tmp_path / "a.txt", "text")
        assert "a.txt" in str(refusal.value) and "Read-only file system" in str(refusal.value)
        assert str(tmp_path) not in str(refusal.value)

    def test_a_full_disk_keeps_the_old_file_and_leaves_nothing(self, tmp_path, monkeypatch):
        files.write_text(tmp_path / "a.txt", "old")

        def full(handle):
            raise OSError(errno.ENOSPC, "No space left on device")

        monkeypatch.setattr(os, "fsync", full)
        with pytest.raises(CannotWrite, match="No space left"):
            files.write_text(tmp_path / "a.txt", "new")
        assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]
        assert (tmp_path / "a.txt").read_text() == "old"

    def test_a_folder_that_is_not_there_is_refused(self, tmp_path):
        with pytest.raises(CannotWrite) as refusal:
            files.write_text(tmp_path / "nowhere" / "a.txt", "")
        assert refusal.value.code == "CannotWrite" and str(tmp_path) not in str(refusal.value)

    def test_a_file_that_is_not_as_wanted_is_not_kept(self, tmp_path):
        def wrong(part):
            assert part.read_bytes() == b"new" and part.parent == tmp_path
            raise CannotWrite("CannotWrite", "It reads back as another one.")

        with pytest.raises(CannotWrite, match="another one"):
            files.write_whole(tmp_path / "a.bin", b"new", wrong)
        assert list(tmp_path.iterdir()) == []


def test_json_text_is_what_is_written(tmp_path):
    data = {"names": ("ä", "b"), "n": np.int64(3)}
    write_json(tmp_path / "a.json", data)
    text = files.json_text(data)
    assert (tmp_path / "a.json").read_text(encoding="utf-8") == text + "\n" and "ä" in text
    assert json.loads(text) == {"names": ["ä", "b"], "n": 3}
