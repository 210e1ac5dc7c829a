"""Wrong answers to an exercise -> a sentence with the cause: a known mistake, a rule that holds for all, or how far."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .exercises import Exercise
from .exercises.task import Answer
from .rules import Trial, as_numbers, by_form, by_nothing, near, rule_for


def diagnose(task: Exercise, trial: Trial) -> str:
    """The cause of wrong answers.

    Parameters
    ----------
    task : Exercise
    trial : Trial
        At least one of its answers is wrong.

    Returns
    -------
    str
        One sentence or two.

    Examples
    --------
    >>> from .exercises import EXERCISES
    >>> task = EXERCISES["10.2"]
    >>> right = [task.right(*case) for case in task.cases()]
    >>> diagnose(task, Trial(task.right, task.cases(), right, [3 * angle for angle in right]))
    'Each of your numbers is 3 times the right one: is there a factor too many, or one too few?'
    """
    if all(map(_finite, trial.found)) and (sentence := by_nothing(trial)):
        return sentence
    for mistake, sentence in task.mistakes:
        if all(_made_by(mistake, task, case, value) for case, value in zip(trial.cases, trial.found, strict=True)):
            return sentence
    errors = [error_of(task, value, wanted) for value, wanted in zip(trial.found, trial.right, strict=True)]
    return _unlike(trial) or rule_for(trial) or _far(task.answer, max(errors))


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
    if not np.isfinite(error):
        return float("inf")
    return 0.0 if _single_precision(value, wanted) else error


def _single_precision(value: Any, wanted: Any) -> bool:
    """Whether an answer in float32 is as near as float32 allows; 100 times its precision, for what adds up."""
    if getattr(value, "dtype", None) != np.float32 or np.shape(value) != np.shape(wanted):
        return False
    wanted = np.asarray(wanted, float)
    allowed = 100 * np.finfo(np.float32).eps * np.abs(wanted).max(initial=0.0)
    return bool(np.abs(np.asarray(value, float) - wanted).max(initial=0.0) <= allowed)


def _made_by(mistake: Callable[..., Any], task: Exercise, case: tuple[Any, ...], value: Any) -> bool:
    """Whether an answer is what a mistake makes, also where the exercise itself cannot compare them."""
    made = mistake(*case)
    one, other = as_numbers(value), as_numbers(made)
    # a tolerance is for answers of the right size: next to it all that is tiny would be alike
    scalar = one is not None and other is not None and one.ndim == other.ndim == 0
    alike = not scalar or abs(float(value) - float(made)) <= abs(float(made)) / 10
    if error_of(task, value, made) <= task.answer.tolerance and alike:
        return True
    if one is None or other is None or one.shape != other.shape:
        return False
    return one.dtype != bool and other.dtype != bool and near(one, other)


def _unlike(trial: Trial) -> str:
    """What is said of answers that are no finite numbers, or not always there."""
    if any(value is None for value in trial.found):
        return "The function returns nothing for some of the cases: does every way through it end in a `return`?"
    if not all(_finite(value) for value in trial.found):
        if form := by_form(trial):
            return f"{form} And there is NaN or infinity in it, not only finite numbers."
        return (
            "There is NaN or infinity in the answer, not a finite number: which step has no result (arcsin, sqrt, / 0)?"
        )
    return ""


def _far(answer: Answer, worst: float) -> str:
    """How far off the answers are."""
    if np.isinf(worst):
        return f"The answer does not have the right form: {answer.form}."
    far = f"{worst:.0f}" if worst >= 100 else f"{worst:.3g}"
    unit = f" {answer.unit}" if answer.unit else ""
    return f"Not yet: off by up to {far}{unit}; {answer.tolerance:.2g} is allowed."


def _finite(value: Any) -> bool:
    """Whether an answer holds neither NaN nor infinity; what is no number counts as finite."""
    try:
        return bool(np.isfinite(np.asarray(value, float)).all())
    except (TypeError, ValueError):
        return True
