"""Run pytest with a notebook plugin over notebooks, as a reader of the documentation would, in a process of its own."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
LESSONS = sorted((ROOT / "notebooks").glob("*.ipynb"))
EXERCISES = sorted((ROOT / "notebooks" / "exercises").glob("*.ipynb"))


def run(arguments, notebooks, folder, **environment):
    """Standard output and exit code of pytest over notebooks, without this suite's own settings."""
    settings = folder / "pytest.ini"
    settings.write_text("[pytest]\n")
    inherited = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    quiet = {"CRANIO_NB_MODE": "static", "OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "pytest", "-q", "-c", str(settings), "--rootdir", str(ROOT)]
    made = subprocess.run(
        [*command, "-p", "no:cacheprovider", "-p", "no:xdist", *arguments, *map(str, notebooks)],
        env=inherited | quiet | environment,
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    return made.stdout + made.stderr[-2000:], made.returncode
