"""A student's answer and the right one -> both in a few words, where they differ most."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .rules import as_numbers

_FEW = 6  # numbers that are shown one and all
_DIGITS = (4, 6, 9, 15)  # as few as show the difference


def side_by_side(yours: Any, mine: Any, unit: str = "") -> str:
    """Two answers beside each other.

    Parameters
    ----------
    yours, mine : Any
        The student's answer, and the right one: a number, numbers or a mask.
    unit : str
        Of the numbers; what a mask is made of.

    Returns
    -------
    str
        Of masks, how many places are too many and how many lack; of many numbers, the place where they differ most.

    Examples
    --------
    >>> side_by_side(12, 3.1, "px")
    'yours 12, mine 3.1 px'
    >>> side_by_side([True, False, True], np.array([False, True, True]), "pixels")
    'yours and mine differ: 1 pixels too many, 1 missing'
    """
    right, given = np.asarray(mine), as_numbers(yours)
    if given is None:
        return f"yours is {_kind(yours)}, mine {_kind(mine)}"
    if given.shape != right.shape:
        return f"yours is {_kind(given)}, mine {_kind(right)}"
    if right.dtype == bool:
        return _masks(given, right, unit)
    if right.size <= _FEW:
        return _both(given.ravel(), right.ravel(), unit)
    # the place of the largest difference; what is no number counts as far away
    away = np.nan_to_num(np.abs(given.astype(float) - right), nan=np.inf)
    at = np.unravel_index(int(away.argmax()), right.shape)
    place = ", ".join(str(int(i)) for i in at)
    return f"at [{place}] {_both(given[at].reshape(1), right[at].reshape(1), unit)}"


def _kind(value: Any) -> str:
    """What sort of thing an answer is."""
    if value is None:
        return "nothing"
    found = as_numbers(value)
    if found is None:
        return f"a {type(value).__name__}"
    if found.ndim == 0:
        return "one number"
    return f"an array of shape {tuple(int(n) for n in found.shape)}"


def _masks(given: NDArray[Any], right: NDArray[np.bool_], unit: str) -> str:
    if not np.isin(given, (0, 1)).all():
        return f"yours runs from {given.min()} to {given.max()}, mine is True and False"
    if np.array_equal(given, right):
        return f"yours holds the right {unit} as numbers, mine as True and False"
    extra, missing = (np.count_nonzero(m) for m in (given.astype(bool) & ~right, ~given.astype(bool) & right))
    return f"yours and mine differ: {extra} {unit} too many, {missing} missing"


def _both(yours: NDArray[Any], mine: NDArray[Any], unit: str) -> str:
    """A few numbers beside each other, with as many digits as tell them apart."""
    after = f" {unit}" if unit else ""
    for digits in _DIGITS:
        one, other = (_written(numbers, digits) for numbers in (yours, mine))
        if one != other:
            break
    return f"yours {one}, mine {other}{after}"


def _written(numbers: NDArray[Any], digits: int) -> str:
    """Numbers as text, not as powers of ten unless they are tiny; in brackets if there are several."""
    texts = [_number(float(n), digits) for n in numbers]
    return texts[0] if len(texts) == 1 else f"({', '.join(texts)})"


def _number(value: float, digits: int) -> str:
    rounded = float(f"{value:.{digits}g}")
    return f"{rounded:.0f}" if 10**digits <= abs(rounded) < 1e15 else f"{rounded:.{digits}g}"
