"""Errors carry a code, a sentence and what to do."""

import pytest

from cranio_nb.errors import CannotWrite, CranioError, InputRefused, NoOpening


@pytest.mark.parametrize(("kind", "exit_code"), [(CranioError, 3), (InputRefused, 3), (NoOpening, 4), (CannotWrite, 5)])
def test_an_error_says_what_was_found_and_what_to_do(kind, exit_code):
    error = kind("NoHead", "There is no head.", "Give one.")
    assert isinstance(error, ValueError) and str(error) == "There is no head. Give one."
    assert (error.code, error.message, error.remedy, error.exit_code) == (
        "NoHead",
        "There is no head.",
        "Give one.",
        exit_code,
    )
    assert str(kind("NoHead", "There is no head.")) == "There is no head."
