"""The rows of one contender -> what a page says of it: best setting, spreads, sensitivity, interactions, pictures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..drawing import figures
from ..output.pages import Shot, shot
from ..pipeline.compare import MEASURES
from .best import Best, best_setting, chosen
from .sensitivity import Effect, Parameter, effects, interactions, parameters, usual_options
from .store import Columns
from .summaries import Spread, counts, places, sizes, spread, summary, values, where

_PAIRS = 10  # interactions shown


@dataclass(frozen=True, eq=False)
class Part:
    """What a page says of one contender.

    Parameters
    ----------
    name : str
    counts : str
        Runs done, failed and refused.
    best : Best or None
    tables : dict
        Name of a setting ("defaults", "best setting") -> measure -> spread over the cases.
    classes : list of tuple
        Title, then rows of (class, number of cases, measure -> spread), of the best setting.
    effects : dict
        Parameter -> measure -> its effect.
    pairs : list of tuple
        Two parameters and their share, largest first.
    pictures : list of Shot
        Of the effects, and of the strongest pair.
    """

    name: str
    counts: str
    best: Best | None
    tables: dict[str, dict[str, Spread]]
    classes: list[tuple[str, list[tuple[str, int, dict[str, Spread]]]]]
    effects: dict[str, dict[str, Effect]]
    pairs: list[tuple[str, str, float]]
    pictures: list[Shot]


def by_contender(columns: Columns) -> list[Columns]:
    """The rows of each contender, in the order of their names.

    Parameters
    ----------
    columns : Columns

    Returns
    -------
    list of Columns
    """
    return [where(columns, columns["contender"] == name) for name in sorted(set(columns["contender"]))]


def contender_part(columns: Columns, target: str) -> Part:
    """What the page says of a contender.

    Parameters
    ----------
    columns : Columns
        Of one contender.
    target : str
        The measure by which settings are judged.

    Returns
    -------
    Part
    """
    varied = parameters(columns, usual_options(columns))
    best = best_setting(columns, target, varied)
    settings = {"defaults": where(columns, chosen(columns, {}, None))}
    if best is not None and (best.options or best.threshold_hu is not None):
        settings["best setting"] = where(columns, chosen(columns, best.options, best.threshold_hu))
    settings = {name: rows for name, rows in settings.items() if len(rows["key"])}
    found: dict[str, dict[str, Effect]] = {one.name: {} for one in varied}
    for key in MEASURES:
        for effect in effects(columns, varied, key):
            found[effect.parameter.name][key] = effect
    pairs = [(*names, share) for names, share in interactions(columns, varied, target).items() if share > 0]
    last = list(settings.values())[-1:]
    return Part(
        columns["contender"][0],
        counts(columns),
        best,
        {name: summary(rows) for name, rows in settings.items()},
        [(title, class_rows(rows, split)) for rows in last for title, split in _CLASSES.items()],
        found,
        pairs[:_PAIRS],
        _pictures(columns, varied, found, pairs, target),
    )


_CLASSES: dict[str, Callable[[Columns], NDArray[np.object_]]] = {"by size": sizes, "by place": places}


def class_rows(
    columns: Columns, split: Callable[[Columns], NDArray[np.object_]]
) -> list[tuple[str, int, dict[str, Spread]]]:
    """Spreads by classes.

    Parameters
    ----------
    columns : Columns
        Of one setting.
    split : callable
        Gives the class of each row.

    Returns
    -------
    list of tuple
        Name of the class, number of its rows, measure -> spread.
    """
    names = split(columns)
    order = sorted(
        set(names), key=lambda name: (float(np.nanmin([*columns["length_mm"][names == name], np.inf])), name)
    )
    return [(name, int((names == name).sum()), summary(where(columns, names == name))) for name in order]


def _pictures(
    columns: Columns,
    varied: Sequence[Parameter],
    found: dict[str, dict[str, Effect]],
    pairs: Sequence[tuple[str, str, float]],
    target: str,
) -> list[Shot]:
    """The effects on the target, and the strongest pair."""
    if not varied:
        return []
    what = MEASURES[target]
    label = f"{what.label} ({what.unit})" if what.unit else what.label
    rows: list[Any] = [found[one.name][target] for one in varied]
    panels = [figures.Panel(e.parameter.name, e.parameter.labels, e.means, e.sds) for e in rows]
    alt = f"{label} against {', '.join(panel.name for panel in panels)}: lines are means, bands one standard deviation."
    shots = [shot(figures.effects_figure(panels, label), alt=alt, caption="Mean and standard deviation at each level")]
    if pairs:
        a, b = (next(one for one in varied if one.name == name) for name in pairs[0][:2])
        table = pair_table(values(columns, target), a, b)
        figure = figures.pair_figure(table, (a.name, a.labels), (b.name, b.labels), label, digits=what.digits)
        alt = f"Table of colours: mean {label} at each level of {a.name} and {b.name}."
        shots.append(shot(figure, alt=alt, caption="The pair with the strongest interaction"))
    return shots


def pair_table(numbers: NDArray[np.float64], a: Parameter, b: Parameter) -> NDArray[np.float64]:
    """Means of a measure at the levels of two parameters.

    Parameters
    ----------
    numbers : ndarray, shape (rows,)
        nan is left out.
    a, b : Parameter

    Returns
    -------
    ndarray, shape (levels of a, levels of b)
        nan where nothing is known.
    """
    levels = ((i, j) for i in range(len(a.labels)) for j in range(len(b.labels)))
    means = [spread(numbers[(a.level == i) & (b.level == j)], "dice").mean for i, j in levels]
    return np.array(means).reshape(len(a.labels), len(b.labels))
