"""Typical wrong answers of lesson 04 get the hint that helps."""

import pytest
from lesson_answers import judge, listed

from cranio_nb.teaching.exercises.deformable_model import EXERCISES

SLOPES = "slopes = np.array([[length, length * np.tan(t)] for t in (theta0, theta1)])"

REST = (
    "k = deformable_model.tangent_pressure(length, theta0, theta1, n); "
    "return deformable_model.inflate(cubic(length, theta0, theta1, n), slopes, pressure=k).curve"
)

BALLOON_END = (
    f"{SLOPES} / (n - 1); return deformable_model.inflate(cubic(length, theta0, theta1, n), slopes, pressure=k).curve"
)

# what students write, and words of the hint that they should get
WRONG = {
    "4.1": [
        ("return k * n ** 2 / 8", "N = n - 1"),
        ("return k * (n - 1) ** 2 / 2", "Four times"),
        ("return k * (n - 1) ** 2", "factor"),
    ],
    "4.2": [
        ("return length * (np.tan(theta0) - np.tan(theta1)) / n ** 2", "N = n - 1"),
        ("return length * (np.tan(theta0) + np.tan(theta1)) / (n - 1) ** 2", "negative"),
        ("r = np.radians; return length * (np.tan(r(theta0)) - np.tan(r(theta1))) / (n - 1) ** 2", "radians"),
        ("return length * (np.tan(theta1) - np.tan(theta0)) / (n - 1) ** 2", "sign"),
        ("return length * (theta0 - theta1) / (n - 1) ** 2", "These are angles;"),
        ("return length * (theta0 + np.pi - theta1) / (n - 1) ** 2", "above the chord"),
    ],
    "4.3": [
        ("k = deformable_model.PAPER_PRESSURE", "paper's k"),
        ("k = -deformable_model.tangent_pressure(length, theta0, theta1, n)", "into the head"),
        ("k = 0", "flat"),
        ("return np.linspace([0, 0], [length, 0], n)", "chord"),
        ("return cubic(length, theta0, theta1, n)", "start curve"),
        ("return spiral(length, theta0, theta1, n)[0]", "spiral"),
        ("k = length * (np.tan(theta0) - np.tan(theta1)) / n**2", "too flat"),
        (f"{SLOPES} / n; {REST}", "n - 1 steps"),
        (f"{SLOPES}; {REST}", "divide by n - 1"),
    ],
}


def test_every_exercise_has_wrong_answers():
    assert list(WRONG) == list(EXERCISES) and all(len(answers) >= 3 for answers in WRONG.values())


@pytest.mark.parametrize(("name", "body", "hint"), listed(WRONG))
def test_a_typical_wrong_answer_gets_its_hint(name, body, hint):
    verdict = judge(name, f"{body}; {BALLOON_END}" if name == "4.3" and "return" not in body else body)
    assert not verdict.passed and hint in verdict.message
