"""Typical wrong answers of lesson 00 get the hint that helps."""

import pytest
from lesson_answers import judge, listed

from cranio_nb.teaching.exercises.tour import EXERCISES

# what students write, and words of the hint that they should get
WRONG = {
    "0.1": [
        ("return mask.sum()", "counts voxels"),
        ("return mask.sum() * spacing[0] * spacing[1] * spacing[2]", "1000 mm3"),
        ("return np.count_nonzero(mask) * spacing[1] * spacing[2] / 1000", "area"),
        ("return mask.size * np.prod(spacing) / 1000", "mask.sum()"),
        ("return mask.sum() * np.prod(spacing) / 10", "10 x 10 x 10"),
        ("return mask.sum() * spacing[0] * spacing[1] ** 2 / 1000", "not equal"),
        ("return mask.sum() * spacing[1] ** 3 / 1000", "not equal"),
    ],
    "0.2": [
        ("return np.sum(a & b) / np.sum(a | b)", "Jaccard"),
        ("return np.logical_and(a, b).sum() / (a.sum() + b.sum())", "factor 2"),
        ("return np.mean(a == b)", "air"),
        ("return 2 * np.sum(a & b) / np.sum(a + b)", "a + b means"),
    ],
}


def test_every_exercise_has_wrong_answers():
    assert list(WRONG) == list(EXERCISES) and all(len(answers) >= 3 for answers in WRONG.values())


@pytest.mark.parametrize(("name", "body", "hint"), listed(WRONG))
def test_a_typical_wrong_answer_gets_its_hint(name, body, hint):
    verdict = judge(name, body)
    assert not verdict.passed and hint in verdict.message
