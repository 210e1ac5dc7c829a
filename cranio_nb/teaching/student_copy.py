"""An executed lesson -> the copy that a student fills in."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence
from typing import Any

from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_markdown_cell

from ..errors import InputRefused
from .lesson_text import make_notebook, tags

_TO_STUDENTS = (
    "*This is the copy to work in. Run the cells from the top. Where you meet `raise NotImplementedError`, put your "
    "own lines in its place, then run the check below it. Solutions and expected pictures are folded away: try first. "
    "The whole lesson, solved, is the notebook of the same name in the folder above.*"
)
_NUMBER = re.compile(r"check\.exercise\(\"(\d+\.\d+)\"")


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
            solution, text = text, make_stub(text, exercise_number(lesson.cells, cell))
        cells += student_cells(cell, text)
        if "check" in tags(cell):
            cells.append(_folded("Solution", f"```python\n{solution}\n```"))
    return make_notebook(cells)


def student_cells(cell: NotebookNode, text: str) -> list[NotebookNode]:
    """A cell of code as a student gets it: without outputs, with the expected picture folded away below it.

    Parameters
    ----------
    cell : NotebookNode
        Of the executed lesson.
    text : str
        What stands in it for the student.

    Returns
    -------
    list of NotebookNode
    """
    copy = new_code_cell(text, metadata=_student_tags(cell))
    return [copy, _expected(cell)] if "expected" in tags(cell) else [copy]


def exercise_number(cells: Sequence[NotebookNode], solution: NotebookNode) -> str:
    """Number of the exercise that a solution belongs to: that of the first check after it.

    Parameters
    ----------
    cells : sequence of NotebookNode
        Of the lesson.
    solution : NotebookNode
        One of them.

    Returns
    -------
    str

    Raises
    ------
    InputRefused
        ``BadLesson`` where no check follows.
    """
    at = next(i for i, cell in enumerate(cells) if cell is solution)
    later = (_NUMBER.search(cell.source) for cell in cells[at:] if "check" in tags(cell))
    found = next((hit for hit in later if hit), None)
    if found is None:
        raise InputRefused("BadLesson", "A solution has no check after it.")
    return found[1]


def make_stub(solution: str, number: str) -> str:
    r"""The function's head and docstring, and nothing in it.

    Parameters
    ----------
    solution : str
        Text of one function with a docstring.
    number : str
        Of the exercise.

    Returns
    -------
    str

    Examples
    --------
    >>> print(make_stub('def twice(x):\n    "Two times x."\n    return 2 * x', "4.1"))
    def twice(x):
        "Two times x."
        raise NotImplementedError("Exercise 4.1")
    """
    head, _ = split_solution(solution)
    return f'{head}\n    raise NotImplementedError("Exercise {number}")'


def split_solution(solution: str) -> tuple[str, str]:
    r"""Head and docstring of a solution's function, and its body.

    Parameters
    ----------
    solution : str
        Text of one function with a docstring.

    Returns
    -------
    tuple of str

    Examples
    --------
    >>> split_solution('def twice(x):\n    "Two times x."\n    return 2 * x')
    ('def twice(x):\n    "Two times x."', '    return 2 * x')
    """
    (function,) = ast.parse(solution).body
    assert isinstance(function, ast.FunctionDef)
    lines, end = solution.splitlines(), function.body[0].end_lineno
    return "\n".join(lines[:end]), "\n".join(lines[end:])


def _student_tags(cell: NotebookNode) -> dict[str, Any]:
    """Tags of the student's cell: what draws with a function not yet written may fail without stopping the rest."""
    kept = [tag for tag in tags(cell) if tag != "solution"]
    if "expected" in kept:
        kept.append("raises-exception")
    return {"tags": kept} if kept else {}


def _expected(cell: NotebookNode) -> NotebookNode:
    """The picture that a cell should draw, folded away; JupyterLab asks for an attachment before it knows of it."""
    shown = next(output for output in cell.outputs if "image/png" in output.get("data", {}))
    alt = shown.metadata["image/png"]["alt"]
    png = shown.data["image/png"].replace("\n", "")
    return _folded("Expected picture", f"![{alt}](data:image/png;base64,{png})")


def _folded(title: str, text: str) -> NotebookNode:
    return new_markdown_cell(f"<details>\n<summary>{title}</summary>\n\n{text}\n\n</details>")
