"""Commands as a user runs them, and what a refusal looks like."""

import hashlib
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from cranio_nb.cli.main import main
from cranio_nb.output import design_folder
from cranio_nb.pipeline import preparation, run
from cranio_nb.prosthesis import Prosthesis

OUTPUTS = {"prosthesis.stl", "patch.nii.gz", "design.json", "report.html", "manifest.json"}


def cranio(*arguments: object) -> Result:
    """Run a command."""
    return CliRunner().invoke(main, [str(a) for a in arguments])


def run_is(result: run.RunResult, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let commands find this result, where only the writing is looked at."""

    def found(*_: object, designed: Callable[[Prosthesis], None], **__: object) -> run.RunResult:
        designed(result.prosthesis)
        return result

    monkeypatch.setattr(preparation, "prepare", lambda *a, **k: result.case)
    monkeypatch.setattr(design_folder, "run_design", found)


def digest(folder: Path) -> dict[str, str]:
    """Hash of every file below a folder."""
    files = sorted(p for p in folder.rglob("*") if p.is_file())
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest() for p in files}


def assert_refused(result: Result, code: int, *words: str) -> None:
    """One sentence on stderr, nothing on stdout, no traceback, no full path."""
    assert result.exit_code == code, result.output
    assert result.stdout == ""
    assert result.stderr.startswith("cranio-nb: ") and result.stderr.count("\n") == 1
    assert "Traceback" not in result.stderr and "/" not in result.stderr.replace("0/1", "")
    for word in words:
        assert word in result.stderr
