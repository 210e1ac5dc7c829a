"""What an exercise is, the ways to compare two answers, and the phantom that answers are tried on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from data_synth import Case


@cache
def small_head() -> Case:
    """The tiny phantom; its arrays are read-only.

    Returns
    -------
    data_synth.Case
    """
    from data_synth import phantom_case

    # read-only: one exercise cannot spoil the case of the next
    case = phantom_case("tiny")
    for array in (case.hu, case.bone, case.implant, case.affine):
        assert array is not None
        array.setflags(write=False)
    return case


def largest_difference(answer: ArrayLike, right: ArrayLike) -> float:
    """Largest absolute difference of two arrays or numbers.

    Parameters
    ----------
    answer, right : array_like

    Returns
    -------
    float
        In their unit; inf where the shapes differ.

    Examples
    --------
    >>> largest_difference([1, 2], [1, 5]), largest_difference([1, 2], 1)
    (3.0, inf)
    """
    a, b = np.asarray(answer, float), np.asarray(right, float)
    if a.shape != b.shape:
        return float("inf")
    return float(np.abs(a - b).max(initial=0.0))


def different_bools(answer: ArrayLike, right: NDArray[np.bool_]) -> float:
    """Number of pixels in which two masks differ, where only bool will do: `~` of the number 1 is -2.

    Parameters
    ----------
    answer : array_like
    right : ndarray of bool

    Returns
    -------
    float
        inf where the answer is no bool mask of that shape.

    Examples
    --------
    >>> different_bools([True, False], np.ones(2, bool)), different_bools([1, 1], np.ones(2, bool))
    (1.0, inf)
    """
    a = np.asarray(answer)
    if a.shape != right.shape or a.dtype != bool:
        return float("inf")
    return float(np.count_nonzero(a ^ right))


def degrees_apart(answer: ArrayLike, right: ArrayLike) -> float:
    """Angle between two directions, whichever way they point.

    Parameters
    ----------
    answer, right : array_like, shape (n,)
        Of any length but 0.

    Returns
    -------
    float
        Degrees, 0 to 90; inf where the answer is no direction.

    Examples
    --------
    >>> round(degrees_apart([-2, 0], [1, 1]), 6)
    45.0
    """
    a, b = np.asarray(answer, float), np.asarray(right, float)
    if a.shape != b.shape or not np.linalg.norm(a) > 0:
        return float("inf")
    # a line has no sign, hence the absolute value
    cosine = abs(a @ b) / np.linalg.norm(a) / np.linalg.norm(b)
    return float(np.degrees(np.arccos(min(cosine, 1.0))))


@dataclass(frozen=True, eq=False)
class Answer:
    """What an answer looks like, and when it is right.

    Parameters
    ----------
    form : str
        In words, for answers that cannot be compared.
    unit : str
    tolerance : float
        Largest error that is right, in `unit`.
    error : callable
        (answer, right answer) -> how far apart they are, in `unit`.
    shows : tuple of (callable, str) or None
        Answer -> what of it is shown beside the right one, and its unit; None for the answer itself, in `unit`.
    """

    form: str
    _: KW_ONLY
    unit: str
    tolerance: float
    error: Callable[[Any, Any], float] = largest_difference
    shows: tuple[Callable[[Any], Any], str] | None = None


@dataclass(frozen=True, eq=False, kw_only=True)
class Exercise:
    """One exercise.

    Parameters
    ----------
    cases : callable
        () -> list of argument tuples; each is worth a point.
    right : callable
        The answer.
    answer : Answer
        What one looks like, and how near to `right` it has to be.
    mistakes : tuple of (callable, str)
        Typical wrong answers, and what to say to whoever gives them.
    hints : tuple of str
        From a push to nearly all, never the whole line.
    praise : str
        What a right answer has shown.
    """

    cases: Callable[[], list[tuple[Any, ...]]]
    right: Callable[..., Any]
    answer: Answer
    mistakes: tuple[tuple[Callable[..., Any], str], ...]
    hints: tuple[str, ...]
    praise: str
