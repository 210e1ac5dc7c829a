"""Typical wrong answers of lesson 08 get the hint that helps."""

import pytest
from lesson_answers import hint_tests, judge

from cranio_nb.teaching.exercises.rivals import EXERCISES

# what students write, and words of the hint that they should get
WRONG = {
    "8.1": [
        ("return a[0] - b[0], (a[0] + b[0]) / 2", "length 1"),
        ("return np.mean(a - b, axis=0), np.mean(a + b, axis=0) / 2", "length 1"),
        ("n = a[0] - b[0]; return n / np.linalg.norm(n), a.mean(axis=0)", "half-way"),
        ("return np.array([1, 0, 0]), (a.mean(axis=0) + b.mean(axis=0)) / 2", "head leans"),
        ("n = b[0] - a[0]; return n / np.linalg.norm(n), np.zeros(3)", "0, 0, 0"),
        ("n = a[0] - b[0]; return n / np.linalg.norm(n), (a[0] + b[0]) / 2", "first pair only"),
        ("n = a[0] - b[0]; return n / np.linalg.norm(n), (a + b).mean(axis=0) / 2", "normal rests on the first"),
        ("n = (a - b).sum(axis=0); return n / np.linalg.norm(n), (a[0] + b[0]) / 2", "point rests on the first"),
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

test_every_exercise_has_wrong_answers, test_a_typical_wrong_answer_gets_its_hint = hint_tests(WRONG, EXERCISES)


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
