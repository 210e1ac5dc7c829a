"""Typical wrong answers of lesson 02 get the hint that helps."""

import pytest
from lesson_answers import judge, listed

from cranio_nb.teaching.exercises.segmentation import EXERCISES

FRAME = ("l[0]", "l[-1]", "l[:, 0]", "l[:, -1]")


def holes(*borders, structure="None", compare="<=", sizes="s", given="mask"):
    """A way to fill small holes, written as a student does."""
    return (
        f"l, n = ndimage.label(~mask, {structure}); s = np.bincount(l.ravel()); s = {sizes}; "
        f"out = {given}.copy(); border = {{*np.concatenate([{', '.join(borders)}])}}\n"
        f"    for i, size in enumerate(s):\n"
        f"        if i > 0 and size {compare} max_pixels and i not in border: out[l == i] = True\n"
        "    return out"
    )


# what students write, and words of the hint that they should get
WRONG = {
    "2.1": [
        ("labels, n = ndimage.label(mask); return labels == 1", "met first"),
        ("l, n = ndimage.label(mask); return l == np.bincount(l.ravel()).argmax()", "background"),
        ("return mask", "Nothing was dropped"),
        ("l, n = ndimage.label(mask); return l == np.bincount(l.ravel())[1:].argmax()", "add 1"),
        (
            "l = [ndimage.label(s)[0] for s in mask]; "
            "return np.array([(s == np.append(0, np.bincount(s.ravel())[1:]).argmax()) & (s > 0) for s in l])",
            "whole mask once",
        ),
        (
            "l, n = ndimage.label(mask, np.ones((3, 3, 3))); return l == np.bincount(l.ravel())[1:].argmax() + 1",
            "not connected",
        ),
        ("l, n = ndimage.label(mask); return l * (l == np.bincount(l.ravel())[1:].argmax() + 1)", "a bool mask"),
    ],
    "2.2": [
        ("return ndimage.binary_fill_holes(mask)", "brain"),
        ("return mask.copy()", "No hole"),
        (
            "l, n = ndimage.label(~mask); s = np.bincount(l.ravel()); return mask | ((s[l] <= max_pixels) & (l > 0))",
            "border",
        ),
        (holes("l[0]", "l[-1]"), "four borders"),
        (holes("l[:, 0]", "l[:, -1]"), "four borders"),
        (holes("l[0]", "l[-1]", "l[:, 0]"), "four borders"),
        (holes(*FRAME, structure="np.ones((3, 3))"), "4 neighbours"),
        (holes(*FRAME, compare="<"), "at most"),
        (holes(*FRAME, sizes="s[1:]"), "label before"),
        (holes(*FRAME, given="np.zeros_like(mask)"), "holes alone"),
        (holes(*FRAME, given="(mask * 1)"), "a bool mask"),
    ],
}


def test_every_exercise_has_wrong_answers():
    assert list(WRONG) == list(EXERCISES) and all(len(answers) >= 3 for answers in WRONG.values())


@pytest.mark.parametrize(("name", "body", "hint"), listed(WRONG))
def test_a_typical_wrong_answer_gets_its_hint(name, body, hint):
    verdict = judge(name, body)
    assert not verdict.passed and hint in verdict.message
