"""A manifest knows what a run wrote, file by file, and keeps what other runs wrote into the same folder."""

import hashlib
import json

import pytest

from cranio_nb.output.manifest import MANIFEST, is_ours, read_manifest, write_manifest


def put(folder, **files):
    """A folder with small files, and sub/c among them where it is named."""
    folder.mkdir(exist_ok=True)
    for name, text in files.items():
        path = folder / name.replace("__", "/")
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    return folder


def test_it_holds_the_digest_of_every_file(tmp_path):
    new = put(tmp_path / "new", a="1", sub__c="2")
    assert write_manifest(new, tmp_path / "goal") == []
    assert read_manifest(new) == {"a": hashlib.sha256(b"1").hexdigest(), "sub/c": hashlib.sha256(b"2").hexdigest()}
    assert is_ours(new, "a") and is_ours(new, "sub") and is_ours(new, MANIFEST)


def test_equal_files_give_an_equal_manifest(tmp_path):
    texts = []
    for name in ("x", "y"):
        new = put(tmp_path / name, b="1", a="2")
        write_manifest(new, tmp_path / "goal")
        texts.append((new / MANIFEST).read_bytes())
    assert texts[0] == texts[1]


def test_entries_of_others_are_kept_and_those_that_go_are_named(tmp_path):
    goal = put(tmp_path / "goal", a="1", b="1", other="1", sub__c="1")
    write_manifest(goal, tmp_path / "none")
    (goal / "mine").write_text("mine")
    new = put(tmp_path / "new", a="2")
    assert write_manifest(new, goal, ("a", "b", "sub", "mine", "none")) == ["b", "sub"]
    assert set(read_manifest(new)) == {"a", "other"}


@pytest.mark.parametrize("change", ["other text", "one more", "a link", "gone"])
def test_what_was_changed_is_not_ours(change, tmp_path):
    folder = put(tmp_path / "new", a="1", sub__c="2")
    write_manifest(folder, tmp_path / "goal")
    path = folder / "sub" / ("d" if change == "one more" else "c")
    if change in ("a link", "gone"):
        path.unlink()
    if change == "a link":
        path.symlink_to(folder / "a")
    elif change != "gone":
        path.write_text("3")
    assert not is_ours(folder, "sub") and is_ours(folder, "a")


@pytest.mark.parametrize("text", ["", "[1]", '{"files": [1]}', '{"files": 3}', "[" * 100_000, '{"name": "a page"}'])
def test_what_is_no_manifest_says_nothing_is_ours(text, tmp_path):
    (tmp_path / MANIFEST).write_text(text)
    (tmp_path / "a").write_text("1")
    assert read_manifest(tmp_path) == {} and not is_ours(tmp_path, "a") and not is_ours(tmp_path, MANIFEST)


def test_a_manifest_is_strict_json(tmp_path):
    new = put(tmp_path / "new", a="1")
    write_manifest(new, tmp_path / "goal")
    assert set(json.loads((new / MANIFEST).read_text(), parse_constant=pytest.fail)) == {"cranio_nb", "digest", "files"}
