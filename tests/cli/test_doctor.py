"""The command `doctor`: one line for each thing, and an exit code."""

import pytest
from cli_runs import cranio

from cranio_nb.cli import examination
from cranio_nb.cli.examination import Check


def test_doctor_finds_what_is_needed():
    result = cranio("doctor")
    lines = result.stdout.splitlines()
    assert result.exit_code == 0 and any(line.startswith("ok       pictures") for line in lines)
    assert all(line.split()[0] in ("ok", "optional") for line in lines)


@pytest.mark.parametrize(("state", "code"), [("ok", 0), ("optional", 0), ("missing", 1)])
def test_only_what_is_needed_and_missing_is_a_failure(state, code, monkeypatch):
    monkeypatch.setattr(examination, "examine", lambda: iter([Check("thing", state, "nothing", "Get one.")]))
    result = cranio("doctor")
    assert result.exit_code == code and result.stdout == f"{state:8} thing: nothing. Get one.\n"
