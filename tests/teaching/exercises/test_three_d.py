"""Typical wrong answers of lesson 09 get the hint that helps."""

import pytest
from lesson_answers import judge, listed

from cranio_nb.teaching.exercises.three_d import EXERCISES

SPLINE = "D, W = np.diff(np.eye(len(f)), order, axis=0), np.diag(known.astype(float))"

BASIS = "B = np.column_stack([(1 - t) ** 2, 2 * t * (1 - t), t**2])"

# what students write, and words of the hint that they should get
WRONG = {
    "9.1": [
        ("return np.diff(np.eye(n), n=order)", "exchanged"),
        ("d = np.eye(n)[1:] - np.eye(n)[:-1]; return d**order", "difference of differences"),
        ("return np.eye(n)[1:] - np.eye(n)[:-1]", "first difference"),
        ("d = np.eye(n); return d[2:] - 2 * d[1:-1] + d[:-2]", "second difference"),
        ("return np.diff(np.eye(n), order - 1, axis=0)", "too low"),
    ],
    "9.2": [
        (
            f"{SPLINE}; I = np.eye(len(f)); return np.linalg.solve(I + strength * D.T @ D, f)",
            "as if it were bone",
        ),
        (f"{SPLINE}; return np.linalg.solve(W + strength * D.T @ D, f)", "still pulls"),
        (f"{SPLINE}; return np.linalg.solve(np.eye(len(f)) + strength * D.T @ D, W @ f)", "held to 0"),
        (f"{SPLINE}; return np.linalg.solve(W + D.T @ D, W @ f)", "not used"),
        (
            f"{SPLINE}; D = np.diff(np.eye(len(f)), 2, axis=0); return np.linalg.solve(W + strength * D.T @ D, W @ f)",
            "Always the second",
        ),
        (f"{SPLINE}; return np.linalg.solve(W + strength**2 * D.T @ D, W @ f)", "square"),
    ],
    "9.3": [
        (f"{BASIS}; return B @ points", "parabola"),
        (f"{BASIS}; return (B * weights) @ points", "Divide by"),
        (f"{BASIS}; return (B * weights) @ points / weights.sum()", "changes along"),
        (f"{BASIS}; return B @ points / (B @ weights)[:, None]", "above the line"),
        (
            "B = np.column_stack([(1 - t) ** 2, t * (1 - t), t**2]) * weights; "
            "return B @ points / B.sum(axis=1, keepdims=True)",
            "2 t (1 - t)",
        ),
    ],
}


def test_every_exercise_has_wrong_answers():
    assert list(WRONG) == list(EXERCISES) and all(len(answers) >= 3 for answers in WRONG.values())


@pytest.mark.parametrize(("name", "body", "hint"), listed(WRONG))
def test_a_typical_wrong_answer_gets_its_hint(name, body, hint):
    verdict = judge(name, body)
    assert not verdict.passed and hint in verdict.message
