"""The group of all commands: help, weight, and how an error ends."""

import os
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


@pytest.mark.skipif(sys.platform == "win32", reason="pipes of Windows are not closed in the same way")
def test_who_has_read_enough_hears_of_no_error(tmp_path):
    """As `cranio-nb phantom | head -0` does: the output is closed before anything is written to it."""
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-m", "cranio_nb", "phantom", str(tmp_path / "head"), "--size", "tiny"]
    done = subprocess.run(command, stdout=writer, stderr=subprocess.PIPE, text=True, timeout=60, check=False)
    os.close(writer)
    assert done.stderr == "" and done.returncode == 1


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


@pytest.mark.parametrize(("asked", "used"), [(None, 1), ("2", min(2, os.cpu_count() or 1))])
def test_blas_has_one_thread_unless_more_are_asked_for(asked, used):
    program = (
        "from click.testing import CliRunner; from cranio_nb.cli.main import main\n"
        "assert CliRunner().invoke(main, ['methods']).exit_code == 0\n"
        "import numpy.linalg, scipy.linalg; from threadpoolctl import threadpool_info\n"
        "print({one['num_threads'] for one in threadpool_info() if one['user_api'] == 'blas'})"
    )
    environment = {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}
    environment |= {"OPENBLAS_NUM_THREADS": asked} if asked else {}
    told = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True)
    assert told.stdout.strip() == f"{{{used}}}"
