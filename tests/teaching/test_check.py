"""Checks of exercises: the shipped solution passes, the stub gets the teaching message, nothing stops a check."""

import numpy as np
import pytest
from lesson_answers import SOLUTIONS, STUBS, written

from cranio_nb.curves import cubic
from cranio_nb.teaching import check
from cranio_nb.teaching.exercises import EXERCISES


def test_every_exercise_has_a_solution():
    assert list(SOLUTIONS) == list(EXERCISES)


@pytest.mark.parametrize("name", EXERCISES)
def test_the_solution_passes(name):
    verdict = check.exercise(name, SOLUTIONS[name])
    assert verdict.passed and verdict.points == verdict.out_of == 3
    assert str(verdict) == f"Exercise {name}: 3 of 3 points. {verdict.message}"


@pytest.mark.parametrize("name", EXERCISES)
def test_the_stub_is_told_what_to_do(name):
    verdict = check.exercise(name, STUBS[name])
    assert verdict.points == 0 and "Nothing here yet" in str(verdict)


@pytest.mark.parametrize("name", EXERCISES)
def test_own_catalogue_says_what_it_should(name):
    for mistake, sentence in EXERCISES[name].mistakes:
        verdict = check.exercise(name, mistake)
        assert not verdict.passed and verdict.message == sentence


@pytest.mark.parametrize("name", EXERCISES)
@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (None, "A function is wanted"),
        (3.0, "A function is wanted"),
        (lambda *a: None, "returns nothing"),
        (lambda *a: 1 / 0, "ZeroDivisionError"),
        (lambda: 1, "TypeError"),
        (lambda *a: "text", "right form"),
        (lambda *a: np.full(7, np.nan), "NaN"),
        (lambda *a: {"a": object()}, "right form"),
    ],
    ids=["none", "number", "nothing", "fails", "arguments", "text", "nan", "object"],
)
def test_never_raises_and_says_one_line(name, answer, said):
    line = str(check.exercise(name, answer))
    assert said in line and "\n" not in line
    assert line == str(check.exercise(name, answer))


@pytest.mark.parametrize("name", EXERCISES)
def test_hints_come_in_stages(name):
    lines = [str(check.exercise(name, STUBS[name], hint=stage)) for stage in range(5)]
    assert "hint=1" in lines[0] and "Hint 1 of 3" in lines[1] and "Hint 3 of 3" in lines[3] == lines[4][:0] + lines[3]
    assert lines[3] == lines[4] and len({*lines}) == 4


def test_gives_points_for_part_of_the_cases():
    upright_only = written("1.3", "return np.median(np.diff(np.sort(positions[:, 2])))")
    assert check.exercise("1.3", upright_only).points == 2


def test_says_how_far_off_an_unknown_answer_is_in_its_unit():
    verdict = check.exercise("4.3", lambda length, a, b, n: cubic(length, a, b, n) + np.array([0, 5.0]))
    assert "mm, where 0.1 mm is allowed" in verdict.message


def test_sees_a_changed_input():
    def greedy(mask, max_pixels):
        mask[:] = False
        return mask

    assert "work on a copy" in check.exercise("2.2", greedy).message


def test_names_the_exercises_when_there_is_no_such():
    verdict = check.exercise("9.9", len)
    assert not verdict.passed and "4.2" in str(verdict)
