"""Wrong answers to an exercise -> a sentence with the cause: a known mistake, a rule that holds for all, or how far."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .exercises import Exercise
from .exercises.task import Answer

_ALIKE = 1e-6  # relative
_ORDER = ("first", "second", "third", "fourth")


def diagnose(task: Exercise, cases: list[tuple[Any, ...]], right: list[Any], found: list[Any]) -> str:
    """The cause of wrong answers.

    Parameters
    ----------
    task : Exercise
    cases : list of tuple
        What it was tried on.
    right : list
        The right answer to each.
    found : list
        The answer to each; one is wrong at least.

    Returns
    -------
    str
        One sentence or two.

    Examples
    --------
    >>> from .exercises import EXERCISES
    >>> task = EXERCISES["10.2"]
    >>> right = [task.right(*case) for case in task.cases()]
    >>> diagnose(task, task.cases(), right, [3 * angle for angle in right])
    'Each of your numbers is 3 times the right one: is there a factor too many, or one too few?'
    """
    for mistake, sentence in task.mistakes:
        if all(_alike(task, value, mistake(*case)) for value, case in zip(found, cases, strict=True)):
            return sentence
    errors = [error_of(task, value, wanted) for value, wanted in zip(found, right, strict=True)]
    return (
        _unlike(found)
        or _handed_back(cases, found)
        or _by_form(found, right)
        or _by_rule(found, right)
        or _far(task.answer, max(errors))
    )


def error_of(task: Exercise, value: Any, wanted: Any) -> float:
    """How far an answer lies from a wanted one.

    Parameters
    ----------
    task : Exercise
    value, wanted : Any

    Returns
    -------
    float
        In the exercise's unit; inf where they cannot be compared.
    """
    try:
        error = float(task.answer.error(value, wanted))
    except Exception:  # whatever comes of comparing with an answer of any form
        return float("inf")
    return error if np.isfinite(error) else float("inf")


def _alike(task: Exercise, value: Any, made: Any) -> bool:
    """Whether an answer is what a mistake makes, also where the exercise itself cannot compare them."""
    if error_of(task, value, made) <= task.answer.tolerance:
        return True
    one, other = _array(value), _array(made)
    return one is not None and other is not None and one.shape == other.shape and _near(one, other)


def _unlike(found: list[Any]) -> str:
    """What is said of answers that are no finite numbers, or not always there."""
    if any(value is None for value in found):
        return "The function returns nothing for some of the cases: does every way through it end in a `return`?"
    if not all(_finite(value) for value in found):
        return (
            "There is NaN or infinity in the answer, not a finite number: which step has no result (arcsin, sqrt, / 0)?"
        )
    return ""


def _handed_back(cases: list[tuple[Any, ...]], found: list[Any]) -> str:
    """What is said where an argument comes back as it was given."""
    for at, word in enumerate(_ORDER[: min(len(case) for case in cases)]):
        if all(_equal(value, case[at]) for value, case in zip(found, cases, strict=True)):
            return f"This is the {word} argument, as it was given."
    return ""


def _by_form(found: list[Any], right: list[Any]) -> str:
    """What is said where all answers have another form than the right ones."""
    pairs = [(np.asarray(a), np.asarray(b)) for a, b in zip(found, right, strict=True) if _is_numeric(a)]
    if len(pairs) < len(found):
        return ""
    if all(b.ndim == 0 and a.ndim > 0 for a, b in pairs):
        return "One number is wanted, and these are many: which step makes one of them (sum, mean, max)?"
    if all(b.ndim > 0 and a.ndim == 0 for a, b in pairs):
        return "Many numbers are wanted, and this is one: is there a sum or mean too many, or without its axis?"
    if all(a.shape == b.shape and b.dtype == bool for a, b in pairs) and (words := _by_mask(pairs)):
        return words
    if all(a.ndim > 1 and a.shape == b.T.shape and _near(a * 1.0, b.T * 1.0) for a, b in pairs):
        return "Rows and columns are exchanged: yours is the transpose of the right one."
    return ""


def _by_mask(pairs: list[tuple[NDArray[Any], NDArray[np.bool_]]]) -> str:
    """What is said of all answers where masks are wanted."""
    if any(not np.isin(a, (0, 1)).all() for a, _ in pairs):
        return "These are numbers, and a mask is True or False: compare them, with == or >."
    if all(np.array_equal(a, b) for a, b in pairs):
        return "The right places, but as numbers: a bool mask is wanted, as a comparison makes it."
    if all(np.array_equal(a.astype(bool), ~b) for a, b in pairs):
        return "Inside out: what should be True is False, and the other way round."
    return ""


def _by_rule(found: list[Any], right: list[Any]) -> str:
    """A relation to the right answers that holds for all of them."""
    pairs = [(_array(yours), _array(mine)) for yours, mine in zip(found, right, strict=True)]
    if any(yours is None or mine is None or yours.size == 0 for yours, mine in pairs):
        return ""
    known = [(a, b) for a, b in pairs if a is not None and b is not None]
    if any(a.shape != b.shape for a, b in known):
        return ""
    if all(a.ndim > 0 and _near(a, b[::-1]) for a, b in known):
        return "These are the right values in turned order: the last comes first."
    one, other = (np.concatenate([np.ravel(pair[i]) for pair in known]) for i in (0, 1))
    return _by_number(one, other)


def _by_number(one: NDArray[np.float64], other: NDArray[np.float64]) -> str:
    """A factor or a step between all of a student's numbers and the right ones."""
    if _near(one, -other):
        return "The sign is turned: each of your numbers is minus the right one."
    at = int(np.abs(other).argmax())
    if other[at] and np.any(one) and _near(one, other * (ratio := one[at] / other[at])):
        return f"Each of your numbers is {ratio:.4g} times the right one: is there a factor too many, or one too few?"
    if _near(one - other, np.full_like(one, step := float(np.median(one - other)))):
        return f"Each of your numbers is {abs(step):.4g} too {'large' if step > 0 else 'small'}."
    return ""


def _far(answer: Answer, worst: float) -> str:
    """How far off the answers are."""
    if np.isinf(worst):
        return f"The answer does not have the right form: {answer.form}."
    far = f"{worst:.0f}" if worst >= 100 else f"{worst:.3g}"
    unit = f" {answer.unit}" if answer.unit else ""
    return f"Not yet: off by up to {far}{unit}; {answer.tolerance:.2g} is allowed."


def _array(value: Any) -> NDArray[np.float64] | None:
    """Numbers as an array of floats; None for what is no number, and for masks, which have no sign and no factor."""
    if not _is_numeric(value):
        return None
    found = np.asarray(value)
    return None if found.dtype == bool else found.astype(float)


def _is_numeric(value: Any) -> bool:
    """Whether an answer is made of numbers or truth values."""
    try:
        return np.asarray(value).dtype.kind in "biuf"
    except (TypeError, ValueError):  # rows of several lengths
        return False


def _equal(value: Any, argument: Any) -> bool:
    """Whether an answer is an argument, an array of the same numbers."""
    return isinstance(argument, np.ndarray) and _is_numeric(value) and np.array_equal(value, argument)


def _near(one: NDArray[np.float64], other: NDArray[np.float64]) -> bool:
    """Whether all numbers agree but for rounding."""
    return bool(np.allclose(one, other, rtol=_ALIKE, atol=_ALIKE * float(np.abs(other).max(initial=0.0))))


def _finite(value: Any) -> bool:
    """Whether an answer holds neither NaN nor infinity; what is no number counts as finite."""
    try:
        return bool(np.isfinite(np.asarray(value, float)).all())
    except (TypeError, ValueError):
        return True
