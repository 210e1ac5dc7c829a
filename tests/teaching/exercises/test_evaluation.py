"""Typical wrong answers of lesson 07 get the hint that helps."""

from lesson_answers import hint_tests

from cranio_nb.teaching.exercises.evaluation import EXERCISES

NEAREST = "there, back = spatial.cKDTree(b).query(a)[0], spatial.cKDTree(a).query(b)[0]"

# what students write, and words of the hint that they should get
WRONG = {
    "7.1": [
        ("return np.percentile(spatial.cKDTree(b).query(a)[0], 95)", "One way"),
        ("return max(spatial.cKDTree(b).query(a)[0].max(), spatial.cKDTree(a).query(b)[0].max())", "largest"),
        (
            "return np.concatenate([spatial.cKDTree(b).query(a)[0], spatial.cKDTree(a).query(b)[0]]).mean()",
            "mean distance",
        ),
        (f"{NEAREST}; return np.percentile(back, 95)", "what a has too much"),
        (f"{NEAREST}; return max(np.percentile(there, 95), np.percentile(back, 95))", "larger of two percentiles"),
        (f"{NEAREST}; return np.percentile(np.concatenate([there, back]), 0.95)", "not 0.95"),
    ],
    "7.2": [
        ("return points - np.outer((points - origin) @ normal, normal)", "twice as far"),
        ("return points - 2 * np.outer(points @ normal, normal)", "origin given"),
        ("return points * [-1, 1, 1]", "x = 0"),
        ("d = abs((points - origin) @ normal); return points - 2 * d[:, None] * normal", "without abs"),
        ("return np.flip(points, axis=0)", "order of the points"),
        ("return points[::-1, ::-1]", "no plane"),
        ("return points[:, ::-1]", "swaps x and z"),
        ("distance = (points - origin) @ normal; return points - 2 * distance * normal", "distance[:, None]"),
        ("return points + 2 * np.outer((points - origin) @ normal, normal)", "sign is wrong"),
        ("p = points - origin; return p - 2 * np.outer(p @ normal, normal)", "left there"),
    ],
}

test_every_exercise_has_wrong_answers, test_a_typical_wrong_answer_gets_its_hint = hint_tests(WRONG, EXERCISES)
