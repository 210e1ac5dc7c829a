"""A notebook as it ran -> points and causes, exercise by exercise."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from nbformat import NotebookNode

from ..exercises import EXERCISES, LESSONS
from ..verdict import Verdict, read_verdict
from .running import read_hand_in, run_hand_in

_CHECK = re.compile(r"check\.exercise\(\s*[\"'](\d+\.\d+)[\"']")
_NO_CAUSE = ("Not yet: ", "The answer does not have the right form")
UNNAMED = "Wrong, and the check knows no cause."
"""Stands for all answers whose cause has no sentence."""


@dataclass(frozen=True)
class HandIn:
    """What a student handed in, graded.

    Parameters
    ----------
    student : str
    notebook : str
        Name of the file, without its ending.
    verdicts : tuple of Verdict
        One for each exercise of the lesson.
    remark : str
        What kept the notebook from being read or run; else empty.
    code : tuple of str
        For each verdict the cell above the check, which holds the answer; empty where there is none.
    """

    student: str
    notebook: str
    verdicts: tuple[Verdict, ...]
    remark: str
    code: tuple[str, ...]

    @property
    def points(self) -> int:
        """Points of all exercises.

        Returns
        -------
        int
        """
        return sum(verdict.points for verdict in self.verdicts)

    @property
    def out_of(self) -> int:
        """Points to be had.

        Returns
        -------
        int
        """
        return sum(verdict.out_of for verdict in self.verdicts)


def grade(path: Path, student: str) -> HandIn:
    """Run a notebook and read off its checks; the last one of an exercise counts.

    Parameters
    ----------
    path : path
    student : str

    Returns
    -------
    HandIn
        Also where there is nothing to be run: then with no points, and a remark.
    """
    notebook, remark = read_hand_in(path)
    cells = notebook.cells
    remark = remark or run_hand_in(notebook)
    shown = {found.name: found for cell in cells for line in _lines(cell) if (found := read_verdict(line))}
    wanted = _exercises(path.stem, cells)
    verdicts = tuple(shown[name] if name in shown else _unchecked(name, cells) for name in wanted)
    return HandIn(student, path.stem, verdicts, remark, tuple(_answer_to(name, cells) for name in wanted))


def students(paths: Sequence[Path]) -> list[str]:
    """Whose notebooks these are: the folder's name, or the file's where it is not just the lesson's.

    Parameters
    ----------
    paths : sequence of path

    Returns
    -------
    list of str
        Folders above are put before a name that would stand twice for one lesson.

    Examples
    --------
    >>> students([Path("in/anna/00_tour.ipynb"), Path("in/bo/00_tour.ipynb"), Path("in/00_tour_cy.ipynb")])
    ['anna', 'bo', '00_tour_cy']
    """
    places = [Path(os.path.abspath(path)) for path in paths]
    names = [[place.parent.name] if place.stem in LESSONS else [place.stem] for place in places]
    above = [list(place.parents)[1 if place.stem in LESSONS else 0 :] for place in places]
    while twice := _twice(zip(map(tuple, names), places, strict=True)):
        for at in twice:
            names[at].insert(0, above[at].pop(0).name)
    return ["_".join(name) for name in names]


def cause(verdict: Verdict) -> str:
    """What a wrong answer is counted as, among those of a class.

    Parameters
    ----------
    verdict : Verdict

    Returns
    -------
    str
        Its sentence; `UNNAMED` where that only says how far off it is.

    Examples
    --------
    >>> cause(Verdict("4.1", 0, 3, "Not yet: off by up to 3 px; 1e-06 is allowed."))
    'Wrong, and the check knows no cause.'
    """
    return UNNAMED if verdict.message.startswith(_NO_CAUSE) else verdict.message


def _twice(named: Iterable[tuple[tuple[str, ...], Path]]) -> list[int]:
    """Places of those whose name stands for the same lesson as another's, and is not yet as long as can be."""
    listed = [(name, place.stem) for name, place in named]
    seen = Counter(listed)
    return [at for at, one in enumerate(listed) if seen[one] > 1]


def _lines(cell: NotebookNode) -> Iterator[str]:
    """The lines of text that a cell shows or prints."""
    for output in cell.get("outputs", ()):
        text = output.get("data", {}).get("text/plain", "") or (output.get("text", ""))
        yield from text.splitlines()


def _exercises(stem: str, cells: Sequence[NotebookNode]) -> list[str]:
    """Numbers of the exercises of the lessons that a notebook checks, or that it is named after."""
    asked = {number.split(".")[0] for cell in cells for number in _CHECK.findall(cell.source)}
    named = {str(at) for at, lesson in enumerate(LESSONS) if stem.startswith(lesson)}
    return [number for number in EXERCISES if number.split(".")[0] in asked | named]


def _check_cell(name: str, cells: Sequence[NotebookNode]) -> int | None:
    """Place of the last cell that checks an exercise."""
    return max((at for at, cell in enumerate(cells) if name in _CHECK.findall(cell.source)), default=None)


def _unchecked(name: str, cells: Sequence[NotebookNode]) -> Verdict:
    """The verdict where a check left no line."""
    at = _check_cell(name, cells)
    failed = [o for o in (cells[at].get("outputs", ()) if at is not None else ()) if o.output_type == "error"]
    if at is None:
        words = "The cell with the check is gone."
    elif failed:
        words = f"The cell with the check stopped with {failed[0].ename}: {failed[0].evalue}".splitlines()[0]
    else:
        words = "The check was not run."
    return Verdict(name, 0, len(EXERCISES[name].cases()), words)


def _answer_to(name: str, cells: Sequence[NotebookNode]) -> str:
    """The cell above a check."""
    at = _check_cell(name, cells)
    return str(cells[at - 1].source) if at else ""
