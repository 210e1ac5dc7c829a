"""Assignments for Otter-Grader: its format, and its own grader gives the points that the checks give."""

import ast
import json
import subprocess
import sys

import nbformat
import pytest
from lesson_answers import judge
from lesson_cells import FOLDER
from small_course import FUNCTIONS, HAND_INS, NAME, fill_in, write_lesson

from cranio_nb.teaching.export.assignment import assignment, write_assignments
from cranio_nb.teaching.export.otter import OTTER


def test_each_exercise_is_a_question_with_a_test_for_each_point():
    made = assignment(nbformat.read(FOLDER / "04_deformable_model.ipynb", as_version=4), "04_deformable_model", OTTER)
    raw = [cell.source for cell in made.cells if cell.cell_type == "raw"]
    assert raw[0].startswith("# ASSIGNMENT CONFIG\nname: 04_deformable_model\n")
    kinds = [text.splitlines()[0] for text in raw[1:]]
    one = ["# BEGIN QUESTION", "# BEGIN SOLUTION", "# END SOLUTION", "# BEGIN TESTS", "# END TESTS", "# END QUESTION"]
    assert kinds == one * 3
    assert [text for text in raw if text.startswith("# BEGIN QUESTION")] == [
        f"# BEGIN QUESTION\nname: q4_{at}\npoints: 3" for at in (1, 2, 3)
    ]
    tests = [cell.source for cell in made.cells if "BEGIN TEST CONFIG" in cell.source]
    assert len(tests) == 9 and all(isinstance(ast.parse(text).body[-1], ast.FunctionDef) for text in tests)
    assert all("points: 1\n" in text and f"points >= {at % 3 + 1}," in text for at, text in enumerate(tests))


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """Student -> question -> points, as Otter's own grader gives them."""
    pytest.importorskip("otter", reason="Otter-Grader is not installed (pip install otter-grader)")
    home = tmp_path_factory.mktemp("otter")
    write_assignments(write_lesson(home / "lessons"), home / "course", OTTER)
    place = home / "course" / NAME
    otter(place, "assign", f"{NAME}.ipynb", "dist")
    (autograder,) = (place / "dist" / "autograder").glob("*.zip")
    found = {}
    for student in HAND_INS:
        (place / student).mkdir()
        nbformat.write(
            fill_in(place / "dist" / "student" / f"{NAME}.ipynb", student), place / student / f"{NAME}.ipynb"
        )
        otter(place, "run", "-a", autograder, "-o", student, f"{student}/{NAME}.ipynb")
        tests = json.loads((place / student / "results.json").read_text())["tests"]
        found[student] = {test["name"]: test["score"] for test in tests if test["name"] != "Public Tests"}
    return found


def otter(place, *arguments):
    command = [sys.executable, "-m", "otter", *map(str, arguments)]
    done = subprocess.run(command, cwd=place, capture_output=True, text=True)
    assert done.returncode == 0, (done.stdout + done.stderr)[-2000:]


@pytest.mark.filterwarnings("ignore:noise")
@pytest.mark.parametrize("student", HAND_INS)
def test_otter_gives_the_points_of_the_checks(graded, student):
    *bodies, first, second = HAND_INS[student]
    ours = [judge(n, body).points if body else 3 for n, body in zip(FUNCTIONS, bodies, strict=True)]
    assert ours == [first, second]
    assert graded[student] == {"q1_3": first, "q4_1": second}
