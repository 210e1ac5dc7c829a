"""What the machine has, told apart from what it lacks, with a remedy."""

import builtins
import io
import subprocess

import pytest

from cranio_nb.cli import examination


def test_what_is_missing_is_told_with_its_remedy():
    check = examination._package("no-such-package", "missing", "pip install it")
    assert (check.state, check.found, check.remedy) == ("missing", "not installed", "pip install it")
    assert examination._package("numpy", "missing", "pip install it").remedy == ""


def test_free_memory_is_read_from_the_system(monkeypatch):
    monkeypatch.setattr(builtins, "open", lambda *a: io.StringIO("MemTotal: 9 kB\nMemAvailable: 3000000 kB\n"))
    assert examination.free_memory_gb() == 3.0 and examination._memory().state == "ok"
    monkeypatch.setattr(builtins, "open", lambda *a: io.StringIO("MemAvailable: 1000000 kB\n"))
    assert examination._memory().state == "missing" and "2 GB" in examination._memory().remedy


@pytest.mark.parametrize("text", ["", "MemTotal: 9 kB\n", "MemAvailable: many\n"])
def test_a_system_that_does_not_say_is_no_fault(text, monkeypatch):
    monkeypatch.setattr(builtins, "open", lambda *a: io.StringIO(text))
    assert examination.free_memory_gb() is None and examination._memory().state == "ok"


@pytest.mark.parametrize(
    ("code", "state"), [("pass", "ok"), ("raise SystemExit(3)", "missing"), ("import os; os.abort()", "missing")]
)
def test_a_crash_while_drawing_harms_nobody(code, state):
    assert examination._drawing("pictures", code, "missing", "Mend it.").state == state


def test_drawing_that_never_ends_is_ended(monkeypatch):
    def never(*_, timeout, **__):
        raise subprocess.TimeoutExpired("python", timeout)

    monkeypatch.setattr(examination.subprocess, "run", never)
    assert examination._drawing("pictures", "", "optional", "Mend it.").state == "optional"
