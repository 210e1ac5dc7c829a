"""Two answers beside each other: the place, the numbers, as many digits as tell them apart."""

import numpy as np
import pytest

from cranio_nb.teaching.side_by_side import side_by_side


@pytest.mark.parametrize(
    ("yours", "mine", "unit", "said"),
    [
        (1.0000001, 1.0, "mm", "yours 1.0000001, mine 1 mm"),
        (np.nan, 2.0, "", "yours nan, mine 2"),
        (123456.0, 123457.0, "mm3", "yours 123456, mine 123457 mm3"),
        ((1, 2), (1, 2.5), "", "yours (1, 2), mine (1, 2.5)"),
        (np.arange(9), np.arange(9) + 4 * (np.arange(9) == 7), "px", "at [7] yours 7, mine 11 px"),
        (np.full((3, 3), np.nan), np.ones((3, 3)), "px", "at [0, 0] yours nan, mine 1 px"),
        (np.ones(3), np.ones((3, 2)), "px", "yours is an array of shape (3,), mine an array of shape (3, 2)"),
        (3, np.ones(2), "px", "yours is one number, mine an array of shape (2,)"),
        (None, 3.0, "px", "yours is nothing, mine one number"),
        ("3", 3.0, "px", "yours is a str, mine one number"),
        ([[1], [1, 2]], 3.0, "px", "yours is a list, mine one number"),
        ([1, 0], np.array([True, False]), "pixels", "yours holds the right pixels as numbers, mine as True and False"),
        ([2, 0], np.array([True, False]), "pixels", "yours runs from 0 to 2, mine is True and False"),
    ],
)
def test_says_what_differs_and_where(yours, mine, unit, said):
    assert side_by_side(yours, mine, unit) == said


def test_pixels_are_counted_on_both_sides():
    mine = np.random.default_rng(0).random((20, 30)) > 0.5
    yours = mine.copy()
    yours[3] = True
    yours[5] = False
    extra, missing = (yours & ~mine).sum(), (mine & ~yours).sum()
    said = f"yours and mine differ: {extra} pixels too many, {missing} missing"
    assert side_by_side(yours, mine, "pixels") == said and extra and missing
