"""A call within a time: the answer or the error of the function, and its end where it does not end by itself."""

import sys
import threading
from contextlib import suppress

import numpy as np
import pytest

from cranio_nb.teaching.time_limit import TookTooLongError, call_within

LONG_S = 600  # no test waits for it


def test_the_answer_and_the_errors_are_those_of_the_function():
    assert call_within(LONG_S, divmod, 17, 5) == (3, 2)
    with pytest.raises(ZeroDivisionError):
        call_within(LONG_S, divmod, 1, 0)
    with pytest.raises(SystemExit):
        call_within(LONG_S, sys.exit, 1)


def test_what_does_not_end_is_stopped_and_leaves_no_thread():
    before = threading.active_count()

    def count():
        number = 0
        while True:
            number += 1

    with pytest.raises(TookTooLongError):
        call_within(0.05, count)
    assert threading.active_count() == before


def test_a_loop_that_catches_every_exception_is_stopped():
    def stubborn():
        while True:
            with suppress(Exception):
                np.linalg.solve(np.zeros((2, 2)), np.zeros(2))

    with pytest.raises(TookTooLongError):
        call_within(0.05, stubborn)


def test_what_cannot_be_stopped_is_not_waited_for():
    """Compiled code that waits, as for a lock, is told to stop in vain."""
    lock, went_on = threading.Event(), threading.Event()

    def wait():
        lock.wait(LONG_S)
        went_on.set()

    with pytest.raises(TookTooLongError):
        call_within(0.05, wait)
    assert not went_on.is_set()
    lock.set()


def test_the_function_sees_the_settings_of_its_caller():
    with np.errstate(divide="raise"), pytest.raises(FloatingPointError):
        call_within(LONG_S, lambda: np.ones(1) / np.zeros(1))
