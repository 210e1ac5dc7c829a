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


def solution_texts():
    """Exercise -> the text of its solution cell."""
    lessons = [read_lesson(source).cells for source in SOURCES]
    return {exercise_number(cells, c): c.source for cells in lessons for c in cells if "solution" in tags(c)}


TEXTS = solution_texts()
SOLUTIONS = {number: function(text) for number, text in TEXTS.items()}
STUBS = {number: function(make_stub(text, number)) for number, text in TEXTS.items()}


def written(name, body):
    """The shipped function's head with another body."""
    head = SOLUTIONS[name].__code__
    arguments = ", ".join(head.co_varnames[: head.co_argcount])
    return function(f"def answer({arguments}):\n    {body}")


def judge(name, body):
    """The verdict on a body of an exercise's function."""
    return check.exercise(name, written(name, body))


def hint_tests(wrong, exercises):
    """The two tests of a lesson: all exercises have typical wrong answers, and each of these is told its cause.

    `wrong` holds (body, words) by exercise; without words the answer must be shown beside the right one.
    """

    def test_every_exercise_has_wrong_answers():
        assert list(wrong) == list(exercises) and all(len(answers) >= 3 for answers in wrong.values())

    listed = [(name, *answer) for name, answers in wrong.items() for answer in answers]

    @pytest.mark.parametrize(("name", "body", "words"), listed)
    def test_a_wrong_answer_is_told_its_cause(name, body, words):
        verdict = judge(name, body)
        assert not verdict.passed
        if words is None:
            assert "yours" in verdict.compared and "mine" in verdict.compared
        else:
            assert words in verdict.message

    return test_every_exercise_has_wrong_answers, test_a_wrong_answer_is_told_its_cause
