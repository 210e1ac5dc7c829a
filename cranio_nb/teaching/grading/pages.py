"""Graded hand-ins -> a table as CSV, a page for each notebook, and a page on the class."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

from ...output.files import write_text
from ...output.pages import page_template
from ...output.staging import staged
from ..exercises import EXERCISES
from .marks import HandIn, cause

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
            write_text(part / "feedback" / _page_name(one), page)


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


def feedback_page(one: HandIn) -> str:
    """The page of one notebook: points, causes, hints, and the student's own lines.

    Parameters
    ----------
    one : HandIn

    Returns
    -------
    str
        HTML.
    """
    hints = {verdict.name: EXERCISES[verdict.name].hints for verdict in one.verdicts}
    return page_template("feedback.html").render(one=one, hints=hints, version=version("cranio-nb"))


def class_page(hand_ins: Sequence[HandIn]) -> str:
    """The page on all of them: which mistake how often, exercise by exercise, student by student.

    Parameters
    ----------
    hand_ins : sequence of HandIn

    Returns
    -------
    str
        HTML.
    """
    return page_template("class.html").render(
        hand_ins=hand_ins,
        n_students=len({one.student for one in hand_ins}),
        mistakes=mistakes(hand_ins),
        exercises=_exercises(hand_ins),
        pages=[_page_name(one) for one in hand_ins],
        version=version("cranio-nb"),
    )


def mistakes(hand_ins: Sequence[HandIn]) -> list[dict[str, Any]]:
    """The mistakes of a class, the most frequent first.

    Parameters
    ----------
    hand_ins : sequence of HandIn

    Returns
    -------
    list of dict
        "name" of the exercise, "cause", the "students" that made it, and "out_of" how many who handed it in.
    """
    found: dict[tuple[str, str], list[str]] = {}
    for one in hand_ins:
        for verdict in one.verdicts:
            if not verdict.passed:
                found.setdefault((verdict.name, cause(verdict)), []).append(one.student)
    handed_in = {row["name"]: row["n"] for row in _exercises(hand_ins)}
    rows = [
        {"name": name, "cause": words, "students": who, "out_of": handed_in[name]}
        for (name, words), who in found.items()
    ]
    order = list(EXERCISES)
    return sorted(rows, key=lambda row: (-len(row["students"]), order.index(row["name"])))


def _exercises(hand_ins: Sequence[HandIn]) -> list[dict[str, Any]]:
    """Each exercise that was handed in, with how many did, how many had all points, and the mean of the points."""
    rows = []
    for name in EXERCISES:
        got = [verdict for one in hand_ins for verdict in one.verdicts if verdict.name == name]
        if got:
            mean = sum(verdict.points for verdict in got) / len(got)
            passed = sum(verdict.passed for verdict in got)
            rows.append({"name": name, "n": len(got), "passed": passed, "mean": mean, "out_of": got[0].out_of})
    return rows


def _page_name(one: HandIn) -> str:
    return f"{one.student}.html" if one.student == one.notebook else f"{one.student}_{one.notebook}.html"


def _plain(value: Any) -> Any:
    """A cell that no table calculator takes for a formula."""
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value
