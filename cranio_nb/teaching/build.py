"""Lesson texts (`src/NN_topic.py`, jupytext percent) -> executed notebooks, and the copies that students fill in.

The texts are all that is edited. A notebook is made by running its text in static mode, so that it shows every
picture where no kernel runs; the same text gives the same file, byte for byte.

Tags of a cell say what it is: ``solution`` (one function; the student's copy holds its head and a stub), ``check``
(calls `check.exercise`), ``expected`` (draws with the student's function), ``raises-exception`` (a mistake shown on
purpose). A cell whose text output is compared in tests starts with ``# NBVAL_CHECK_OUTPUT``.
"""

from __future__ import annotations

import ast
import hashlib
import os
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jupytext
import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_markdown_cell

from ..errors import CannotWrite, InputRefused

_METADATA = {
    "kernelspec": {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"},
    "language_info": {"file_extension": ".py", "mimetype": "text/x-python", "name": "python"},
}
_QUIET = {"CRANIO_NB_MODE": "static", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "TQDM_DISABLE": "1"}
_TO_STUDENTS = (
    "*This is the copy to work in. Run the cells from the top. Where you meet `raise NotImplementedError`, put your "
    "own lines in its place, then run the check below it. Solutions and expected pictures are folded away: try first.*"
)
_SET_UP = """# On Colab this installs the package; elsewhere it does nothing. SOURCE is what pip can take:
# the package's name, a wheel that you uploaded, or "git+" and the project's address.
SOURCE = "cranio-nb"
import subprocess, sys

if "google.colab" in sys.modules:
    command = [sys.executable, "-m", "pip", "install", "-q", f"{SOURCE}[view]", "ipywidgets"]
    subprocess.run(command, check=True)"""
_TIMEOUT = 300  # s for one cell
_NUMBER = re.compile(r"check\.exercise\(\"(\d+\.\d+)\"")
_POINTS = re.compile(r"Exercise ([\d.]+): (\d+) of (\d+) points")


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
        ``NoLessons``; ``BadLesson`` where a text breaks the rules above or a cell fails.
    """
    made = []
    for path, notebook in _notebooks(folder, only):
        _write(path, notebook)
        made.append(path)
    return made


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


def read(source: Path) -> NotebookNode:
    """A lesson text as a notebook without outputs, with a cell for Colab; ids follow from the cells' text.

    Parameters
    ----------
    source : path
        A script in Jupytext's percent format.

    Returns
    -------
    NotebookNode

    Raises
    ------
    InputRefused
        ``BadLesson`` where a solution is not one function with a docstring.
    """
    notebook = jupytext.read(source, fmt="py:percent")
    cells = [
        (new_markdown_cell if cell.cell_type == "markdown" else new_code_cell)(
            cell.source, metadata={"tags": cell.metadata["tags"]} if cell.metadata.get("tags") else {}
        )
        for cell in notebook.cells
    ]
    _check_solutions(source.stem, cells)
    return _notebook([cells[0], new_code_cell(_SET_UP), *cells[1:]])


def execute(notebook: NotebookNode) -> NotebookNode:
    """The notebook with its outputs, run from the first cell to the last in a fresh kernel in static mode.

    Parameters
    ----------
    notebook : NotebookNode
        As `read` gives it.

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
            client.execute(env={**os.environ, **_QUIET})
        except CellExecutionError as error:
            raise InputRefused("BadLesson", f"A cell fails that should not: {error.ename}: {error.evalue}") from None
    for cell in notebook.cells:
        failed = [output for output in cell.get("outputs", ()) if output.output_type == "error"]
        if ("raises-exception" in tags(cell)) != bool(failed):
            raise InputRefused("BadLesson", f"A cell declares a mistake that does not fail: {cell.source[:60]!r}.")
        for output in failed:
            output.traceback = [f"{output.ename}: {output.evalue}"]  # without the places of files on this machine
    notebook.metadata = nbformat.from_dict(_METADATA)
    return notebook


def points(path: Path) -> dict[str, tuple[int, int]]:
    """Run a notebook that a student hands in, and read off its checks.

    Cells that fail count for nothing and do not stop the rest.

    Parameters
    ----------
    path : path

    Returns
    -------
    dict of str to (int, int)
        Number of the exercise -> points, and points to be had.

    Raises
    ------
    InputRefused
        ``NotFound``.
    """
    if not path.is_file():
        raise InputRefused("NotFound", f"There is no notebook {path.name}.")
    notebook = nbformat.read(path, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        resources = {"metadata": {"path": folder}}
        client = NotebookClient(
            notebook, timeout=_TIMEOUT, kernel_name="python3", allow_errors=True, resources=resources
        )
        client.execute(env={**os.environ, **_QUIET})
    shown = [
        output.get("data", {}).get("text/plain", "") for cell in notebook.cells for output in cell.get("outputs", ())
    ]
    found = (_POINTS.match(line) for line in shown)
    return {hit[1]: (int(hit[2]), int(hit[3])) for hit in found if hit}


def exercise_copy(lesson: NotebookNode) -> NotebookNode:
    """The copy that a student fills in: stubs for solutions, no outputs, expected pictures and answers folded away.

    Parameters
    ----------
    lesson : NotebookNode
        Executed.

    Returns
    -------
    NotebookNode
    """
    first, *rest = lesson.cells
    cells = [new_markdown_cell(first.source), new_markdown_cell(_TO_STUDENTS)]
    solution = ""
    for cell in rest:
        if cell.cell_type == "markdown":
            cells.append(new_markdown_cell(cell.source))
            continue
        text = cell.source
        if "solution" in tags(cell):
            solution, text = text, _stub(text, _next_number(lesson.cells, cell))
        copy = new_code_cell(text, metadata=_student_tags(cell))
        cells.append(copy)
        if "expected" in tags(cell):
            cells.append(_expected(cell))
        if "check" in tags(cell):
            cells.append(_folded("Solution", f"```python\n{solution}\n```"))
    return _notebook(cells)


def tags(cell: NotebookNode) -> list[str]:
    """Tags of a cell.

    Parameters
    ----------
    cell : NotebookNode

    Returns
    -------
    list of str

    Examples
    --------
    >>> tags(new_code_cell("1 / 0", metadata={"tags": ["raises-exception"]}))
    ['raises-exception']
    """
    return list(cell.metadata.get("tags", []))


def _notebooks(folder: Path, only: str) -> Iterator[tuple[Path, NotebookNode]]:
    """Each lesson as its text gives it now, executed, and its copy for students, with the files they belong in."""
    for source in _sources(folder, only):
        lesson = execute(read(source))
        yield folder / f"{source.stem}.ipynb", lesson
        yield folder / "exercises" / f"{source.stem}.ipynb", exercise_copy(lesson)


def _sources(folder: Path, only: str) -> list[Path]:
    """The texts of a folder, in the order of their names."""
    found = sorted((folder / "src").glob(f"{only}*.py"))
    if not found:
        message = f"No lesson texts were found in {folder.name}/src."
        raise InputRefused("NoLessons", message, "Run this in the project's folder, or name the folder of notebooks.")
    return found


def _notebook(cells: list[NotebookNode]) -> NotebookNode:
    """A notebook whose ids are the same whenever its cells are."""
    seen: dict[str, int] = {}
    for cell in cells:
        n = seen[cell.source] = seen.get(cell.source, 0) + 1
        cell.id = hashlib.sha256(f"{n} {cell.cell_type} {cell.source}".encode()).hexdigest()[:12]
    return nbformat.v4.new_notebook(cells=cells, metadata=_METADATA)


def _check_solutions(name: str, cells: list[NotebookNode]) -> None:
    """Refuse a solution that is not one documented function."""
    for cell in cells:
        if "solution" in tags(cell):
            body = ast.parse(cell.source).body
            if len(body) != 1 or not isinstance(body[0], ast.FunctionDef) or not ast.get_docstring(body[0]):
                raise InputRefused("BadLesson", f"A solution of {name} is not just one function with a docstring.")


def _next_number(cells: list[NotebookNode], solution: NotebookNode) -> str:
    """Number of the exercise that a solution belongs to: that of the first check after it."""
    at = next(i for i, cell in enumerate(cells) if cell is solution)
    later = (_NUMBER.search(cell.source) for cell in cells[at:] if "check" in tags(cell))
    found = next((hit for hit in later if hit), None)
    if found is None:
        raise InputRefused("BadLesson", "A solution has no check after it.")
    return found[1]


def _stub(solution: str, number: str) -> str:
    """The function's head and docstring, and nothing in it."""
    (function,) = ast.parse(solution).body
    assert isinstance(function, ast.FunctionDef)
    head = solution.splitlines()[: function.body[0].end_lineno]
    return "\n".join([*head, f'    raise NotImplementedError("Exercise {number}")'])


def _student_tags(cell: NotebookNode) -> dict[str, Any]:
    """Tags of the student's cell: what draws with a function not yet written may fail without stopping the rest."""
    kept = [tag for tag in tags(cell) if tag != "solution"]
    if "expected" in kept:
        kept.append("raises-exception")
    return {"tags": kept} if kept else {}


def _expected(cell: NotebookNode) -> NotebookNode:
    """The picture that a cell should draw, folded away."""
    shown = next(output for output in cell.outputs if "image/png" in output.get("data", {}))
    alt = shown.metadata["image/png"]["alt"]
    folded = _folded("Expected picture", f"![{alt}](attachment:expected.png)")
    folded.attachments = {"expected.png": {"image/png": shown.data["image/png"].replace("\n", "")}}
    return folded


def _folded(title: str, text: str) -> NotebookNode:
    return new_markdown_cell(f"<details>\n<summary>{title}</summary>\n\n{text}\n\n</details>")


def _comparable(notebook: NotebookNode) -> list[Any]:
    """What must be the same on every machine."""
    found = []
    for cell in notebook.cells:
        written: list[Any] = []
        for output in cell.get("outputs", ()):
            data = output.get("data", {})
            alts = {kind: output.metadata[kind].get("alt") for kind in data if kind in output.get("metadata", {})}
            written.append((output.output_type, output.get("text"), output.get("ename"), data.get("text/plain"), alts))
        found.append((cell.id, cell.cell_type, cell.source, tags(cell), cell.get("execution_count"), written))
    return found


def _write(path: Path, notebook: NotebookNode) -> None:
    """Write a notebook whole or not at all."""
    nbformat.validate(notebook)
    part = path.with_name(f".{path.name}.part")
    try:
        path.parent.mkdir(exist_ok=True)
        part.write_text(nbformat.writes(notebook) + "\n", encoding="utf-8")
        os.replace(part, path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise CannotWrite("CannotWrite", f"{path.name} could not be written ({type(error).__name__}).") from None
