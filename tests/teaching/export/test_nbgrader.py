"""Assignments for nbgrader: its format, and its own grader gives the points that the checks give."""

import json
import os
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from lesson_answers import TEXTS, judge
from lesson_cells import FOLDER
from small_course import FUNCTIONS, HAND_INS, NAME, fill_in, write_lesson

from cranio_nb.teaching.export.assignment import assignment, write_assignments
from cranio_nb.teaching.export.nbgrader import NBGRADER


def marked(notebook, kind):
    return [c for c in notebook.cells if c.metadata.get("nbgrader", {}).get(kind)]


def test_each_exercise_has_a_cell_to_answer_and_a_locked_cell_with_points():
    lesson = nbformat.read(FOLDER / "04_deformable_model.ipynb", as_version=4)
    made = assignment(lesson, "04_deformable_model", NBGRADER)
    answers, checks = marked(made, "solution"), marked(made, "grade")
    assert [c.metadata.nbgrader.grade_id for c in answers] == ["answer-4_1", "answer-4_2", "answer-4_3"]
    assert [c.metadata.nbgrader.grade_id for c in checks] == ["check-4_1", "check-4_2", "check-4_3"]
    for cell in checks:
        assert cell.metadata.nbgrader.points == 3 and cell.metadata.nbgrader.locked
        assert cell.source.splitlines()[-1] == "verdict.points"
    for cell, number in zip(answers, ("4.1", "4.2", "4.3"), strict=True):
        kept = [line for line in cell.source.splitlines() if not line.strip().startswith("### ")]
        assert "\n".join(kept) == TEXTS[number] and cell.source.count("### BEGIN SOLUTION") == 1
    assert json.dumps(made.metadata)  # no object that nbgrader could not store


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """Student -> number of the exercise -> points, as nbgrader's own grader gives them."""
    pytest.importorskip("nbgrader", reason="nbgrader is not installed (pip install nbgrader)")
    gradebook = pytest.importorskip("nbgrader.api").Gradebook
    home = tmp_path_factory.mktemp("nbgrader")
    course = home / "course"
    write_assignments(write_lesson(home / "lessons"), course, NBGRADER)
    nbgrader(course, "generate_assignment", NAME)
    for student in HAND_INS:
        place = course / "submitted" / student / NAME / f"{NAME}.ipynb"
        place.parent.mkdir(parents=True)
        nbformat.write(fill_in(course / "release" / NAME / f"{NAME}.ipynb", student), place)
    nbgrader(course, "autograde", NAME)
    with gradebook(f"sqlite:///{course / 'gradebook.db'}") as book:
        return {
            student: {g.name: g.auto_score for g in book.find_submission_notebook(NAME, NAME, student).grades}
            for student in HAND_INS
        }


def nbgrader(course, *arguments):
    # it calls a program of its own environment (alembic) by name
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    command = [sys.executable, "-m", "nbgrader", *arguments]
    done = subprocess.run(command, cwd=course, env=os.environ | {"PATH": path}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-2000:]


@pytest.mark.filterwarnings("ignore:noise")
@pytest.mark.parametrize("student", HAND_INS)
def test_nbgrader_gives_the_points_of_the_checks(graded, student):
    *bodies, first, second = HAND_INS[student]
    ours = [judge(n, body).points if body else 3 for n, body in zip(FUNCTIONS, bodies, strict=True)]
    assert ours == [first, second]
    assert graded[student] == {"check-1_3": first, "check-4_1": second}
