"""A student's function comes in -> one line goes out: points, what is wrong in mm, and a hint if one is asked for.

In a lesson::

    check.exercise("4.2", my_pressure)
    check.exercise("4.2", my_pressure, hint=1)

A check never raises: whatever the function does becomes a sentence. It never keeps anything either: the same function
gets the same line.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .exercises import EXERCISES, Exercise

_STUB = "Nothing here yet: replace the line with NotImplementedError by your own, then run both cells again."


@dataclass(frozen=True)
class Verdict:
    """What a check found; shown as one line.

    Parameters
    ----------
    name : str
        Number of the exercise.
    points, out_of : int
        Cases answered rightly, and cases tried.
    message : str
    hint : str
        Empty unless one was asked for.
    """

    name: str
    points: int
    out_of: int
    message: str
    hint: str = ""

    @property
    def passed(self) -> bool:
        """Whether every case is right.

        Returns
        -------
        bool
        """
        return self.out_of > 0 and self.points == self.out_of

    def __repr__(self) -> str:
        line = f"Exercise {self.name}: {self.points} of {self.out_of} points. {self.message}"
        return f"{line} {self.hint}".rstrip()


def exercise(name: str, answer: Callable[..., Any], *, hint: int = 0) -> Verdict:
    """Check the answer to an exercise.

    Parameters
    ----------
    name : str
        Its number, e.g. "4.2".
    answer : callable
        The student's function.
    hint : int
        0 for none, 1 for a first push, higher for more.

    Returns
    -------
    Verdict

    Examples
    --------
    >>> exercise("4.1", lambda k, n: k * n**2 / 8)
    Exercise 4.1: 0 of 3 points. N counts the steps between snaxels: N = n - 1. (Ask for a hint with hint=1.)
    """
    task = EXERCISES.get(str(name))
    if task is None:
        return Verdict(str(name), 0, 0, f"There is no such exercise; there are {', '.join(EXERCISES)}.")
    cases = task.cases()
    points, message = _judge(task, answer, cases)
    return Verdict(str(name), points, len(cases), message, "" if points == len(cases) else _hint(task, hint))


def _judge(task: Exercise, answer: Any, cases: list[tuple[Any, ...]]) -> tuple[int, str]:
    """Points, and what to say about the answer."""
    if not callable(answer):
        return 0, f"A function is wanted, and this is a {type(answer).__name__}: give its name without brackets."
    # the answer to each case, on copies
    found = []
    for case in cases:
        given = copy.deepcopy(case)
        try:
            found.append(answer(*given))
        except NotImplementedError:
            return 0, _STUB
        except (Exception, SystemExit) as error:
            return 0, f"The function stopped with {type(error).__name__}: {_first_line(error)}"
        if not _unchanged(given, case):
            return 0, "The function changes the array it is given; work on a copy."
    if all(value is None for value in found):
        return 0, "The function returns nothing: is there a `return`?"
    # a point for each that is near enough to the right one
    errors = [_error(task, value, task.right(*case)) for value, case in zip(found, cases, strict=True)]
    points = sum(error <= task.answer.tolerance for error in errors)
    return points, _say(task, cases, found, errors)


def _say(task: Exercise, cases: list[tuple[Any, ...]], found: list[Any], errors: list[float]) -> str:
    """The sentence: praise, the typical mistake that gives just these answers, or how far off they are."""
    # right; else a known mistake that gives the same answers; else the distance
    worst, wanted = max(errors), task.answer
    if worst <= wanted.tolerance:
        return f"Right: {task.praise}"
    for mistake, sentence in task.mistakes:
        apart = (_error(task, value, mistake(*case)) for value, case in zip(found, cases, strict=True))
        if all(error <= wanted.tolerance for error in apart):
            return sentence
    if not all(_finite(value) for value in found):
        return (
            "There is NaN or infinity in the answer, not a finite number: which step has no result (arcsin, sqrt, / 0)?"
        )
    if np.isinf(worst):
        return f"The answer does not have the right form: {wanted.form}."
    unit = f" {wanted.unit}" if wanted.unit else ""
    return f"Not yet: off by up to {worst:.2g}{unit}, where {wanted.tolerance:.2g}{unit} is allowed."


def _finite(value: Any) -> bool:
    """Whether an answer holds neither NaN nor infinity; what is no number counts as finite."""
    try:
        return bool(np.isfinite(np.asarray(value, float)).all())
    except (TypeError, ValueError):
        return True


def _error(task: Exercise, value: Any, wanted: Any) -> float:
    """How far two answers lie apart; inf where they cannot be compared."""
    try:
        error = float(task.answer.error(value, wanted))
    except Exception:
        return float("inf")
    return error if np.isfinite(error) else float("inf")


def _hint(task: Exercise, stage: int) -> str:
    """The hint of a stage, or how to get one."""
    if stage <= 0:
        return "(Ask for a hint with hint=1.)"
    stage = min(stage, len(task.hints))
    return f"Hint {stage} of {len(task.hints)}: {task.hints[stage - 1]}"


def _unchanged(given: tuple[Any, ...], case: tuple[Any, ...]) -> bool:
    """Whether the arrays among the arguments are what they were."""
    pairs = [(a, b) for a, b in zip(given, case, strict=True) if isinstance(b, np.ndarray)]
    return all(a.shape == b.shape and np.array_equal(a, b) for a, b in pairs)


def _first_line(error: BaseException) -> str:
    """The error's own words, short and on one line."""
    lines = str(error).splitlines()
    return lines[0][:120] if lines else "no message."
