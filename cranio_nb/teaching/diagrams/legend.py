"""The visual language in one picture: each mark as it is drawn, and what it means.

Frame: (x, y) to the right and up, in inches of the drawing.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...drawing.described import Described
from ...drawing.figures import Axes, Figure
from ...drawing.palette import (
    BLACK,
    BONE,
    INNER,
    MEASURE,
    NOTE_PT,
    OUTER,
    PATCH,
    PRESSURE,
    START,
    TANGENT,
    TRUTH,
    WHITE,
    faded,
)
from . import marks

_ROW, _COLUMN = 0.4, 2.67  # inches from one mark to the next
_MARK = 0.62  # width of a mark
_ROWS = 5
_LETTER = 0.07  # width of a letter of the words, on average
MEANINGS = (
    ("bone", "area", BONE),
    ("patch of a slice", "area", PATCH),
    ("outer side; the prosthesis", "line", OUTER),
    ("inner side", "line", INNER),
    ("edge of the true bone", "broad", faded(TRUTH)),
    ("start curve of a balloon", "dashes", START),
    ("balloon, its snaxels", "snaxels", OUTER),
    ("end of the gap", "end", BLACK),
    ("way the bone was going", "arrow", TANGENT),
    ("force of the curve: tension", "arrow", OUTER),
    ("force of the curve: rigidity", "hollow", OUTER),
    ("pressure", "arrow", PRESSURE),
    ("chord", "chord", MEASURE),
    ("a length that is measured", "length", MEASURE),
    ("sides of the patient", "letters", MEASURE),
)
"""What is drawn -> how, and in which colour."""


def legend() -> Described:
    """Draw every mark with its meaning.

    Returns
    -------
    Described
    """
    figure = marks.sheet(_ROWS * _ROW + 0.1)
    ax = marks.plane(figure, (0, 0, 1, 1), (0, 0), marks.WIDTH_IN)
    for i, (meaning, kind, colour) in enumerate(MEANINGS):
        x, y = 0.12 + _COLUMN * (i // _ROWS), _ROW * (_ROWS - i % _ROWS) - 0.15
        mark(ax, kind, colour, x, y)
        wide = 0.2 if kind == "letters" else 0.0
        marks.word(ax, (x + _MARK + 0.14 + wide, y), meaning, size=NOTE_PT, ha="left")
    alt = "Each mark of the drawings beside its meaning: " + ", ".join(meaning for meaning, *_ in MEANINGS) + "."
    return marks.finished(figure, alt, f"{len(MEANINGS)} marks")


def key_row(figure: Figure, height_in: float, meanings: Sequence[str]) -> None:
    """Draw some marks with their meanings in one row, at the foot of a drawing.

    Parameters
    ----------
    figure : Figure
    height_in : float
        Of the drawing.
    meanings : sequence of str
        As they stand in `MEANINGS`; of two, the first is written.
    """
    ax = marks.plane(figure, (0, 0, 1, _ROW / height_in), (0, 0), marks.WIDTH_IN)
    known = {meaning: (kind, colour) for meaning, kind, colour in MEANINGS}
    x = 0.05
    for meaning in meanings:
        words = meaning.partition(";")[0]
        mark(ax, *known[meaning], x, _ROW / 2, length=0.32)
        marks.word(ax, (x + 0.4, _ROW / 2), words, size=NOTE_PT, ha="left")
        x += 0.58 + _LETTER * len(words)


def mark(ax: Axes, kind: str, colour: str, x: float, y: float, *, length: float = _MARK) -> None:
    """Draw one mark from a place to the right.

    Parameters
    ----------
    ax : Axes
    kind, colour : str
        As they stand in `MEANINGS`.
    x, y, length : float
        Where it begins and how long it is, inches.
    """
    ends = np.array([[x, y], [x + length, y]])
    dashes = {"dashes": (0, (4, 1.6)), "chord": (0, (2, 2))}
    if kind == "area":
        ax.fill([x, x + length, x + length, x], [y - 0.11, y - 0.11, y + 0.11, y + 0.11], fc=colour, ec="none")
    elif kind in ("arrow", "hollow"):
        marks.arrow(ax, ends[0], ends[1], colour, width=2.2, hollow=kind == "hollow")
    elif kind == "length":
        marks.measure(ax, ends[0], ends[1])
    elif kind == "end":
        ax.plot(*ends.mean(axis=0), marker="o", ms=7, mfc=WHITE, mec=colour, mew=1.5)
    elif kind == "letters":
        marks.word(ax, (x - 0.05, y), "A P L R S I", colour=colour, weight="bold", ha="left")
    elif kind == "snaxels":
        marks.polyline(ax, np.linspace(ends[0], ends[1], 4), colour, marker="o", ms=4.5, mfc=WHITE, mew=1.5)
    else:
        width = {"broad": 7.0, "chord": 1.3}.get(kind, 2.2)
        marks.polyline(ax, ends, colour, lw=width, ls=dashes.get(kind, "-"))
