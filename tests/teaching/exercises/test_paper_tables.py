"""Typical wrong answers of lesson 10 get the hint that helps."""

import pytest
from lesson_answers import judge, listed

from cranio_nb.teaching.exercises.paper_tables import EXERCISES

# what students write, and words of the hint that they should get
WRONG = {
    "10.1": [
        ("v = [s[key][side] for s in slices]; return min(v), max(v)", "no balloon"),
        ("v = [s[key][1 - side] for s in slices if s['status'] == 'balloon']; return min(v), max(v)", "side 0"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return max(v), min(v)", "comes first"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return v[0], v[-1]", "in any order"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return (np.mean(v),) * 2", "the mean"),
    ],
    "10.2": [
        ("return np.arcsin(chord / (2 * radius))", "radians"),
        ("return np.degrees(np.arctan(chord / 2 / radius))", "sine"),
        ("return 2 * np.degrees(np.arcsin(chord / 2 / radius))", "centre"),
    ],
}


def test_every_exercise_has_wrong_answers():
    assert list(WRONG) == list(EXERCISES) and all(len(answers) >= 3 for answers in WRONG.values())


@pytest.mark.parametrize(("name", "body", "hint"), listed(WRONG))
def test_a_typical_wrong_answer_gets_its_hint(name, body, hint):
    verdict = judge(name, body)
    assert not verdict.passed and hint in verdict.message
