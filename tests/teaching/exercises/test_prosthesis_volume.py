"""Typical wrong answers of lesson 05 get the hint that helps."""

import pytest
from lesson_answers import judge, listed

from cranio_nb.teaching.exercises.prosthesis_volume import EXERCISES

REGIONS_4 = (
    "l, n = ndimage.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel(), minlength=n + 1); s[0] = 0"
)

REGIONS_8 = REGIONS_4.replace("~bone)", "~bone, np.ones((3, 3)))")

# what students write, and words of the hint that they should get
WRONG = {
    "5.1": [
        ("return np.vstack([outer, inner])", "bow tie"),
        ("return outer", "inner curve is missing"),
        ("return inner", "outer curve is missing"),
    ],
    "5.2": [
        ("return region", "Bone is still"),
        ("return region != bone", "rest of the skull"),
        ("return region & bone", "must go"),
    ],
    "5.3": [
        ("return convex_hull_image(bone) & ~bone", "whole difference"),
        ("return ndimage.binary_fill_holes(bone) & ~bone", "convex hull"),
        (
            "l, n = ndimage.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel()); s[0] = 0; "
            "return (s >= min_pixels)[l]",
            "brain's place",
        ),
        (f"{REGIONS_4}; k = s >= min_pixels; k[s.argmax()] = False; return k[l]", "touch at a corner"),
        (f"{REGIONS_8}; k = s > min_pixels; k[s.argmax()] = False; return k[l]", ">=, not >"),
        (f"{REGIONS_4}; k = s > min_pixels; k[s.argmax()] = False; return k[l]", "(>=), and"),
        (f"{REGIONS_8}; return (s >= min_pixels)[l]", "brain's place"),
    ],
}


def test_every_exercise_has_wrong_answers():
    assert list(WRONG) == list(EXERCISES) and all(len(answers) >= 3 for answers in WRONG.values())


@pytest.mark.parametrize(("name", "body", "hint"), listed(WRONG))
def test_a_typical_wrong_answer_gets_its_hint(name, body, hint):
    verdict = judge(name, body)
    assert not verdict.passed and hint in verdict.message
