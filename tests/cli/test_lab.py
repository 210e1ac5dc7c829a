"""The command `lab` hands over what it was given, and the exit code back."""

import pytest
from cli_runs import cranio

from cranio_nb.teaching.lab import start
from cranio_nb.teaching.shipped import TOUR


@pytest.fixture
def asked(monkeypatch, tmp_path):
    """What the command asks for, in a folder with lessons."""
    found = []
    monkeypatch.setattr(start, "open_lab", lambda folder, **options: found.append((folder, options)) or 3)
    monkeypatch.chdir(tmp_path)
    (tmp_path / TOUR).write_text("{}")
    return found


def test_lab_is_opened_as_asked(asked, tmp_path):
    result = cranio("lab", tmp_path, "--no-browser", "--port", "9000")
    assert (result.exit_code, result.stdout) == (3, "")
    assert asked == [(tmp_path, {"browser": False, "port": 9000, "allow_root": False})]


def test_by_default_a_browser_is_opened(asked):
    cranio("lab")
    assert asked == [(None, {"browser": True, "port": None, "allow_root": False})]


def test_students_are_told_where_to_work_and_where_the_solved_lessons_are(asked, tmp_path):
    (tmp_path / "exercises").mkdir()
    (tmp_path / "exercises" / TOUR).write_text("{}")
    said = cranio("lab").stdout
    assert str(tmp_path.resolve() / "exercises") in said and f"solved: {tmp_path.resolve()}." in said
