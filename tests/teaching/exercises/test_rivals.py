"""Typical wrong answers of lesson 08 get the hint that helps."""

import pytest
from lesson_answers import hint_tests, judge
from wrong_answers.rivals import WRONG

from cranio_nb.teaching.exercises.rivals import EXERCISES

test_every_exercise_has_wrong_answers, test_a_wrong_answer_is_told_its_cause = hint_tests(WRONG, EXERCISES)


@pytest.mark.parametrize(
    "normal",
    [
        "n = (b - a).mean(axis=0)",
        "d = a - b; n = (d / np.linalg.norm(d, axis=1, keepdims=True)).mean(axis=0)",
        "n = np.linalg.svd(a - b)[2][0]",
    ],
)
def test_every_fair_mean_of_noisy_pairs_is_right(normal):
    body = f"{normal}; return n / np.linalg.norm(n), (a.mean(axis=0) + b.mean(axis=0)) / 2"
    assert judge("8.1", body).passed
