"""The options of a function are read off its signature, however its annotations are held."""

from typing import Annotated

import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.options import Option, declared


def as_objects(one, *, n: Annotated[int, Option("n", 0, 9, "px")] = 2, free=1.5):
    pass


def as_text(one, *, n: 'Annotated[int, Option("n", 0, 9, "px")]' = 2, free: "Unknown" = 1.5):  # noqa: F821
    pass


@pytest.mark.parametrize("function", [as_objects, as_text])
def test_options_are_read_off_the_parameters(function):
    assert declared(function) == {"n": Option("n", 0, 9, "px", default=2), "free": Option("", default=1.5)}


def test_a_declaration_that_cannot_be_read_is_not_passed_over():
    def lost(one, *, n: "Annotated[Nowhere, Option('n', 0, 9)]" = 2):  # noqa: F821
        pass

    with pytest.raises(InputRefused, match="Nowhere"):
        declared(lost)
