"""What a run wrote is known by its digests: a changed, added or linked file is not its own."""

import hashlib
import json

import pytest

from cranio_nb.output.manifest import MANIFEST, is_ours, read_manifest, write_manifest


@pytest.fixture
def folder(tmp_path):
    """A folder with a file and a folder of files, and their manifest."""
    (tmp_path / "slices").mkdir()
    (tmp_path / "a.txt").write_text("words")
    (tmp_path / "slices" / "b.txt").write_text("more words")
    assert write_manifest(tmp_path, tmp_path) == []
    return tmp_path


def test_the_manifest_names_every_file_with_its_digest(folder):
    wanted = {"a.txt": b"words", "slices/b.txt": b"more words"}
    assert read_manifest(folder) == {name: hashlib.sha256(text).hexdigest() for name, text in wanted.items()}
    assert all(is_ours(folder, name) for name in ("a.txt", "slices", MANIFEST))


def test_what_was_changed_added_or_linked_is_not_ours(folder):
    (folder / "a.txt").write_text("other words")
    (folder / "slices" / "mine.txt").write_text("mine")
    (folder / "link.txt").symlink_to(folder / "slices" / "b.txt")
    assert not any(is_ours(folder, name) for name in ("a.txt", "slices", "link.txt", "nowhere"))


def test_a_link_within_a_folder_is_not_followed(folder):
    (folder / "slices" / "b.txt").rename(folder / "b.txt")
    (folder / "slices" / "b.txt").symlink_to(folder / "b.txt")
    assert not is_ours(folder, "slices")


def test_entries_that_are_not_replaced_are_kept_and_what_is_left_over_is_named(folder, tmp_path_factory):
    new = tmp_path_factory.mktemp("new")
    (new / "c.txt").write_text("new words")
    assert write_manifest(new, folder, owned=("slices", "c.txt")) == ["slices"]
    assert set(read_manifest(new)) == {"a.txt", "c.txt"}


@pytest.mark.parametrize("text", ["", "[]", "{}", json.dumps({"files": 3})])
def test_a_manifest_that_is_none_holds_nothing(tmp_path, text):
    (tmp_path / MANIFEST).write_text(text)
    assert read_manifest(tmp_path) == {} and not is_ours(tmp_path, MANIFEST)


def test_equal_files_give_an_equal_manifest(tmp_path):
    texts = []
    for name, order in (("x", "ab"), ("y", "ba")):
        (tmp_path / name).mkdir()
        for file in order:
            (tmp_path / name / file).write_text(file)
        write_manifest(tmp_path / name, tmp_path / "goal")
        texts.append((tmp_path / name / MANIFEST).read_bytes())
    assert texts[0] == texts[1]


def test_a_manifest_nested_without_end_holds_nothing(tmp_path):
    (tmp_path / MANIFEST).write_text("[" * 100_000)
    assert read_manifest(tmp_path) == {}
