"""A graded hand-in -> a page for the student: points, causes, hints, and the answer as it was handed in."""

from __future__ import annotations

from importlib.metadata import version

from ...output.pages import page_template
from ..exercises import EXERCISES
from .marks import HandIn


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
    return page_template("feedback_page.html").render(one=one, hints=hints, version=version("cranio-nb"))


def feedback_name(one: HandIn) -> str:
    """Name of the file of that page.

    Parameters
    ----------
    one : HandIn

    Returns
    -------
    str

    Examples
    --------
    >>> feedback_name(HandIn("anna", "00_tour", (), "", ()))
    'anna_00_tour.html'
    """
    return f"{one.student}.html" if one.student == one.notebook else f"{one.student}_{one.notebook}.html"
