"""What is declared of an option: its words, and which values it lets pass."""

from math import inf, nan

import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.options import Option


@pytest.mark.parametrize(
    ("option", "words"),
    [
        (Option("", 1, 40, "mm", default=10.0), "a number from 1 to 40 mm"),
        (Option("", 1, 40, default=10), "a whole number from 1 to 40"),
        (Option("", low=0, default=1.0), "a number of at least 0"),
        (Option("", high=0, default=0.0), "a number of at most 0"),
        (Option("", -0.1, 1, "mm"), "a number from -0.1 to 1 mm, or null"),
        (Option("", 0, 9, "characters", default=""), "a text of 0 to 9 characters"),
        (Option("", default=True), "true or false"),
        (Option("", default=1.0), "a number"),
    ],
)
def test_what_is_wanted_is_said_with_range_and_unit(option, words):
    assert option.wanted == words
    with pytest.raises(InputRefused) as refused:
        option.check("It", [])
    assert refused.value.code == "BadOption" and refused.value.remedy == f"Give {words}."


@pytest.mark.parametrize(
    ("default", "good", "bad"),
    [
        (2, (0, 9, 3), (-1, 10, 2.0, True, "2", None, 10**5000, -(10**5000), nan, inf, [], {})),
        (2.0, (0, 9, 8.5, 1e-300), (-1e-9, 9.1, nan, inf, -inf, True, "2", None, 10**5000, [2.0])),
        (None, (None, 0, 9.0), (nan, 9.1, False, "")),
        (True, (True, False), (0, 1, 1.0, None, "true")),
        ("", ("", "a" * 9), ("a" * 10, "a\0b", "\ud800", 3, None, [])),
    ],
)
def test_both_ends_pass_and_nothing_beyond(default, good, bad):
    option = Option("", 0, 9, default=default)
    assert all(option.check("It", value) is value for value in good)
    for value in bad:
        with pytest.raises(InputRefused, match="It was given as"):
            option.check("It", value)


def test_a_refusal_repeats_no_words_of_the_user():
    with pytest.raises(InputRefused) as refused:
        Option("", 0, 9, default=1.0).check("It", "/a/path of somebody")
    assert str(refused.value) == "It was given as text. Give a number from 0 to 9."


def test_a_slider_looks_through_the_usual_part():
    assert Option("", 0, 9).span == (0, 9) and Option("", 0, 9, usual=(1, 2)).span == (1, 2)
