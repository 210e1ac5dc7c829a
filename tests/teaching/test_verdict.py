"""The line of a check is read as it was written."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cranio_nb.teaching import check
from cranio_nb.teaching.exercises import EXERCISES
from cranio_nb.teaching.verdict import Verdict, read_verdict

WORDS = st.lists(st.sampled_from(["k", "N = n - 1.", "off", "by 3 mm;", "(some)", "hint=1", "a: b"]), min_size=1)


@given(
    st.sampled_from(list(EXERCISES)),
    st.integers(0, 3),
    WORDS.map(" ".join),
    st.sampled_from(["", "Given (0.062, 21): yours 3.4, mine 3.1 px.", "Case 2: at [3, 1] yours 1, mine -0.5 mm."]),
    st.sampled_from(["", "(Ask for a hint with hint=1.)", "Hint 2 of 3: Count, then multiply."]),
)
def test_what_was_written_is_read(name, points, message, compared, hint):
    verdict = Verdict(name, points, 3, message, compared, hint)
    assert read_verdict(str(verdict)) == verdict
    assert verdict.passed == (points == 3)


@pytest.mark.parametrize("name", EXERCISES)
@pytest.mark.parametrize("hint", [0, 1, 3, "x"])
def test_the_lines_of_real_checks_are_read(name, hint):
    verdict = check.exercise(name, lambda *given: 0.5, hint=hint)
    assert read_verdict(str(verdict)) == verdict


@pytest.mark.parametrize("line", ["", "Exercise 4.1", "4 of 5 points", "Exercise x: 1 of 3 points. Good.", "3"])
def test_other_lines_are_not(line):
    assert read_verdict(line) is None
