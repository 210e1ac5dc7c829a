"""Rows -> mean, standard deviation and worst value of each measure, over all of them and by classes."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..pipeline.compare import MEASURES
from .run import FAILED
from .store import Columns

SIZES_MM = (0.0, 20.0, 40.0, 60.0, 80.0, 100.0, np.inf)
"""Edges of the classes by size."""
LOST = ("dice", "border_dice")
"""Measures that a failed run has, too: it overlaps with nothing."""


class Spread(NamedTuple):
    """Values in three numbers, nan where there are none.

    Parameters
    ----------
    mean, sd : float
        Mean, and standard deviation of the population.
    worst : float
        At the end that is not better; for a ratio the one farthest from 1.
    """

    mean: float
    sd: float
    worst: float


def values(columns: Columns, key: str) -> NDArray[np.float64]:
    """A measure of each row: 0 for the overlap of a run that failed, nan for what is not known.

    Parameters
    ----------
    columns : Columns
    key : str
        One of `MEASURES`.

    Returns
    -------
    ndarray of float64, shape (rows,)
    """
    failed = np.isin(columns["status"], FAILED)
    return np.where(failed, 0.0 if key in LOST else np.nan, columns[key]).astype(float)


def spread(numbers: NDArray[np.float64], key: str) -> Spread:
    """Mean, standard deviation and worst value of a measure.

    Parameters
    ----------
    numbers : ndarray, shape (rows,)
        nan is left out.
    key : str
        One of `MEASURES`.

    Returns
    -------
    Spread

    Examples
    --------
    >>> spread(np.array([0.9, 0.8, 0.7]), "dice").worst
    0.7
    """
    known = numbers[np.isfinite(numbers)]
    if not len(known):
        return Spread(np.nan, np.nan, np.nan)
    off = {"high": -known, "low": known, "": np.abs(known - 1)}[MEASURES[key].best]
    return Spread(float(known.mean()), float(known.std()), float(known[np.argmax(off)]))


def summary(columns: Columns) -> dict[str, Spread]:
    """The spread of every measure.

    Parameters
    ----------
    columns : Columns

    Returns
    -------
    dict of str to Spread
    """
    return {key: spread(values(columns, key), key) for key in MEASURES}


def counts(columns: Columns) -> str:
    """How many runs there are, and how many failed or were refused.

    Parameters
    ----------
    columns : Columns

    Returns
    -------
    str
    """
    states = list(columns["status"])
    failed = sum(state in FAILED for state in states)
    return f"{states.count('done')} done, {failed} failed, {states.count('refused')} refused"


def where(columns: Columns, chosen: NDArray[np.bool_]) -> Columns:
    """Some of the rows.

    Parameters
    ----------
    columns : Columns
    chosen : ndarray of bool, shape (rows,)

    Returns
    -------
    Columns
    """
    return {name: column[chosen] for name, column in columns.items()}


def places(columns: Columns) -> NDArray[np.object_]:
    """The class of each row by place: the kind of hole that was asked for, else where the largest one was found.

    Parameters
    ----------
    columns : Columns

    Returns
    -------
    ndarray of str, shape (rows,)
    """
    found = np.where(columns["defect"] != "", columns["defect"], columns["place"])
    return np.where(found != "", found, "not known").astype(object)


def sizes(columns: Columns, edges_mm: Sequence[float] = SIZES_MM) -> NDArray[np.object_]:
    """The class of each row by size: the length of the largest opening found, else the diameter asked for.

    Parameters
    ----------
    columns : Columns
    edges_mm : sequence of float
        Rising.

    Returns
    -------
    ndarray of str, shape (rows,)

    Examples
    --------
    >>> sizes({"length_mm": np.array([15.0, np.nan, np.nan]), "asked_mm": np.array([np.nan, 200.0, np.nan])}).tolist()
    ['up to 20 mm', 'above 100 mm', 'not known']
    """
    length = np.where(np.isfinite(columns["length_mm"]), columns["length_mm"], columns["asked_mm"])
    names = [f"{low:g} to {high:g} mm" for low, high in pairwise(edges_mm)]
    names[0], names[-1] = f"up to {edges_mm[1]:g} mm", f"above {edges_mm[-2]:g} mm"
    at = np.digitize(np.nan_to_num(length), edges_mm[1:-1])
    return np.where(np.isfinite(length), np.array(names, object)[at], "not known").astype(object)
