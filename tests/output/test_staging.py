"""Files that belong together get to their folder together, or none does."""

import os

import pytest

from cranio_nb.errors import CannotWrite
from cranio_nb.output.staging import check_folder, staged


def fill(part):
    (part / "a.txt").write_text("new")
    (part / "sub").mkdir()
    (part / "sub" / "b.txt").write_text("new")


def contents(folder):
    return {str(p.relative_to(folder)): p.read_text() for p in folder.rglob("*") if p.is_file()}


def test_a_folder_is_made_with_its_parents(tmp_path):
    with staged(tmp_path / "x" / "y") as part:
        fill(part)
        assert not (tmp_path / "x" / "y").exists()
    assert contents(tmp_path) == {"x/y/a.txt": "new", "x/y/sub/b.txt": "new"}


def test_what_is_not_ours_stays_and_what_is_ours_is_replaced(tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    (tmp_path / "a.txt").write_text("old")
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "old.txt").write_text("old")
    with staged(tmp_path) as part:
        fill(part)
    assert contents(tmp_path) == {"mine.txt": "mine", "a.txt": "new", "sub/b.txt": "new"}
    assert {p.name for p in tmp_path.iterdir()} == {"mine.txt", "a.txt", "sub"}


@pytest.mark.parametrize("there", [False, True])
def test_a_failure_leaves_everything_as_it_was(tmp_path, there):
    goal = tmp_path / "x" / "y"
    if there:
        goal.mkdir(parents=True)
        (goal / "a.txt").write_text("old")
    before = contents(tmp_path)
    with pytest.raises(ZeroDivisionError), staged(goal) as part:
        fill(part)
        raise ZeroDivisionError
    assert contents(tmp_path) == before and (tmp_path / "x").exists() == there


def test_a_system_that_refuses_is_told_in_words_without_the_path(tmp_path):
    with pytest.raises(CannotWrite) as refusal, staged(tmp_path / "out"):
        raise OSError(28, "No space left on device", str(tmp_path))
    assert "No space left" in str(refusal.value) and str(tmp_path) not in str(refusal.value)
    assert list(tmp_path.iterdir()) == []


def test_a_check_makes_nothing(tmp_path):
    check_folder(tmp_path / "x" / "y", ("a.txt",))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("inside", ["", "deeper"])
def test_a_file_in_the_way_is_refused(tmp_path, inside):
    (tmp_path / "results").write_text("mine")
    with pytest.raises(CannotWrite, match="in the way") as refusal:
        check_folder(tmp_path / "results" / inside, ())
    assert str(tmp_path) not in str(refusal.value) and refusal.value.exit_code == 5


def test_a_folder_in_the_way_of_a_file_is_refused(tmp_path):
    (tmp_path / "design.json").mkdir()
    with pytest.raises(CannotWrite, match=r"design\.json is in the way"):
        check_folder(tmp_path, ("report.html", "design.json"))


def test_a_folder_that_may_not_be_written_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda *a: False)
    with pytest.raises(CannotWrite, match="not allowed"):
        check_folder(tmp_path / "results", ())
