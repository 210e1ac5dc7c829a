"""Typical wrong answers of lesson 03 get the hint that helps."""

import pytest
from lesson_answers import judge, listed

from cranio_nb.teaching.exercises.feature_extraction import EXERCISES

# what students write, and words of the hint that they should get
WRONG = {
    "3.1": [
        ("return ndimage.binary_dilation(bone) & ~bone", "outside the bone"),
        ("return ndimage.binary_dilation(bone) & ~ndimage.binary_erosion(bone)", "two pixels"),
        ("return bone & ~ndimage.binary_erosion(bone, np.ones((3, 3)))", "cross"),
        (
            "r = np.roll; return bone & ~(r(bone, 1, 0) & r(bone, -1, 0) & r(bone, 1, 1) & r(bone, -1, 1))",
            "opposite border",
        ),
    ],
    "3.2": [
        ("a, b = np.polyfit(points[:, 0], points[:, 1], 1); return np.array([1, a])", "along a row"),
        ("a, b = np.polyfit(points[:, 1], points[:, 0], 1); return np.array([a, 1])", "along a column"),
        ("d = points[-1] - points[0]; return d / np.linalg.norm(d)", "to the last"),
        ("return np.linalg.svd(points)[2][0]", "centred"),
        ("return np.linalg.svd(points - points.mean(0))[2][-1]", "normal"),
    ],
    "3.3": [
        ("return np.arange(len(points))", "counts points"),
        ("return np.hypot(*(points - points[0]).T)", "straight"),
        ("return np.cumsum(np.hypot(*np.diff(points, axis=0).T))", "first point is missing"),
    ],
}


def test_every_exercise_has_wrong_answers():
    assert list(WRONG) == list(EXERCISES) and all(len(answers) >= 3 for answers in WRONG.values())


@pytest.mark.parametrize(("name", "body", "hint"), listed(WRONG))
def test_a_typical_wrong_answer_gets_its_hint(name, body, hint):
    verdict = judge(name, body)
    assert not verdict.passed and hint in verdict.message
