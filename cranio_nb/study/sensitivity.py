"""Rows of one method -> how much of a measure's variance each parameter makes, alone and in pairs.

A share is epsilon squared of an analysis of variance, by levels of the parameter: the part of the variance between the
means of the levels, less what chance makes of it (Kelley 1935, doi 10.1073/pnas.21.9.554). From each value the mean of
its case is taken first, so that hard and easy cases do not count: all settings have seen the same cases.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InputRefused
from ..methods.catalogue import default_options
from ..options import THRESHOLD
from .plan import THRESHOLD_HU
from .store import Columns
from .summaries import values

_MOST_LEVELS = 6  # single values; more of them are put into classes
_CLASSES = 5


@dataclass(frozen=True, eq=False)
class Parameter:
    """What a parameter was in each row.

    Parameters
    ----------
    name : str
        With its unit; `THRESHOLD_HU` for the bone threshold.
    values : tuple
        One for each row; None where it followed from the data, or from the preset.
    level : ndarray of int, shape (rows,)
        Number of its level: a single value, or a class of neighbouring ones with equally many rows.
    labels : tuple of str
        Of the levels, rising; "auto" for None stands first.
    """

    name: str
    values: tuple[Any, ...]
    level: NDArray[np.intp]
    labels: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Effect:
    """What a parameter does to a measure.

    Parameters
    ----------
    parameter : Parameter
    key : str
        The measure.
    share : float
        Of the variance within cases, 0 to 1; nan where nothing varies.
    means, sds : ndarray, shape (levels,)
        Of the measure at each level, over all cases and other parameters; how cases differ is taken out.
    change : float
        From the lowest level to the highest, "auto" left out.
    """

    parameter: Parameter
    key: str
    share: float
    means: NDArray[np.float64]
    sds: NDArray[np.float64]
    change: float


def usual_options(columns: Columns) -> dict[str, Any]:
    """What options of a contender are when they are not given.

    Parameters
    ----------
    columns : Columns
        All of one contender.

    Returns
    -------
    dict
        The defaults of the method; empty for a preset, whose values may depend on the scan, and for a method that is
        not there, as an own one need not be when a report is made.
    """
    name, method = columns["contender"][0], columns["method"][0]
    try:
        return default_options(method) if name == method else {}
    except InputRefused:
        return {}


def parameters(columns: Columns, usual: Mapping[str, Any]) -> list[Parameter]:
    """The parameters that differ among rows of one contender.

    Parameters
    ----------
    columns : Columns
        All of one contender.
    usual : dict
        Its options where they are not given, see `usual_options`.

    Returns
    -------
    list of Parameter
    """
    given = [json.loads(text) for text in columns["options"]]
    names = list(dict.fromkeys(name for options in given for name in options))
    found = {name: [options.get(name, usual.get(name)) for options in given] for name in names}
    heights = columns["threshold_hu"]
    found[THRESHOLD_HU] = np.where(np.isnan(heights), THRESHOLD.default, heights).tolist()
    return [_parameter(name, column) for name, column in found.items() if len(set(column)) > 1]


def effects(columns: Columns, varied: Sequence[Parameter], key: str) -> list[Effect]:
    """What each parameter does to a measure.

    Parameters
    ----------
    columns : Columns
        Of one contender.
    varied : sequence of Parameter
    key : str
        The measure.

    Returns
    -------
    list of Effect
    """
    numbers = values(columns, key)
    centred = within_cases(numbers, columns["case"])
    lifted = centred + (np.nanmean(numbers) if np.isfinite(numbers).any() else np.nan)
    found = []
    for one in varied:
        means, sds = (
            np.array(
                [f(part) if len(part := _known(lifted[one.level == i])) else np.nan for i in range(len(one.labels))]
            )
            for f in (np.mean, np.std)
        )
        numeric = means[1:] if one.labels[0] == "auto" else means
        found.append(Effect(one, key, share(centred, one.level), means, sds, float(numeric[-1] - numeric[0])))
    return found


def interactions(columns: Columns, varied: Sequence[Parameter], key: str) -> dict[tuple[str, str], float]:
    """The share of the variance that two parameters make together, beyond what each makes alone.

    Parameters
    ----------
    columns : Columns
        Of one contender.
    varied : sequence of Parameter
    key : str
        The measure.

    Returns
    -------
    dict
        Two names -> share, not below 0; largest first.
    """
    centred = within_cases(values(columns, key), columns["case"])
    alone = {one.name: share(centred, one.level) for one in varied}
    found = {}
    for a, b in combinations(varied, 2):
        both = share(centred, a.level * len(b.labels) + b.level)
        found[a.name, b.name] = max(0.0, both - alone[a.name] - alone[b.name])
    return dict(sorted(found.items(), key=lambda item: -np.nan_to_num(item[1])))


def share(numbers: NDArray[np.float64], group: NDArray[np.intp]) -> float:
    """Epsilon squared: the share of the variance that groups explain, less what chance makes of it.

    Parameters
    ----------
    numbers : ndarray, shape (n,)
        nan is left out.
    group : ndarray of int, shape (n,)

    Returns
    -------
    float
        0 to 1; nan where nothing varies.

    Examples
    --------
    >>> share(np.array([1.0, 1.0, 2.0, 2.0]), np.array([0, 0, 1, 1]))
    1.0
    """
    seen = np.isfinite(numbers)
    numbers, group = numbers[seen], np.unique(group[seen], return_inverse=True)[1]
    if not len(numbers) or np.ptp(numbers) <= 1e-12 * np.abs(numbers).max():
        return float("nan")
    size = np.bincount(group)
    means = np.bincount(group, numbers) / size
    total = float(((numbers - numbers.mean()) ** 2).sum())
    within = float(((numbers - means[group]) ** 2).sum())
    free = len(numbers) - len(size)
    chance = (len(size) - 1) * within / free if free else 0.0
    return float(np.clip((total - within - chance) / total, 0.0, 1.0))


def within_cases(numbers: NDArray[np.float64], case: NDArray[np.object_]) -> NDArray[np.float64]:
    """Values less the mean of their case.

    Parameters
    ----------
    numbers : ndarray, shape (rows,)
    case : ndarray of str, shape (rows,)

    Returns
    -------
    ndarray, shape (rows,)
    """
    place = np.unique(case.astype(str), return_inverse=True)[1]
    seen = np.isfinite(numbers)
    size = np.bincount(place, seen)
    sums = np.bincount(place, np.where(seen, numbers, 0.0))
    return numbers - (sums / np.maximum(size, 1))[place]


def _parameter(name: str, column: list[Any]) -> Parameter:
    """A parameter with its levels."""
    known = sorted({value for value in column if value is not None}, key=lambda v: (isinstance(v, str), v))
    numeric = all(isinstance(value, int | float) and not isinstance(value, bool) for value in known)
    if numeric and len(known) > _MOST_LEVELS:
        given = np.array([np.nan if value is None else float(value) for value in column])
        edges = np.unique(np.nanquantile(given, np.linspace(0, 1, _CLASSES + 1)))
        level = np.digitize(given, edges[1:-1])
        labels = [f"{low:.3g} to {high:.3g}" for low, high in pairwise(edges)]
    else:
        place = {value: i for i, value in enumerate(known)}
        level = np.array([place.get(value, 0) for value in column])
        labels = [f"{value:.4g}" if numeric else str(value) for value in known]
    if None in column:
        level = np.where([value is None for value in column], 0, level + 1)
        labels = ["auto", *labels]
    return Parameter(name, tuple(column), level, tuple(labels))


def _known(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    return numbers[np.isfinite(numbers)]
