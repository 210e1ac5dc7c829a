"""Assignments for Otter-Grader: the notebooks from which `otter assign` makes the students' copy and the autograder.

Each exercise is a question whose tests are passed by one, two and three points of the check, a point each.
"""

from __future__ import annotations

from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_raw_cell

from ..student_copy import make_stub, split_solution
from .assignment import Question, Tool


def _begin(name: str) -> list[NotebookNode]:
    lines = ["# ASSIGNMENT CONFIG", f"name: {name}", "requirements: [cranio-nb]", "export_cell:", "  pdf: false"]
    return [new_raw_cell("\n".join([*lines, "tests:", "  ok_format: false"]))]


def _answer(question: Question, solution: str) -> list[NotebookNode]:
    """The begin of the question, and the function: its body goes, and the line of the prompt stays."""
    head, body = split_solution(solution)
    stub = make_stub(solution, question.number).splitlines()[-1]
    lines = [head, "    # BEGIN SOLUTION NO PROMPT", body, "    # END SOLUTION"]
    lines += ['    """ # BEGIN PROMPT', stub, '    """ # END PROMPT']
    begin = f"# BEGIN QUESTION\nname: q{question.key}\npoints: {question.points}"
    return [*_raw(begin, "# BEGIN SOLUTION"), new_code_cell("\n".join(lines)), *_raw("# END SOLUTION")]


def _check(question: Question) -> list[NotebookNode]:
    tests = [new_code_cell(_test(question, points)) for points in range(1, question.points + 1)]
    return [*_raw("# BEGIN TESTS"), *tests, *_raw("# END TESTS", "# END QUESTION")]


def _test(question: Question, points: int) -> str:
    return f'''""" # BEGIN TEST CONFIG
points: 1
""" # END TEST CONFIG
def test_{points}_of_{question.points}({question.function}):
    from cranio_nb.teaching import check
    verdict = check.exercise("{question.number}", {question.function})
    assert verdict.points >= {points}, verdict'''


def _raw(*texts: str) -> list[NotebookNode]:
    return [new_raw_cell(text) for text in texts]


OTTER = Tool(_answer, _check, _begin, "{lesson}/{lesson}.ipynb", {})
"""The tool Otter-Grader."""
