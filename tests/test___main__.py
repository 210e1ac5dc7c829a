"""`python -m cranio_nb` is the command line by another name."""

import subprocess
import sys

from cli_runs import cranio


def test_it_says_what_the_command_says():
    asked = [sys.executable, "-m", "cranio_nb", "design", "--help"]
    told = subprocess.run(asked, capture_output=True, text=True, check=True)
    usage, *words = told.stdout.splitlines()
    assert usage == "Usage: cranio-nb design [OPTIONS] INPUT"
    assert " ".join(words).split() == " ".join(cranio("design", "--help").output.splitlines()[1:]).split()
