"""What is done in parts is done with each of them, once, and its error is told."""

import threading

import numpy as np
import pytest

from cranio_nb.geometry.side_by_side import side_by_side


def test_each_part_is_worked_on_once_and_what_it_writes_stays():
    found = np.zeros(50, int)

    def work(part):
        found[part] += part + 1

    side_by_side(work, np.array_split(np.arange(50), 7))
    np.testing.assert_array_equal(found, np.arange(50) + 1)


def test_two_parts_are_worked_on_at_a_time():
    meeting = threading.Barrier(2, timeout=20)  # broken, and an error, if they do not meet
    side_by_side(lambda _: meeting.wait(), range(2))


def test_the_error_of_a_part_is_raised():
    def work(part):
        if part == 3:
            raise ValueError("part 3")

    with pytest.raises(ValueError, match="part 3"):
        side_by_side(work, range(8))


def test_without_parts_nothing_is_done():
    side_by_side(lambda _: pytest.fail("there is no part"), [])
