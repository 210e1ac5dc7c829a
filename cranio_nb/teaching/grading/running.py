"""A notebook that somebody hands in -> the same with its outputs, whatever is in it.

Nothing a notebook does ends the program that runs it: cells that fail count for nothing, cells that do not end are
interrupted, a flood of outputs is cut off, and a kernel that dies leaves what was there before.
"""

from __future__ import annotations

import logging
import os
import subprocess
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_notebook

from ..build import QUIET

CELL_S, NOTEBOOK_S = 300, 1200
"""Time for a cell, and for a notebook, after which each cell left gets a second only."""
_MOST_OUTPUTS = 1000  # of a cell
_SILENT = logging.getLogger(__name__)  # cells that fail are the student's affair, and are told in the verdicts
_SILENT.disabled = True
_TIMED_OUT = {"ename": "TimeoutError", "evalue": f"it did not end within {CELL_S} s", "traceback": []}


def read_hand_in(path: Path) -> tuple[NotebookNode, str]:
    """The code of a notebook from disk, of any version; nothing else of it can then do harm.

    Parameters
    ----------
    path : path

    Returns
    -------
    notebook : NotebookNode
        Of the cells of code alone, without outputs and tags; of none where the file cannot be read.
    remark : str
        Why it cannot; else empty.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # cells without ids, as older notebooks have them
            given = nbformat.reads(path.read_text(encoding="utf-8"), as_version=4)
        texts = [cell.source for cell in given.cells if cell.cell_type == "code"]
        notebook = new_notebook(cells=[new_code_cell(text) for text in texts])
        nbformat.validate(notebook)
        return notebook, ""
    except Exception as error:  # whatever a damaged file makes the reader raise
        return new_notebook(), f"The file cannot be read as a notebook ({type(error).__name__})."


def run_hand_in(notebook: NotebookNode) -> str:
    """Run a notebook from its first cell to its last, in a new kernel and a new folder.

    Parameters
    ----------
    notebook : NotebookNode
        Gets its outputs.

    Returns
    -------
    str
        What kept some of its cells from being run; else empty.
    """
    end = time.monotonic() + NOTEBOOK_S
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        client = _Client(
            notebook,
            timeout_func=lambda cell: max(1, min(CELL_S, int(end - time.monotonic()))),
            interrupt_on_timeout=True,
            error_on_timeout=_TIMED_OUT,
            allow_errors=True,
            kernel_name="python3",
            resources={"metadata": {"path": folder}},
            log=_SILENT,
        )
        try:
            # what the kernel itself says to its terminal is not the teacher's business
            client.execute(env={**os.environ, **QUIET}, stderr=subprocess.DEVNULL)
        except Exception as error:  # a dead kernel, cells that cannot be sent, and what else there may be
            return f"The notebook could not be run to its end ({type(error).__name__})."
    return ""


class _Client(NotebookClient):
    """Runs a notebook, and keeps no more than so many outputs of a cell."""

    def output(self, outs: list[NotebookNode], msg: dict[str, Any], display_id: Any, cell_index: int) -> Any:
        """Keep an output, unless there are too many already."""
        return super().output(outs, msg, display_id, cell_index) if len(outs) < _MOST_OUTPUTS else None
