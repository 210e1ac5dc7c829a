"""Lessons run: notebooks made from their texts, and compared with them.

The texts (see `lesson_text`) are all that is edited. A notebook is made by running its text in static mode, so that
it shows every picture where no kernel runs; the same text gives the same file, byte for byte.
"""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from nbformat import NotebookNode

from ..errors import InputRefused
from ..output.staging import replace_file
from .lesson_text import METADATA, cell_ids, read_lesson, tags
from .student_copy import exercise_copy

_DRAWN = re.compile(r"data:image/png;base64,[A-Za-z0-9+/=]+")
"""A picture within a text: what an exercise is expected to draw."""
QUIET = {"CRANIO_NB_MODE": "static", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "TQDM_DISABLE": "1"}
"""Environment of a kernel that runs lessons: pictures instead of panels, one thread, no progress bars."""
_TIMEOUT = 300  # s for one cell


def build(folder: Path, only: str = "") -> list[Path]:
    """Make every notebook of a folder anew.

    Parameters
    ----------
    folder : path
        Holds ``src/NN_topic.py``; gets ``NN_topic.ipynb`` and ``exercises/NN_topic.ipynb``.
    only : str
        Only texts whose name starts so, e.g. "04".

    Returns
    -------
    list of Path
        The notebooks.

    Raises
    ------
    InputRefused
        ``NoLessons``; ``BadLesson`` where a text breaks the rules of `lesson_text` or a cell fails.
    CannotWrite
        Where the system refuses.
    """
    made = []
    for path, notebook in _notebooks(folder, only):
        nbformat.validate(notebook)
        replace_file(path, (nbformat.writes(notebook) + "\n").encode())
        made.append(path)
    return made


def is_built(path: Path) -> bool:
    """Whether a notebook is as `build` made it, but for its outputs: nobody wrote into its cells.

    Parameters
    ----------
    path : path

    Returns
    -------
    bool
        False also for what is no notebook.
    """
    try:
        cells = nbformat.read(path, as_version=4).cells
        return [cell.get("id") for cell in cells] == cell_ids(cells)
    except Exception:  # whatever a damaged file makes the reader raise
        return False


def out_of_step(folder: Path, only: str = "") -> list[str]:
    """What differs between the notebooks of a folder and what their texts give now, one line each.

    Texts, tags, descriptions and written output are compared; pictures are not, for another machine may draw a pixel
    otherwise.

    Parameters
    ----------
    folder, only
        As for `build`.

    Returns
    -------
    list of str
        Empty where all is in step.
    """
    problems = []
    for path, wanted in _notebooks(folder, only):
        name = path.relative_to(folder)
        if not path.is_file():
            problems.append(f"{name} is missing")
        elif _comparable(nbformat.read(path, as_version=4)) != _comparable(wanted):
            problems.append(f"{name} is not what its text gives; run `cranio-nb lessons build`")
    return problems


def execute(notebook: NotebookNode) -> NotebookNode:
    """The notebook with its outputs, run from the first cell to the last in a fresh kernel in static mode.

    Parameters
    ----------
    notebook : NotebookNode
        As `read_lesson` gives it.

    Returns
    -------
    NotebookNode
        The same one.

    Raises
    ------
    InputRefused
        ``BadLesson`` where a cell fails that should not, or one does not that should.
    """
    with tempfile.TemporaryDirectory() as folder:
        client = NotebookClient(
            notebook,
            timeout=_TIMEOUT,
            kernel_name="python3",
            record_timing=False,
            coalesce_streams=True,
            resources={"metadata": {"path": folder}},
        )
        try:
            client.execute(env={**os.environ, **QUIET})
        except CellExecutionError as error:
            raise InputRefused("BadLesson", f"A cell fails that should not: {error.ename}: {error.evalue}") from None
    for cell in notebook.cells:
        failed = [output for output in cell.get("outputs", ()) if output.output_type == "error"]
        if ("raises-exception" in tags(cell)) != bool(failed):
            raise InputRefused("BadLesson", f"A cell declares a mistake that does not fail: {cell.source[:60]!r}.")
        for output in failed:
            output.traceback = [f"{output.ename}: {output.evalue}"]  # without the places of files on this machine
    notebook.metadata = nbformat.from_dict(METADATA)
    return notebook


def _notebooks(folder: Path, only: str) -> Iterator[tuple[Path, NotebookNode]]:
    """Each lesson as its text gives it now, executed, and its copy for students, with the files they belong in."""
    for source in _sources(folder, only):
        lesson = execute(read_lesson(source))
        copy = exercise_copy(lesson)  # before either is handed on: a lesson without a copy is not written
        yield folder / f"{source.stem}.ipynb", lesson
        yield folder / "exercises" / f"{source.stem}.ipynb", copy


def _sources(folder: Path, only: str) -> list[Path]:
    """The texts of a folder, in the order of their names."""
    found = sorted((folder / "src").glob(f"{only}*.py"))
    if not found:
        message = f"No lesson texts were found in {folder.name}/src."
        raise InputRefused(
            "NoLessons",
            message,
            "The texts are in the project's repository: run this there, or name its folder of notebooks.",
        )
    return found


def _comparable(notebook: NotebookNode) -> list[Any]:
    """What must be the same on every machine."""
    found = []
    for cell in notebook.cells:
        written: list[Any] = []
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            alts = {kind: output.metadata[kind].get("alt") for kind in data if kind in output.get("metadata", {})}
            written.append((output.output_type, output.get("text"), output.get("ename"), data.get("text/plain"), alts))
        source = _DRAWN.sub("", cell.source)
        name = cell.id if source == cell.source else ""  # it follows from the text, and so from a picture in it
        found.append((name, cell.cell_type, source, tags(cell), cell.get("execution_count"), written))
    return found
