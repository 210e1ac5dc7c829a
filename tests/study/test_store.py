"""Rows on disk: whole or not there, each once, one writer."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("pyarrow", reason="the extra `study` is not installed")

from cranio_nb.errors import CannotWrite, InputRefused
from cranio_nb.study import store
from cranio_nb.study.store import SCHEMA, Store


def row(key, **values):
    return {"key": key, "case": "a", "status": "done", **values}


@pytest.fixture
def folder(tmp_path):
    with Store(tmp_path / "study").opened():
        yield Store(tmp_path / "study")


def test_what_was_written_is_read(folder):
    folder.add([row("x", dice=0.5, threshold_hu=300.0), row("y")])
    folder.add([row("z", dice=0.25)])
    assert folder.done() == {"x", "y", "z"}
    found = folder.columns(["z", "not yet", "x"])
    assert found["key"].tolist() == ["z", "x"] and found["dice"].tolist() == [0.25, 0.5]
    assert np.isnan(found["threshold_hu"][0]) and found["code"].tolist() == ["", ""]
    assert set(found) == set(SCHEMA.names)


def test_a_part_that_was_not_finished_is_no_row(folder):
    folder.add([row("x")])
    whole = next(folder.rows.glob("*.parquet"))
    (folder.rows / f".part-12-{whole.name}").write_bytes(whole.read_bytes()[:50])
    assert folder.done() == {"x"}


def test_the_same_batch_has_the_same_file(folder):
    for dice in (0.1, 0.2):
        folder.add([row("x", dice=dice)])
    assert folder.columns()["dice"].tolist() == [0.2]


@given(keys=st.lists(st.integers(0, 9), min_size=1, max_size=12))
def test_one_file_is_made_of_many_and_each_row_is_there_once(
    keys,
    tmp_path_factory,
):
    folder = Store(tmp_path_factory.mktemp("study"))
    with pytest.MonkeyPatch.context() as patch, folder.opened():
        patch.setattr(store, "_MANY", 1)
        for i, key in enumerate(keys):  # a batch of two, so that keys come twice in several files
            folder.add([row(str(key)), row(f"{key}-{i}")])
        folder.tidy()
    assert len(list(folder.rows.glob("*.parquet"))) == 1
    assert sorted(folder._table()["key"].to_pylist()) == sorted(
        {*map(str, keys), *(f"{k}-{i}" for i, k in enumerate(keys))}
    )


def test_one_process_works_on_a_study(folder):
    with pytest.raises(CannotWrite, match="Another process"), Store(folder.folder).opened():
        pass
    with Store(folder.folder).opened("-1-2"), Store(folder.folder).opened("-2-2"):
        assert folder.done() == set()


def test_a_file_of_another_kind_is_named(folder):
    (folder.rows / "mine.parquet").write_text("words")
    with pytest.raises(InputRefused, match=r"rows/mine\.parquet holds no rows"):
        folder.done()


def test_a_disk_that_refuses_ends_the_study(folder, monkeypatch):
    def full(path, data):
        raise CannotWrite("CannotWrite", "No space.")

    monkeypatch.setattr(store, "write_whole", full)
    with pytest.raises(CannotWrite):
        folder.add([row("x")])
    assert folder.done() == set()


def test_a_folder_that_cannot_be_made_is_refused(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(CannotWrite), Store(tmp_path / "file").opened():
        pass


def test_files_that_are_made_one_while_they_are_read_are_read_there(folder, monkeypatch):
    for key in "abc":
        folder.add([row(key)])
    seen = folder._files()
    monkeypatch.setattr(store, "_MANY", 1)
    folder.tidy()
    answers = [seen, folder._files()]
    monkeypatch.setattr(Store, "_files", lambda self: answers.pop(0))
    assert folder.done() == {"a", "b", "c"}
