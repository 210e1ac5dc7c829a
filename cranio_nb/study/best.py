"""Rows of one method -> the setting that is best over all cases, and how far one may trust it.

The best of many settings looks better than it is: it was chosen by the cases that it is judged by. So each case is also
judged by the setting that is best on all *other* cases (leave one out).
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..pipeline.compare import MEASURES
from .sensitivity import Parameter
from .store import Columns
from .summaries import Spread, spread, values


@dataclass(frozen=True, eq=False)
class Best:
    """The best setting of a method.

    Parameters
    ----------
    contender, method : str
    options : dict
        Those that differ from the preset.
    threshold_hu : float or None
        None for the default.
    key : str
        The measure by which it is best.
    n_cases, n_settings : int
    found, usual : Spread
        Over the cases: of this setting, and of the defaults (nan where they were not run).
    better_in : int
        Cases in which it is better than the defaults.
    held_out : float
        Mean over the cases, each with the setting that is best on all others.
    by_case : dict
        Parameter -> least, middle and largest value among the settings that are best for a single case.
    """

    contender: str
    method: str
    options: dict[str, Any]
    threshold_hu: float | None
    key: str
    n_cases: int
    n_settings: int
    found: Spread
    usual: Spread
    better_in: int
    held_out: float
    by_case: dict[str, tuple[float, float, float]]

    @property
    def preset(self) -> str:
        """The preset that the options start from.

        Returns
        -------
        str
        """
        return self.contender.partition(":")[2] or "default"

    @property
    def file(self) -> str:
        """Name of the file with the options, for ``--params``.

        Returns
        -------
        str
        """
        return f"best-{self.contender.replace(':', '-')}.json"

    @property
    def command(self) -> str:
        """The command line that designs with it.

        Returns
        -------
        str
        """
        preset = "" if self.preset == "default" else f" --preset {self.preset}"
        threshold = "" if self.threshold_hu is None else f" --threshold {self.threshold_hu:g}"
        return f"cranio-nb design SCAN --method {self.method}{preset}{threshold} --params {self.file} --out OUT"


def target_of(columns: Columns) -> str:
    """The measure that settings are judged by: DSC where a truth is known, else the gap at the rim.

    Parameters
    ----------
    columns : Columns

    Returns
    -------
    str
        One of `MEASURES`.
    """
    return "dice" if np.isfinite(columns["dice"]).any() else "rim_gap"


def best_setting(columns: Columns, key: str, varied: Sequence[Parameter] = ()) -> Best | None:
    """The setting with the best mean over all cases.

    Parameters
    ----------
    columns : Columns
        Of one contender.
    key : str
        The measure, one that has a better end.
    varied : sequence of Parameter
        Of the same rows: those whose best values for single cases are told.

    Returns
    -------
    Best or None
        None where no setting has a value.
    """
    names, settings, table = _table(columns, key)
    # a study may not have ended: cases that most settings have seen, then settings that miss none of these
    known = np.isfinite(table)
    table = table[2 * known.sum(axis=1) >= known.sum(axis=1).max(initial=1)]
    seen = np.isfinite(table).sum(axis=0)
    whole = np.flatnonzero(seen == seen.max(initial=1))
    if not len(whole):
        return None
    table = table[np.isfinite(table[:, whole]).any(axis=1)][:, whole]
    settings = [settings[i] for i in whole]
    sign = 1.0 if MEASURES[key].best == "high" else -1.0
    at = int(np.argmax(np.nanmean(sign * table, axis=0)))
    usual = settings.index(("{}", None)) if ("{}", None) in settings else None
    beside = np.full(len(table), np.nan) if usual is None else table[:, usual]
    options, threshold = settings[at]
    return Best(
        *names,
        json.loads(options),
        threshold,
        key,
        len(table),
        len(settings),
        spread(table[:, at], key),
        spread(beside, key),
        int((sign * table[:, at] > sign * beside).sum()),
        _held_out(table, sign),
        _by_case(columns, varied, settings, table, sign),
    )


def chosen(columns: Columns, options: dict[str, Any], threshold_hu: float | None) -> NDArray[np.bool_]:
    """Which rows are of a setting.

    Parameters
    ----------
    columns : Columns
    options : dict
    threshold_hu : float or None

    Returns
    -------
    ndarray of bool, shape (rows,)
    """
    height = columns["threshold_hu"]
    same = np.isnan(height) if threshold_hu is None else height == threshold_hu
    return same & (columns["options"] == json.dumps(options, sort_keys=True))


def _table(columns: Columns, key: str) -> tuple[tuple[str, str], list[tuple[str, float | None]], NDArray[np.float64]]:
    """Names of the contender and its method, its settings, and the measure of each case (rows) with each of them.

    A run that failed has the worst value that there is, where the measure itself knows none.
    """
    numbers = values(columns, key)
    failed = np.isin(columns["status"], ("no patch", "broken")) & ~np.isfinite(numbers)
    if np.isfinite(numbers).any():
        numbers = np.where(failed, spread(numbers, key).worst, numbers)
    heights = [None if np.isnan(h) else float(h) for h in columns["threshold_hu"]]
    asked = list(zip(columns["options"], heights, strict=True))
    settings = {one: i for i, one in enumerate(dict.fromkeys(asked))}
    cases = {one: i for i, one in enumerate(dict.fromkeys(columns["case"]))}
    table = np.full((len(cases), len(settings)), np.nan)
    for case, one, number in zip(columns["case"], asked, numbers, strict=True):
        table[cases[case], settings[one]] = number
    return (columns["contender"][0], columns["method"][0]), list(settings), table


def _held_out(table: NDArray[np.float64], sign: float) -> float:
    """Mean over the cases, each with the setting that is best on all others."""
    if len(table) < 2:
        return float("nan")
    known = np.nan_to_num(table)
    others = sign * (known.sum(axis=0) - known)  # sums rank as means do: no setting misses a case
    return float(np.mean(table[np.arange(len(table)), np.argmax(others, axis=1)]))


def _by_case(
    columns: Columns,
    varied: Sequence[Parameter],
    settings: list[tuple[str, float | None]],
    table: NDArray[np.float64],
    sign: float,
) -> dict[str, tuple[float, float, float]]:
    """Where the settings lie that are best for single cases."""
    winners = [settings[i] for i in np.nanargmax(sign * table, axis=1)]
    heights = [None if np.isnan(h) else float(h) for h in columns["threshold_hu"]]
    row = {one: i for i, one in enumerate(zip(columns["options"], heights, strict=True))}
    found = {}
    for one in varied:
        won = [one.values[row[winner]] for winner in winners]
        numbers = [float(v) for v in won if isinstance(v, int | float) and not isinstance(v, bool)]
        if numbers:
            found[one.name] = (min(numbers), float(np.median(numbers)), max(numbers))
    return found
