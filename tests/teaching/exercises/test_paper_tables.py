"""Typical wrong answers of lesson 10 get the hint that helps."""

from lesson_answers import hint_tests

from cranio_nb.teaching.exercises.paper_tables import EXERCISES

# what students write, and words of the hint that they should get
WRONG = {
    "10.1": [
        ("v = [s[key][side] for s in slices]; return min(v), max(v)", "no balloon"),
        ("v = [s[key][1 - side] for s in slices if s['status'] == 'balloon']; return min(v), max(v)", "side 0"),
        ("v = [s[key][0] for s in slices if s['status'] == 'balloon']; return min(v), max(v)", "outer side whatever"),
        ("v = [s[key][1] for s in slices if s['status'] == 'balloon']; return min(v), max(v)", "inner side whatever"),
        (
            "v = [s['theta0'][side] for s in slices if s['status'] == 'balloon']; return min(v), max(v)",
            "whatever `key`",
        ),
        (
            "v = [s['n_iter'][side] for s in slices if s['status'] == 'balloon']; return min(v), max(v)",
            "whatever `key`",
        ),
        ("v = sum((s[key] for s in slices if s['status'] == 'balloon'), []); return min(v), max(v)", "Both sides"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return max(v), min(v)", "comes first"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return v[0], v[-1]", "in any order"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return (np.mean(v),) * 2", "the mean"),
    ],
    "10.2": [
        ("return np.arcsin(chord / (2 * radius))", "radians"),
        ("return np.degrees(np.arctan(chord / 2 / radius))", "sine"),
        ("return np.degrees(np.arcsin(chord / radius))", "Half the chord"),
        ("return np.nan", "not a finite number"),
        ("return 2 * np.degrees(np.arcsin(chord / 2 / radius))", "centre"),
    ],
}

test_every_exercise_has_wrong_answers, test_a_typical_wrong_answer_gets_its_hint = hint_tests(WRONG, EXERCISES)
