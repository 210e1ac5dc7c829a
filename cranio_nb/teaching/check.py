"""A student's function comes in -> one line goes out: points, the cause of what is wrong, a hint if one is asked for.

In a lesson::

    check.exercise("4.2", my_pressure)
    check.exercise("4.2", my_pressure, hint=1)

A check never raises and never hangs: whatever the function does becomes a sentence. It never keeps anything either: the
same function gets the same line.
"""

from __future__ import annotations

import copy
import operator
import re
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from .diagnosis import diagnose, error_of
from .exercises import EXERCISES, Exercise
from .rules import Trial, as_numbers
from .side_by_side import side_by_side
from .time_limit import TookTooLongError, call_within
from .verdict import Verdict

_POINT = 3  # numbers of a point or a direction at most, which may come as a list
LIMIT_S = 10.0
"""Time that a function gets for a case; right answers take a hundredth of a second."""
STUB = "Nothing here yet: replace the line with NotImplementedError by your own, then run both cells again."
"""What is said to those who have not begun."""
_STOPPED: dict[type[BaseException], str] = {
    RecursionError: "The function calls itself without end: when should it stop?",
    MemoryError: "The function wants more memory than there is: what grows without end?",
}
_POWER = "A power is written `**`: `^` is either one without the other."
_CAUSES = {
    "boolean subtract": "Masks cannot be subtracted: join them by & and ~.",  # numpy advises ^, another wrong answer
    r"for \^": _POWER,
    "'bitwise_xor' not supported": _POWER,
    "the concatenation axis": "The arrays to join differ in shape. (Of what query of a tree gives, [0] are distances.)",
    "truth value of an array": "`and`, `or`, `not` and `if` want one value, not an array: join masks by &, | and ~.",
    r"size (\d+) is different from (\d+)": r"`@` met \2 columns left and \1 rows right of it: as many are wanted.",
    "object too deep": "np.bincount wants a row of numbers: labels.ravel() makes one.",
    "'tuple'|tuple indices": "A tuple holds several values: take them apart, as in `labels, n = ...`.",
}
"""Words of an error, as a pattern, and what is said instead of them."""


class _NoAnswerError(Exception):
    """The function gave nothing that can be judged; the words say why."""


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
    >>> print(exercise("4.1", lambda k, n: k * n**2 / 8).message)
    N counts the steps between snaxels: N = n - 1.
    """
    task = EXERCISES.get(str(name))
    if task is None:
        return Verdict(str(name), 0, 0, f"There is no such exercise; there are {', '.join(EXERCISES)}.")
    cases, right = _tried(str(name))
    try:
        found = _answers(answer, cases)
    except _NoAnswerError as error:
        return Verdict(str(name), 0, len(cases), str(error), hint=_hint(task, hint))
    # a point for each case whose answer is near enough to the right one
    good = [error_of(task, yours, mine) <= task.answer.tolerance for yours, mine in zip(found, right, strict=True)]
    if all(good) and any(_is_listed(yours, mine) for yours, mine in zip(found, right, strict=True)):
        words = f"The right values, but in a list: {task.answer.form} is wanted, as np.array makes it."
        return Verdict(str(name), 0, len(cases), words, hint=_hint(task, hint))
    if all(good):
        return Verdict(str(name), len(cases), len(cases), f"Right: {task.praise}")
    wrong = good.index(False)
    compared = f"{_called(cases, wrong)}: {_compared(task, found[wrong], right[wrong])}."
    return Verdict(
        str(name),
        sum(good),
        len(cases),
        diagnose(task, Trial(answer, cases, right, found)),
        compared,
        _hint(task, hint),
    )


@cache
def _tried(name: str) -> tuple[list[tuple[Any, ...]], list[Any]]:
    """The cases of an exercise and the right answers to them; they take longer to make than to check."""
    cases = EXERCISES[name].cases()
    return cases, [EXERCISES[name].right(*case) for case in cases]


def _answers(answer: Any, cases: list[tuple[Any, ...]]) -> list[Any]:
    """The answer to each case, on copies; refused with the reason where there is none."""
    if not callable(answer):
        raise _NoAnswerError(
            f"A function is wanted, not a value of type {type(answer).__name__}: give its name without brackets."
        )
    found = []
    for case in cases:
        given = copy.deepcopy(case)
        found.append(_answer(answer, given))
        if not all(_same(a, b) for a, b in zip(given, case, strict=True)):
            raise _NoAnswerError("The function changes what it is given; work on a copy.")
    if all(value is None for value in found):
        raise _NoAnswerError("The function returns nothing: is there a `return`?")
    if any(_is_text(value) for value in found):
        raise _NoAnswerError("The function returns text: return the numbers themselves, without str() or an f-string.")
    return found


def _is_text(value: Any) -> bool:
    """Whether an answer is made of texts, which numpy would read as the numbers they spell."""
    try:
        return np.asarray(value).dtype.kind in "US"
    except (TypeError, ValueError):  # rows of several lengths
        return False


def _is_listed(yours: Any, mine: Any) -> bool:
    """Whether a list or tuple stands for an array or a mask; a point or a direction may come as a list."""
    arrays = isinstance(mine, np.ndarray) and (mine.size > _POINT or mine.dtype == bool)
    return arrays and not isinstance(yours, np.ndarray)


def _answer(answer: Callable[..., Any], given: tuple[Any, ...]) -> Any:
    """What the function returns in its time."""
    try:
        with np.errstate(all="ignore"):  # what is no number is told below, whatever numpy says
            return call_within(LIMIT_S, answer, *given)
    except TookTooLongError:
        words = f"The function did not end within {LIMIT_S:g} s: is there a loop that never stops?"
        raise _NoAnswerError(words) from None
    except (Exception, SystemExit) as error:
        if type(error) is NotImplementedError:  # and none of its kinds, which say something else
            raise _NoAnswerError(STUB) from None
        raise _NoAnswerError(_why_stopped(error)) from None


def _called(cases: list[tuple[Any, ...]], number: int) -> str:
    """A case by its numbers, where it is made of numbers only; else by its place."""
    case = cases[number]
    if all(isinstance(value, int | float) for value in case):
        return f"Given ({', '.join(f'{value:.4g}' for value in case)})"
    return f"Case {number + 1}"


def _compared(task: Exercise, yours: Any, mine: Any) -> str:
    """The student's answer beside the right one, as the exercise shows them."""
    if task.answer.shows is None:
        return side_by_side(yours, mine, task.answer.unit)
    show, unit = task.answer.shows
    try:
        shown = show(yours)
    except Exception:  # whatever a function of ours meets in an answer of any form
        return side_by_side(yours, mine)
    given, wanted = as_numbers(yours), as_numbers(mine)
    unlike = given is not None and wanted is not None and given.shape != wanted.shape
    if unlike or as_numbers(shown) is None:  # what was given has a form of its own, what was made of it hides that
        return side_by_side(yours, mine)
    return side_by_side(shown, show(mine), unit)


