"""Files that belong together get to their folder together, or none does."""

import pytest

from cranio_nb.errors import CannotWrite
from cranio_nb.output.staging import staged


def fill(part):
    (part / "a.txt").write_text("new")
    (part / "sub").mkdir()
    (part / "sub" / "b.txt").write_text("new")


def contents(folder):
    """Texts of a folder, without the manifests."""
    files = [p for p in folder.rglob("*") if p.is_file() and p.name != "manifest.json"]
    return {str(p.relative_to(folder)): p.read_text() for p in files}


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
    assert {p.name for p in tmp_path.iterdir()} == {"mine.txt", "a.txt", "sub", "manifest.json"}


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
