"""The command `lab` hands over what it was given, and the exit code back."""

from pathlib import Path

import pytest
from cli_runs import cranio

from cranio_nb.teaching.lab import start


@pytest.mark.parametrize("code", [0, 3])
def test_lab_is_opened_as_asked(code, monkeypatch):
    asked = []
    monkeypatch.setattr(start, "open_lab", lambda folder, **options: asked.append((folder, options)) or code)
    assert cranio("lab", "lessons", "--no-browser", "--port", "9000").exit_code == code
    assert asked == [(Path("lessons"), {"browser": False, "port": 9000})]


def test_by_default_a_browser_is_opened(monkeypatch):
    asked = []
    monkeypatch.setattr(start, "open_lab", lambda folder, **options: asked.append((folder, options)) or 0)
    cranio("lab")
    assert asked == [(None, {"browser": True, "port": None})]
