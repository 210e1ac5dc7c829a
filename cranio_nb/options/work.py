"""How much a method may be asked to compute: options that are each in range can be too much together."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from ..errors import InputRefused


@dataclass(frozen=True)
class Work:
    """What a method computes at most with its options, counted in steps and not in seconds.

    Parameters
    ----------
    about : str
        What is counted, as the beginning of a sentence.
    most : float
        So many are computed at most.
    amount : callable
        Every option of the method, by name -> how many.
    remedy : str
        What lowers it, as a sentence.

    Examples
    --------
    >>> from cranio_nb.options import Work
    >>> work = Work("The points", 100, lambda options: options["rows"] * options["columns"], "Give fewer rows.")
    >>> work.check({"rows": 10, "columns": 10})
    >>> work.check({"rows": 10, "columns": 20})
    Traceback (most recent call last):
    cranio_nb.errors.InputRefused: The points would be 200; at most 100 are computed. Give fewer rows.
    """

    about: str
    most: float
    amount: Callable[[Mapping[str, Any]], float]
    remedy: str

    def check(self, options: Mapping[str, Any]) -> None:
        """Refuse options that ask for too much together.

        Parameters
        ----------
        options : dict
            All of the method, each in its range.

        Raises
        ------
        InputRefused
            ``TooMuchWork``, with the amount and the limit.
        """
        amount = self.amount(options)
        if amount > self.most:
            message = f"{self.about} would be {amount:,.0f}; at most {self.most:,.0f} are computed."
            raise InputRefused("TooMuchWork", message, self.remedy)
