"""Graded hand-ins -> a page on the class: which mistake how often, exercise by exercise, student by student."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

from ...output.pages import page_template
from ..exercises import EXERCISES
from .feedback_page import feedback_name
from .marks import HandIn, cause


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
    return page_template("class_page.html").render(
        hand_ins=hand_ins,
        n_students=len({one.student for one in hand_ins}),
        mistakes=mistakes(hand_ins),
        exercises=_exercises(hand_ins),
        pages=[feedback_name(one) for one in hand_ins],
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
