"""A hand-in has a verdict for every exercise of its lesson, whatever became of the checks."""

from pathlib import Path

import pytest
from hand_ins import CHECKS, write_hand_in
from lesson_answers import STUBS, TEXTS

from cranio_nb.teaching import check
from cranio_nb.teaching.exercises import EXERCISES, LESSONS
from cranio_nb.teaching.grading import marks
from cranio_nb.teaching.grading.marks import UNNAMED, cause, grade, students

NAMES = [name for name in EXERCISES if name.startswith("4.")]


def test_checks_that_are_right_wrong_repeated_printed_and_broken(tmp_path):
    path = write_hand_in(
        tmp_path / "anna" / "04_deformable_model.ipynb",
        f"import numpy as np\n{CHECKS}",
        "def apex(k, n):\n    return 1.0",
        'check.exercise("4.1", apex)',
        TEXTS["4.1"],
        'check.exercise("4.1", apex, hint=2)',
        "def pressure(length, theta0, theta1, n):\n    return length * (np.tan(theta0) - np.tan(theta1)) / n ** 2",
        'print(check.exercise("4.2", pressure))',
        'check.exercise("4.3", bridge)',
    )
    one = grade(path, "anna")
    first, second, third = one.verdicts
    assert (one.student, one.notebook, one.remark) == ("anna", "04_deformable_model", "")
    assert first.passed and (one.points, one.out_of) == (3, 9)
    assert second.points == 0 and second.message == "N counts the steps between snaxels: N = n - 1."
    assert third.message == "The cell with the check stopped with NameError: name 'bridge' is not defined"
    assert one.code[0] == TEXTS["4.1"] and "def pressure" in one.code[1]


@pytest.fixture
def not_run(monkeypatch):
    monkeypatch.setattr(marks, "run_hand_in", lambda notebook: "")


def test_checks_that_are_gone_or_were_not_run_have_no_points(tmp_path, not_run):
    path = write_hand_in(tmp_path / "04_bo.ipynb", "1", 'check.exercise( "4.2", f)')
    assert [(v.name, v.points, v.out_of) for v in grade(path, "bo").verdicts] == [(name, 0, 3) for name in NAMES]
    said = {verdict.name: verdict.message for verdict in grade(path, "bo").verdicts}
    assert said == {"4.1": "The cell with the check is gone.", "4.2": "The check was not run."} | {
        "4.3": "The cell with the check is gone."
    }


def test_a_file_that_is_no_notebook_counts_for_the_lesson_it_is_named_after(tmp_path, not_run):
    (tmp_path / f"{LESSONS[4]}.ipynb").write_text("?")
    one = grade(tmp_path / f"{LESSONS[4]}.ipynb", "cy")
    assert one.remark and one.points == 0 and [v.name for v in one.verdicts] == NAMES


def test_the_lessons_have_the_names_of_their_notebooks():
    folder = Path(__file__).parents[3] / "notebooks"
    assert list(LESSONS) == sorted(path.stem for path in folder.glob("*.ipynb"))


def test_students_with_one_name_are_told_apart_by_the_folders_above():
    paths = [Path(f"in/{group}/anna/{LESSONS[4]}.ipynb") for group in "ab"] + [Path(f"in/a/anna/{LESSONS[5]}.ipynb")]
    assert students(paths) == ["a_anna", "b_anna", "anna"]


def test_what_is_only_far_off_is_counted_together():
    far = [check.exercise("4.1", lambda k, n, s=s: k + s * n) for s in (1, 2)]
    assert far[0].message != far[1].message and [cause(v) for v in far] == [UNNAMED] * 2
    assert cause(check.exercise("4.1", STUBS["4.1"])) == check.STUB
