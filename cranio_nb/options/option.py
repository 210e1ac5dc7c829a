"""An option: what it means, which values it may have and in which unit."""

from __future__ import annotations

import os
from dataclasses import dataclass
from math import inf
from typing import Any

from ..errors import InputRefused

_LONG = 10**15  # from here a whole number is shown by its first digits


@dataclass(frozen=True)
class Option:
    """What may be given for an option, and what it is when nothing is given.

    Parameters
    ----------
    about : str
        What it does, as a sentence.
    low, high : float
        Least and largest number, both allowed; of a text the number of its characters. Without them any number.
    unit : str
        Of the number; empty where it only counts or is a ratio.
    usual : tuple of float, optional
        The part of the range that is worth a look, for sliders and studies; all of it when not given.
    default : bool, int, float, str or None
        Filled in from the parameter that is declared. Its kind is the kind that is wanted; None is the default of a
        number that follows from the data.
    whole : bool
        Whether a number has to be a whole one though the default does not say so.

    Examples
    --------
    >>> from cranio_nb.options import Option
    >>> reach = Option("Bone that is fitted.", 1, 40, "mm", default=10.0)
    >>> reach.wanted, reach.check("reach", 12.5)
    ('a number from 1 to 40 mm', 12.5)
    >>> reach.check("reach", float("nan"))
    Traceback (most recent call last):
    cranio_nb.errors.InputRefused: reach was given as nan. Give a number from 1 to 40 mm.
    """

    about: str
    low: float = -inf
    high: float = inf
    unit: str = ""
    usual: tuple[float, float] | None = None
    default: Any = None
    whole: bool = False

    @property
    def span(self) -> tuple[float, float]:
        """The ends between which a slider or a study looks.

        Returns
        -------
        tuple of float
        """
        return self.usual or (self.low, self.high)

    @property
    def kind(self) -> str:
        """What kind of value is wanted.

        Returns
        -------
        {"true or false", "text", "whole number", "number"}
        """
        if isinstance(self.default, bool):
            return "true or false"
        if isinstance(self.default, str):
            return "text"
        return "whole number" if self.whole or isinstance(self.default, int) else "number"

    @property
    def limits(self) -> str:
        """The range with its unit.

        Returns
        -------
        str
            Empty where there is none.
        """
        if (self.low, self.high) == (-inf, inf):
            return ""
        low, high = (f"{end:.12g}" for end in (self.low, self.high))
        if self.low > -inf and self.high < inf:
            ends = f"{low} to {high}"
        else:
            ends = f"at least {low}" if self.low > -inf else f"at most {high}"
        return f"{ends} {self.unit}".rstrip()

    @property
    def wanted(self) -> str:
        """The values that are allowed, in words.

        Returns
        -------
        str
        """
        if self.kind == "true or false":
            return self.kind
        # "a number from 1 to 40 mm", "a text of 0 to 4096 characters", "a number of at least 0"
        between = " from " if " to " in self.limits and self.kind != "text" else " of "
        words = f"a {self.kind}" + (between + self.limits if self.limits else "")
        return f"{words}, or null" if self.default is None else words

    def allows(self, value: Any) -> bool:
        """Whether a value may be given.

        Parameters
        ----------
        value : Any
            Whatever was given.

        Returns
        -------
        bool
        """
        if isinstance(self.default, bool):
            return isinstance(value, bool)
        if isinstance(self.default, str):
            return isinstance(value, str) and _is_plain(value) and self.low <= len(value) <= self.high
        if value is None:
            return self.default is None
        number = int if self.kind == "whole number" else int | float
        # not a number lies in no range; a truth value counts for none
        return isinstance(value, number) and not isinstance(value, bool) and bool(self.low <= value <= self.high)

    def check(self, name: str, value: Any) -> Any:
        """The value, refused where it may not be given.

        Parameters
        ----------
        name : str
            What the option is called, as the beginning of a sentence.
        value : Any
            Whatever was given.

        Returns
        -------
        Any
            `value`.

        Raises
        ------
        InputRefused
            ``BadOption``, with the range and its unit.
        """
        if not self.allows(value):
            raise InputRefused("BadOption", f"{name} was given as {_shown(value)}.", f"Give {self.wanted}.")
        return value


THRESHOLD = Option("Lowest HU of bone: above soft tissue, below metal.", 50, 3000, "HU", default=400.0)
"""Of bone in a CT: it stands here because a stage and the command line share it."""


def _is_plain(text: str) -> bool:
    """Whether a text may be handed to the system, as a path is."""
    try:
        return b"\0" not in os.fsencode(text)
    except UnicodeEncodeError:
        return False


def _shown(value: Any) -> str:
    """A value in a sentence. Words are not shown, since they may be a path or a name, nor what lists and dicts hold."""
    if isinstance(value, bool) or value is None:
        return str(value).lower() if isinstance(value, bool) else "null"
    if isinstance(value, int):
        return f"{value}" if abs(value) < _LONG else f"a whole number of {value.bit_length()} bits"
    words = {"str": "text", "list": "a list", "dict": "an object"}
    return f"{value:g}" if isinstance(value, float) else words.get(type(value).__name__, type(value).__name__)
