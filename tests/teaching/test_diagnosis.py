"""What holds for all wrong answers is said: a factor, a sign, a step, an order, a form."""

import numpy as np
import pytest

from cranio_nb.teaching.diagnosis import diagnose, error_of
from cranio_nb.teaching.exercises import EXERCISES
from cranio_nb.teaching.rules import Trial


def said(name, wrong):
    """The sentence on answers that are made of the right ones."""
    task = EXERCISES[name]
    right = [task.right(*case) for case in task.cases()]
    return diagnose(task, Trial(wrong, task.cases(), right, [wrong(answer) for answer in right]))


@pytest.mark.parametrize(
    ("name", "wrong", "words"),
    [
        ("6.1", lambda v: 5 * v, "5 times the right one"),
        ("6.2", lambda v: -v, "sign is turned"),
        ("1.1", lambda v: v + 7, "7 too large"),
        ("1.1", lambda v: v - 7, "7 too small"),
        ("3.3", lambda v: v[::-1], "turned order"),
        ("9.3", lambda v: v.T, "Rows and columns"),
        ("3.1", lambda v: ~v, "Inside out"),
        ("2.1", lambda v: v * 1.0, "as numbers"),
        ("2.1", lambda v: v * 3, "compare them"),
        ("3.3", lambda v: v.sum(), "this is one"),
        ("10.2", lambda v: [v, v], "these are many"),
        ("10.2", lambda v: None, "returns nothing for some"),
        ("9.2", lambda v: v * np.inf, "not a finite number"),
        ("9.2", lambda v: v + 0.3 * np.sin(np.arange(len(v))), "off by up to 0.3 mm; 0.0001 is allowed"),
    ],
)
def test_a_rule_for_all_answers_is_found(name, wrong, words):
    assert words in said(name, wrong)


def test_what_cannot_be_compared_is_infinitely_far():
    task = EXERCISES["4.1"]
    assert error_of(task, "words", 3.0) == error_of(task, np.nan, 3.0) == error_of(task, None, 3.0) == np.inf
    assert error_of(task, 2.0, 3.0) == 1.0
