"""Graded hand-ins -> a folder: a table as CSV, a page for each notebook, and a page on the class."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ...output.files import write_text
from ...output.staging import staged
from .class_page import class_page
from .feedback_page import feedback_name, feedback_page
from .marks import HandIn

FILES = ("grades.csv", "class.html", "feedback")
"""What grading leaves in its folder."""
_COLUMNS = ("student", "notebook", "exercise", "points", "out_of", "mistake", "remark")
_FORMULA = ("=", "+", "-", "@", "\t", "\r")  # a table calculator takes text that begins so for a formula


def write_grades(hand_ins: Sequence[HandIn], out: Path) -> None:
    """Write the `FILES` of graded hand-ins.

    Parameters
    ----------
    hand_ins : sequence of HandIn
    out : path
        Made where it is missing.

    Raises
    ------
    CannotWrite
        If the system refuses.
    """
    pages = [feedback_page(one) for one in hand_ins]
    with staged(out, FILES) as part:
        write_text(part / "grades.csv", grades_csv(hand_ins))
        write_text(part / "class.html", class_page(hand_ins))
        (part / "feedback").mkdir()
        for one, page in zip(hand_ins, pages, strict=True):
            write_text(part / "feedback" / feedback_name(one), page)


def grades_csv(hand_ins: Sequence[HandIn]) -> str:
    """The table of points and mistakes.

    Parameters
    ----------
    hand_ins : sequence of HandIn

    Returns
    -------
    str
        CSV: a head, and a line for each exercise of each notebook; one line for a notebook of no lesson.

    Examples
    --------
    >>> print(grades_csv([HandIn("anna", "notes", (), "No notebook.", ())]))
    student,notebook,exercise,points,out_of,mistake,remark
    anna,notes,,0,0,,No notebook.
    <BLANKLINE>
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(_COLUMNS)
    for one in hand_ins:
        rows = [(v.name, v.points, v.out_of, "" if v.passed else v.message) for v in one.verdicts]
        for row in rows or [("", 0, 0, "")]:
            writer.writerow([_plain(value) for value in (one.student, one.notebook, *row, one.remark)])
    return text.getvalue()


def _plain(value: Any) -> Any:
    """A cell that no table calculator takes for a formula."""
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value
