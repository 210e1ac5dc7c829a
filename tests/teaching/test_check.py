"""Checks of exercises: the shipped solution passes, the stub gets the teaching message, nothing stops a check."""

import re
import threading

import numpy as np
import pytest
from lesson_answers import SOLUTIONS, STUBS, TEXTS, judge, written

from cranio_nb.curves import cubic
from cranio_nb.stages.deformable_model import inflate
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
        (lambda *a: "text", "returns text"),
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


@pytest.mark.parametrize("name", EXERCISES)
def test_no_hint_is_the_answer(name):
    """Neither the answer's own line, nor words that are right when they are put behind a `return`."""
    returned = TEXTS[name].rsplit("return ", 1)[1]
    for hint in EXERCISES[name].hints:
        assert "".join(returned.split()) not in "".join(hint.split())
        for part in re.split(r"[:;] |, (?=\w+ = )", hint):
            try:
                compile(part.strip(" .`"), "hint", "eval")
            except SyntaxError:
                continue
            assert not judge(name, f"return {part.strip(' .`')}").passed, hint


@pytest.mark.parametrize("hint", ["x", None, 1.5, [1], 0, -3, 10**9, np.int64(2)], ids=repr)
def test_a_hint_may_be_asked_for_by_anything(hint):
    line = str(check.exercise("4.1", STUBS["4.1"], hint=hint))
    assert "hint=1" in line or "of 3:" in line


@pytest.mark.parametrize("name", EXERCISES)
def test_shows_what_is_wrong_beside_what_is_right(name):
    """An answer that is right in nothing: the right one of another case, so that its form is right."""
    cases, right = EXERCISES[name].cases(), [EXERCISES[name].right(*case) for case in EXERCISES[name].cases()]
    other = iter(right[1:] + right[:1])
    verdict = check.exercise(name, lambda *given: next(other))
    assert len(cases) == 3 and not verdict.passed
    assert "yours" in verdict.compared and "mine" in verdict.compared
    assert verdict.compared.startswith(("Given (", "Case "))


def endless(*given):
    while True:
        pass


@pytest.mark.parametrize("thread", ["main", "another"])
def test_an_endless_loop_is_named_from_any_thread(monkeypatch, thread):
    monkeypatch.setattr(check, "LIMIT_S", 0.05)
    lines = []
    if thread == "main":
        lines.append(str(check.exercise("4.1", endless)))
    else:
        worker = threading.Thread(target=lambda: lines.append(str(check.exercise("4.1", endless))))
        worker.start()
        worker.join()
    assert "0 of 3 points. The function did not end within 0.05 s: is there a loop that never stops?" in lines[0]


@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (lambda k, n: k.shape, "AttributeError"),
        (lambda k, n: asks(), "stopped with AsksError: no keyboard here"),
        (lambda k, n: recursive(k), "calls itself without end"),
        (lambda k, n: np.ones(n) > 0 and k, "join masks by &"),
        (lambda k, n: np.ones((2, 4)) @ np.ones(3), "`@` met 4 columns left and 3 rows"),
        (lambda k, n: (k, n).ravel(), "take them apart"),
        (lambda k, n: None if n > 30 else 1.0, "nothing for some of the cases"),
        (lambda k, n: np.sqrt(-1.0 * n), "not a finite number"),
        (lambda k, n: exec("raise SystemExit"), "SystemExit"),
        (lambda k, n: [[1.0], [1.0, 2.0]], "right form"),
        (lambda k, n: np.ones(n), "One number is wanted"),
    ],
    ids=["attribute", "asks", "recursion", "and", "product", "tuple", "some", "root", "exit", "ragged", "many"],
)
def test_says_what_the_function_did(answer, said):
    assert said in check.exercise("4.1", answer).message


class AsksError(NotImplementedError):
    """As a kernel without a keyboard raises it; it is not the stub's."""


def asks():
    raise AsksError("no keyboard here")


def recursive(k):
    return recursive(k)


def test_gives_points_for_part_of_the_cases():
    upright_only = written("1.3", "return np.median(np.diff(np.sort(positions[:, 2])))")
    assert check.exercise("1.3", upright_only).points == 2


def test_says_how_far_off_an_unknown_answer_is_in_its_unit():
    verdict = check.exercise("4.3", lambda length, a, b, n: cubic(length, a, b, n) + np.array([0, 5.0]))
    assert "px; 0.07 is allowed" in verdict.message


def test_an_object_is_called_by_its_own_name():
    def whole(length, theta0, theta1, n):
        return inflate(cubic(length, theta0, theta1, n), np.full((2, 2), length / n), pressure=0.1)

    verdict = check.exercise("4.3", whole)
    assert "yours is a Balloon, mine an array" in verdict.compared and "`.curve`" in verdict.message


def test_sees_a_changed_input():
    def greedy(mask, max_pixels):
        mask[:] = False
        return mask

    assert "work on a copy" in check.exercise("2.2", greedy).message
    assert "work on a copy" in judge("10.1", "slices.sort(key=lambda s: s['plane']); return 1, 2").message


def test_names_the_exercises_when_there_is_no_such():
    verdict = check.exercise("9.9", len)
    assert not verdict.passed and "4.2" in str(verdict)


def test_a_list_is_no_array_but_may_be_a_point():
    right = EXERCISES["2.1"].right
    assert "in a list" in check.exercise("2.1", lambda mask: right(mask).tolist()).message
    assert "in a list" in check.exercise("9.2", lambda *case: list(EXERCISES["9.2"].right(*case))).message
    assert check.exercise("1.2", lambda affine, index: list(EXERCISES["1.2"].right(affine, index))).passed


def test_single_precision_is_right():
    for name in ("3.3", "6.2", "9.3"):
        right = EXERCISES[name].right
        assert check.exercise(name, lambda *case, right=right: np.asarray(right(*case), np.float32)).passed
        assert not check.exercise(name, lambda *case, right=right: np.asarray(1.001 * right(*case), np.float32)).passed


def test_what_uses_nothing_is_told_so_whatever_it_returns():
    assert "does not use `a` and `b`" in check.exercise("0.2", lambda a, b: 1.0).message
    assert "does not use `a` and `b`" in check.exercise("7.1", lambda a, b: 0.0).message


def test_the_form_is_told_before_nan():
    line = check.exercise("0.2", lambda a, b: (2 * (a & b).sum(axis=0)) / (a.sum(axis=0) + b.sum(axis=0))).message
    assert line.startswith("One number is wanted") and "NaN" in line
