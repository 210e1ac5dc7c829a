"""What holds for all answers of a function is found: an argument unused, a power of one, where a mask is wrong."""

from collections import namedtuple

import numpy as np
import pytest

from cranio_nb.teaching.rules import Trial, rule_for

SimpleBalloon = namedtuple("SimpleBalloon", "steps curve")
NUMBERS = [(2.0, 5), (3.0, 7), (11.0, 4)]
GRID = np.indices((6, 6))
BONE, REGION = GRID[0] < 3, GRID[1] < 4
MASKS = [(BONE, REGION), (BONE.T, REGION.T)]


def said(right, wrong, cases):
    return rule_for(Trial(wrong, cases, [right(*case) for case in cases], [wrong(*case) for case in cases]))


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda k, n: k**2 * n, "goes with k."),
        (lambda k, n: n * 7, "goes with 1 / k."),
        (lambda k, n: k * n * (n - 1) ** 2, "goes with (n - 1)^2."),
        (lambda k, n: k / n, "goes with 1 / n^2."),
        (lambda k, n: 3 * k * n, "is 3 times"),
        (lambda k, n: np.degrees(k * n), "57.3 times"),
        (lambda k, n: round(k * n / 30) * 30, ""),
        (lambda k, n: 8, "does not use `k` and `n`"),
        (lambda k, n: sum(1 for _ in range(n)) + 5, "does not use `k`:"),
        (lambda *both: 8, ""),
        (lambda k, n: k * n + 1 / k, ""),
    ],
)
def test_numbers(wrong, words):
    found = said(lambda k, n: k * n, wrong, NUMBERS)
    assert words in found and bool(words) == bool(found)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda bone, region: bone, "This is `bone`, as it was given."),
        (lambda bone, region: region | (bone & ~region), "All that is too much lies in `bone`."),
        (lambda bone, region: ~bone & (region | ~region), "All that is too much lies outside `bone`."),
        (lambda bone, region: region & ~bone & (GRID.sum(axis=0) > 4), ""),
        (lambda bone, region: (region & ~bone & (GRID.sum(axis=0) > 4)) | ~region, "lies outside `region`"),
        (lambda bone, region: ~(region & ~bone), "Inside out"),
        (lambda bone, region: (region & ~bone) * 2, "compare them"),
    ],
)
def test_masks(wrong, words):
    found = said(lambda bone, region: region & ~bone, wrong, MASKS)
    assert words in found and bool(words) == bool(found)


def test_an_answer_that_holds_all_of_a_mask_is_not_told_that_what_is_missing_lies_outside():
    found = said(lambda bone, region: bone | region, lambda bone, region: bone | (region & (GRID[0] < 4)), MASKS)
    assert found == "All that is missing lies in `region`."


def test_an_object_that_holds_an_answer_of_the_right_form_is_told_so():
    made = [SimpleBalloon(5, np.zeros((5, 2))), SimpleBalloon(7, np.zeros((7, 2)))]
    right = [np.ones((5, 2)), np.ones((7, 2))]
    assert "SimpleBalloon" in rule_for(Trial(max, NUMBERS[:2], right, made))
    assert "`.curve`" in rule_for(Trial(max, NUMBERS[:2], right, made))
    assert rule_for(Trial(max, NUMBERS[:2], [np.ones((5, 3)), np.ones((7, 3))], made)) == ""


def test_a_function_that_is_not_written_in_python_says_nothing_of_its_arguments():
    assert said(lambda k, n: k * n, max, NUMBERS) == ""


@pytest.mark.parametrize("found", [None, "text", [[1], [1, 2]], {}, np.zeros(0), np.array(["a"]), 1j])
def test_what_is_no_number_has_no_rule(found):
    assert rule_for(Trial(max, NUMBERS, [1.0, 2.0, 3.0], [found] * 3)) == ""


@pytest.mark.parametrize("digits", [0, 1, 3])
def test_rounded_numbers_are_named_where_they_differ(digits):
    def root(k, n):
        return np.sqrt(k * n)

    assert "rounded" in said(root, lambda k, n: np.round(root(k, n), digits), NUMBERS)
    assert "rounded" not in said(root, lambda k, n: np.round(root(k, n), digits) + 0.5, NUMBERS)
    # 2 is what the root of each rounds to, and also what stands for anything
    assert "rounded" not in said(root, lambda k, n: 2.0, [(2.0, 2), (2.5, 2)])
