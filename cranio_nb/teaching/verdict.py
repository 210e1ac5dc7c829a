"""What a check found, and the one line that says it: written by a lesson, read again when lessons are graded."""

from __future__ import annotations

import re
from dataclasses import dataclass

_LINE = re.compile(
    r"Exercise (?P<name>[\d.]+): (?P<points>\d+) of (?P<out_of>\d+) points\. (?P<message>.*?)"
    r"(?: (?P<compared>(?:Given \(|Case \d).*?: .*?\.))?"
    r"(?: (?P<hint>\(Ask for a hint .*\)|\(A hint .*\)|Hint \d of \d: .*))?"
)


@dataclass(frozen=True)
class Verdict:
    """What a check found; shown as one line.

    Parameters
    ----------
    name : str
        Number of the exercise.
    points, out_of : int
        Cases answered rightly, and cases tried.
    message : str
        Praise, or the cause of what is wrong.
    compared : str
        The first case that is wrong, the student's answer beside the right one; empty where there is none.
    hint : str
        Empty unless one was asked for.
    """

    name: str
    points: int
    out_of: int
    message: str
    compared: str = ""
    hint: str = ""

    @property
    def passed(self) -> bool:
        """Whether every case is right.

        Returns
        -------
        bool
        """
        return self.out_of > 0 and self.points == self.out_of

    def __repr__(self) -> str:
        line = f"Exercise {self.name}: {self.points} of {self.out_of} points."
        return " ".join([line, *(part for part in (self.message, self.compared, self.hint) if part)])


def read_verdict(line: str) -> Verdict | None:
    """What a line of a check says.

    Parameters
    ----------
    line : str

    Returns
    -------
    Verdict or None
        None where the line is none of a check.

    Examples
    --------
    >>> read_verdict("Exercise 4.1: 3 of 3 points. Right: well done.").passed
    True
    >>> read_verdict("4.1: all right!")
    """
    found = _LINE.fullmatch(line.strip())
    if found is None:
        return None
    parts = {name: text or "" for name, text in found.groupdict().items()}
    return Verdict(
        parts["name"],
        int(parts["points"]),
        int(parts["out_of"]),
        parts["message"],
        parts["compared"],
        parts["hint"],
    )
