"""An executed lesson -> an assignment of one of the tools, and all of them -> files."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import nbformat
from nbformat import NotebookNode
from nbformat.v4 import new_markdown_cell

from ...errors import InputRefused
from ...output.files import write_text
from ...output.staging import staged
from ..exercises import EXERCISES
from ..lesson_text import make_notebook, tags
from ..student_copy import exercise_number, student_cells

_ANSWER = re.compile(r"check\.exercise\(\"[\d.]+\", (\w+)\)")


@dataclass(frozen=True)
class Question:
    """An exercise as a tool is given it.

    Parameters
    ----------
    number : str
        E.g. "4.2".
    function : str
        Name of the student's function.
    points : int
    """

    number: str
    function: str
    points: int

    @property
    def key(self) -> str:
        """The number as part of a name.

        Returns
        -------
        str
        """
        return self.number.replace(".", "_")


@dataclass(frozen=True)
class Tool:
    """How a tool marks its cells.

    Parameters
    ----------
    answer : callable
        (question, text of the solution) -> the cells that the student fills in.
    check : callable
        question -> the cells that give the points.
    begin : callable
        Name of the lesson -> the cells at the top.
    place : str
        Where the notebook of a lesson belongs, with ``{lesson}`` for its name.
    files : dict of str to str
        Name -> text of what else belongs to the course.
    """

    answer: Callable[[Question, str], list[NotebookNode]]
    check: Callable[[Question], list[NotebookNode]]
    begin: Callable[[str], list[NotebookNode]]
    place: str
    files: dict[str, str]


def assignment(lesson: NotebookNode, name: str, tool: Tool) -> NotebookNode:
    """A lesson as an assignment.

    Parameters
    ----------
    lesson : NotebookNode
        Executed.
    name : str
        Of the lesson.
    tool : Tool

    Returns
    -------
    NotebookNode
        Solutions between the tool's marks; no outputs, expected pictures folded away.
    """
    cells = tool.begin(name)
    for cell in lesson.cells:
        if cell.cell_type == "markdown":
            cells.append(new_markdown_cell(cell.source))
        elif "solution" in tags(cell):
            cells += tool.answer(_question(lesson, cell), cell.source)
        elif "check" in tags(cell):
            cells += tool.check(_question(lesson, cell))
        else:
            cells += student_cells(cell, cell.source)
    return make_notebook(cells)


def write_assignments(folder: Path, out: Path, tool: Tool) -> list[Path]:
    """Write the lessons of a folder as assignments.

    Parameters
    ----------
    folder : path
        Holds ``NN_topic.ipynb``, executed.
    out : path
        Folder of the course.
    tool : Tool

    Returns
    -------
    list of Path

    Raises
    ------
    InputRefused
        ``NoLessons``.
    CannotWrite
        If the system refuses.
    """
    lessons = sorted(folder.glob("*.ipynb"))
    if not lessons:
        raise InputRefused("NoLessons", f"There are no notebooks in {folder.name}.", "Name the folder of the lessons.")
    texts = dict(tool.files)
    for path in lessons:
        made = assignment(nbformat.read(path, as_version=4), path.stem, tool)
        texts[tool.place.format(lesson=path.stem)] = nbformat.writes(made) + "\n"
    with staged(out) as part:
        for name, text in texts.items():
            (part / name).parent.mkdir(parents=True, exist_ok=True)
            write_text(part / name, text)
    return [out / name for name in texts]


def _question(lesson: NotebookNode, cell: NotebookNode) -> Question:
    """The exercise that a solution or a check belongs to."""
    number = exercise_number(lesson.cells, cell)
    check = next(c for c in lesson.cells if "check" in tags(c) and f'"{number}"' in c.source)
    found = _ANSWER.search(check.source)
    if found is None:
        raise InputRefused("BadLesson", f"The check of exercise {number} names no function.")
    return Question(number, found[1], len(EXERCISES[number].cases()))
