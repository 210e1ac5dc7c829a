"""Typical wrong answers of lesson 08 get the hint that helps."""

import pytest
from lesson_answers import judge, listed

from cranio_nb.teaching.exercises.rivals import EXERCISES

# what students write, and words of the hint that they should get
WRONG = {
    "8.1": [
        ("return a[0] - b[0], (a[0] + b[0]) / 2", "length 1"),
        ("return np.mean(a - b, axis=0), np.mean(a + b, axis=0) / 2", "length 1"),
        ("n = a[0] - b[0]; return n / np.linalg.norm(n), a.mean(axis=0)", "half-way"),
        ("return np.array([1, 0, 0]), (a.mean(axis=0) + b.mean(axis=0)) / 2", "head leans"),
        ("n = b[0] - a[0]; return n / np.linalg.norm(n), np.zeros(3)", "0, 0, 0"),
    ],
    "8.2": [
        ("return h", "the largest"),
        ("return h / 2", "exact volume"),
        ("return 2 / 3 * h", "in a slice"),
        ("return np.pi * h * (3 * a**2 + h**2) / 6", "divide it"),
    ],
    "8.3": [
        ("return convex_hull_image(bone) & ~bone", "brain's place"),
        ("return convex_hull_image(bone) ^ (convex_hull_image(inner) & convex_hull_image(bone))", "Bone is still"),
        ("return convex_hull_image(bone) & ~(bone | inner)", "its hull"),
    ],
}


def test_every_exercise_has_wrong_answers():
    assert list(WRONG) == list(EXERCISES) and all(len(answers) >= 3 for answers in WRONG.values())


@pytest.mark.parametrize(("name", "body", "hint"), listed(WRONG))
def test_a_typical_wrong_answer_gets_its_hint(name, body, hint):
    verdict = judge(name, body)
    assert not verdict.passed and hint in verdict.message
