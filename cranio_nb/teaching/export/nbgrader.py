"""Assignments for nbgrader: solutions between its marks, and one locked cell with points for each exercise.

The cell ends with the points of the check, which nbgrader takes as partial credit; a cell that fails or writes to the
error stream would have none.
"""

from __future__ import annotations

from typing import Any

from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_markdown_cell

from ..student_copy import split_solution
from .assignment import Question, Tool

_CONFIG = """# Where nbgrader finds this course; `nbgrader generate_assignment 00_tour` makes the students' copy.
c = get_config()
c.CourseDirectory.course_id = "cranio-nb"
c.Execute.timeout = 300  # s for a cell: the slowest of the lessons takes half a minute
"""
_NOTE = (
    "*Run the cells from the top. Where you meet `raise NotImplementedError`, put your own lines in its place, "
    "then run the check below it.*"
)


def _begin(name: str) -> list[NotebookNode]:
    return [new_markdown_cell(_NOTE)]


def _answer(question: Question, solution: str) -> list[NotebookNode]:
    head, body = split_solution(solution)
    text = f"{head}\n    ### BEGIN SOLUTION\n{body}\n    ### END SOLUTION"
    return [_marked(text, f"answer-{question.key}", solution=True, locked=False)]


def _check(question: Question) -> list[NotebookNode]:
    lines = ["import contextlib, io", "", "with contextlib.redirect_stderr(io.StringIO()):  # a warning is no mistake"]
    lines += [
        f'    verdict = check.exercise("{question.number}", {question.function})',
        "print(verdict)",
        "verdict.points",
    ]
    return [_marked("\n".join(lines), f"check-{question.key}", grade=True, locked=True, points=question.points)]


def _marked(text: str, name: str, *, grade: bool = False, solution: bool = False, **more: Any) -> NotebookNode:
    """A cell with nbgrader's metadata."""
    marks = {"grade_id": name, "grade": grade, "solution": solution, "task": False, "schema_version": 3, **more}
    return new_code_cell(text, metadata={"nbgrader": marks})


NBGRADER = Tool(_answer, _check, _begin, "source/{lesson}/{lesson}.ipynb", {"nbgrader_config.py": _CONFIG})
"""The tool nbgrader."""
