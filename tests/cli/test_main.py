"""The group of all commands: help, weight, and how an error ends."""

import subprocess
import sys

import pytest
from cli_runs import assert_refused, cranio

from cranio_nb.cli.main import main
from cranio_nb.pipeline import preparation


def test_unforeseen_errors_are_one_sentence_and_debug_shows_them(home, tmp_path, monkeypatch):
    def broken(*_: object, **__: object) -> None:
        raise RuntimeError("secret name")

    monkeypatch.setattr(preparation, "prepare", broken)
    arguments = ("design", home / "ct", "--out", tmp_path / "out")
    plain = cranio(*arguments)
    assert_refused(plain, 1, "--debug")
    assert "secret" not in plain.stderr
    assert isinstance(cranio("--debug", *arguments).exception, RuntimeError)
    assert isinstance(cranio(*arguments, "--debug").exception, RuntimeError)


@pytest.mark.parametrize("command", [(), *[(name,) for name in sorted(main.commands)]], ids=str)
def test_every_command_has_help_with_examples(command):
    result = cranio(*command, "--help")
    examples = result.stdout.split("Example")[1].split("\n\n")[0].splitlines()[1:]
    assert result.exit_code == 0 and examples
    assert all(line.strip().startswith("cranio-nb ") for line in examples)  # each on a line of its own


def test_import_and_help_load_nothing_heavy():
    code = (
        "import sys, cranio_nb.cli.main\n"
        "try: cranio_nb.cli.main.main(['design', '--help'])\n"
        "except SystemExit: pass\n"
        "heavy = {'matplotlib', 'vtkmodules', 'pyvista', 'anywidget', 'scipy', 'skimage'} & set(sys.modules)\n"
        "sys.exit(','.join(heavy) or 0)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr


def commands(group=main, path=()):
    """Every command with the words it is called by."""
    for name, command in group.commands.items():
        here = (*path, name)
        yield from commands(command, here) if hasattr(command, "commands") else [here]


@pytest.mark.parametrize("command", [*commands()], ids=" ".join)
def test_debug_can_follow_every_command(command):
    assert "--debug" in cranio(*command, "--help").stdout