def _hint(task: Exercise, stage: Any) -> str:
    """The hint of a stage, or how to get one."""
    n = len(task.hints)
    try:
        at = min(operator.index(stage), n)
    except TypeError:
        return f"(A hint is asked for by a whole number: hint=1, up to hint={n}.)"
    return f"Hint {at} of {n}: {task.hints[at - 1]}" if at > 0 else "(Ask for a hint with hint=1.)"


def _same(given: Any, case: Any) -> bool:
    """Whether an argument is what it was."""
    if isinstance(case, np.ndarray):
        return given.shape == case.shape and np.array_equal(given, case)
    return bool(given == case)


def _why_stopped(error: BaseException) -> str:
    """What a function stopped with, in words that lead on."""
    for pattern, cause in _CAUSES.items():
        if found := re.search(pattern, str(error)):
            return found.expand(cause)
    words = f"The function stopped with {type(error).__name__}: {_first_line(error)}{_about_shapes(error)}"
    return _STOPPED.get(type(error), words)


def _about_shapes(error: BaseException) -> str:
    """What is said besides where the shapes tell a likely cause: a column lost, a wrong axis, A A^T for A^T A."""
    shapes = sorted(re.findall(r"\((\d+),(\d*)\)", str(error)), key=lambda shape: shape[1] == "")
    match shapes if isinstance(error, ValueError) and "broadcast" in str(error) else ():
        case [(rows, columns), (n, "")] if columns and n == rows:
            return f" - {n} numbers for {n} rows: keep it a column, as [:, [i]], [:, None] or keepdims=True do."
        case [(rows, columns), (n, "") | ("1", n)] if columns and n not in (rows, columns):
            return f" - {n} numbers for {rows} rows: summed along the wrong axis, or some left out?"
        case [(n, ""), (m, "")]:
            return f" - {n} numbers against {m}: one number for each row? A column, [:, None], goes with each of them."
        case [(rows, columns), (n, m)] if rows == columns and n == m:
            return f" - {rows} against {n}: is a product turned round (A @ A.T for A.T @ A), or an edge cut off?"
    return ""


def _first_line(error: BaseException) -> str:
    """The error's own words, short and on one line."""
    lines = str(error).splitlines()
    return lines[0][:120] if lines else "no message."
