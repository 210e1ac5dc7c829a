"""Typical wrong answers of lesson 06 get the hint that helps."""

import pytest
from lesson_answers import judge, listed

from cranio_nb.teaching.exercises.surface_reconstruction import EXERCISES

TETRAHEDRA = "a, b, c = vertices[faces].swapaxes(0, 1); v = (a * np.cross(b, c)).sum(1)"

# what students write, and words of the hint that they should get
WRONG = {
    "6.1": [
        ("a, b, c = vertices[faces].swapaxes(0, 1); return (a * np.cross(b, c)).sum() / 3", "Twice"),
        ("a, b, c = vertices[faces].swapaxes(0, 1); return abs((a * np.cross(b, c)).sum(1)).sum() / 6", "signs"),
        ("a, b, c = vertices[faces].swapaxes(0, 1); return (a * np.cross(c, b)).sum() / 6", "sign is wrong"),
        (f"{TETRAHEDRA}; return v.sum()", "Six times too big"),
        (f"{TETRAHEDRA}; return abs(v.sum()) / 6", "inside out"),
    ],
    "6.2": [
        ("return index", "still voxels"),
        ("return index * spacing[::-1]", "turn it round"),
        ("return index / spacing", "Divided"),
        ("return index[:, ::-1] * spacing", "columns of the index"),
        ("return (index * spacing)[:, ::-1]", "their columns turned round"),
        ("return (index + 0.5) * spacing", "Half a voxel"),
        ("return index * spacing - spacing / 2", "Half a voxel"),
    ],
}


def test_every_exercise_has_wrong_answers():
    assert list(WRONG) == list(EXERCISES) and all(len(answers) >= 3 for answers in WRONG.values())


@pytest.mark.parametrize(("name", "body", "hint"), listed(WRONG))
def test_a_typical_wrong_answer_gets_its_hint(name, body, hint):
    verdict = judge(name, body)
    assert not verdict.passed and hint in verdict.message
