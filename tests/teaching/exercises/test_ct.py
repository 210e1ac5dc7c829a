"""Typical wrong answers of lesson 01 get the hint that helps."""

import pytest
from lesson_answers import judge, listed

from cranio_nb.teaching.exercises.ct import EXERCISES

# what students write, and words of the hint that they should get
WRONG = {
    "1.1": [
        ("return 255 * (hu - centre + width / 2) / width", "clip"),
        ("return np.clip((hu - centre) / width, 0, 1) * 255", "starts at"),
        ("return np.clip((hu - centre) / width + 0.5, 0, 1)", "0 to 1"),
        ("return ((hu - centre + width / 2) / width * 255).astype(int).astype(np.uint8)", "uint8"),
        ("return np.clip((hu - centre + width) / (2 * width), 0, 1) * 255", "twice too wide"),
    ],
    "1.2": [
        ("return affine[:3, :3].dot(index)", "origin"),
        ("return (affine @ np.append(index[::-1], 1))[:3]", "turn it round"),
        ("return index @ affine[:3, :3] + affine[:3, 3]", "transposed"),
    ],
    "1.3": [
        ("z = sorted(positions[:, 2]); return np.median(np.diff(z))", "tilted"),
        ("return np.median(np.diff(positions @ normal))", "any order"),
        ("return positions[1, 2] - positions[0, 2]", "any order"),
        ("return np.median(np.abs(np.diff(positions @ normal)))", "any order"),
        ("return np.diff(np.sort(positions @ normal)).mean()", "pulls the mean"),
    ],
}


def test_every_exercise_has_wrong_answers():
    assert list(WRONG) == list(EXERCISES) and all(len(answers) >= 3 for answers in WRONG.values())


@pytest.mark.parametrize(("name", "body", "hint"), listed(WRONG))
def test_a_typical_wrong_answer_gets_its_hint(name, body, hint):
    verdict = judge(name, body)
    assert not verdict.passed and hint in verdict.message
