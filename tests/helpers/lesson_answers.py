"""Answers to exercises as students write them: the shipped solutions, their stubs, and other bodies for their heads."""

import ast
from pathlib import Path

import numpy as np
import pytest
from scipy import ndimage, spatial
from skimage import measure, morphology

from cranio_nb.curves import cubic, spiral
from cranio_nb.stages import deformable_model
from cranio_nb.teaching import check
from cranio_nb.teaching.lesson_text import read_lesson, tags
from cranio_nb.teaching.student_copy import exercise_number, make_stub

SOURCES = sorted((Path(__file__).parents[2] / "notebooks" / "src").glob("*.py"))
LIBRARY = {
    "np": np,
    "ndimage": ndimage,
    "spatial": spatial,
    "measure": measure,
    "morphology": morphology,
    "convex_hull_image": morphology.convex_hull_image,
    "cubic": cubic,
    "spiral": spiral,
    "deformable_model": deformable_model,
}
"""What the lessons import, for the functions to use."""


def function(text):
    """The function that a text defines."""
    names = dict(LIBRARY)
    exec(text, names)  # the project's own lesson texts
    return names[ast.parse(text).body[-1].name]


def shipped(stub):
    """Exercise -> the function of its solution cell, or of its stub in the student's copy."""
    found = {}
    for source in SOURCES:
        cells = read_lesson(source).cells
        for cell in cells:
            if "solution" in tags(cell):
                number = exercise_number(cells, cell)
                found[number] = function(make_stub(cell.source, number) if stub else cell.source)
    return found


SOLUTIONS, STUBS = shipped(False), shipped(True)


def written(name, body):
    """The shipped function's head with another body."""
    head = SOLUTIONS[name].__code__
    arguments = ", ".join(head.co_varnames[: head.co_argcount])
    return function(f"def answer({arguments}):\n    {body}")


def judge(name, body):
    """The verdict on a body of an exercise's function."""
    return check.exercise(name, written(name, body))


def hint_tests(wrong, exercises, complete=lambda name, body: body):
    """The two tests of a lesson: all exercises have typical wrong answers, and each of these gets its hint.

    `wrong` holds (body, words of the hint) by exercise, `complete` makes a whole body of what is written there.
    """

    def test_every_exercise_has_wrong_answers():
        assert list(wrong) == list(exercises) and all(len(answers) >= 3 for answers in wrong.values())

    listed = [(name, *answer) for name, answers in wrong.items() for answer in answers]

    @pytest.mark.parametrize(("name", "body", "hint"), listed)
    def test_a_typical_wrong_answer_gets_its_hint(name, body, hint):
        verdict = judge(name, complete(name, body))
        assert not verdict.passed and hint in verdict.message

    return test_every_exercise_has_wrong_answers, test_a_typical_wrong_answer_gets_its_hint
