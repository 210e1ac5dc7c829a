"""A panel's controls -> the few values of each that are drawn ahead.

A panel has far more settings than a site can hold. Its main controls are kept, and of a slider some stops: even steps
from end to end, close ones at the start of a film, and every value that the lesson's text names. Folded controls stay
as they are where the panel is shown; where a preset moves some, one more control chooses among these presets.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import prod
from typing import Any

import numpy as np

from ..widgets import Panel
from ..widgets.controls import START, Choice, Control, Slider

SETTING = "setting"
"""Name of the control that chooses among presets of folded controls."""
_AS_SHOWN = "as shown"
_PAIR = r"\b{}\s*=\s*(-?[\d.]+\d|\d+)"  # in the text of a lesson: plane=30


@dataclass(frozen=True)
class Axis:
    """A control and those of its stops that are drawn.

    Parameters
    ----------
    control : Slider, Choice or Switch
    stops : tuple
        Of the control's own, in its order.
    start : int
        Place of the value that is shown first.
    cyclic : bool
        Whether the first stop comes after the last one.
    presets : mapping
        Of the control `SETTING`: preset -> values of folded controls.
    """

    control: Control
    stops: tuple[Any, ...]
    start: int
    cyclic: bool = False
    presets: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    def values(self, stop: Any) -> dict[str, Any]:
        """Values of the panel's controls at a stop.

        Parameters
        ----------
        stop : float, str or bool

        Returns
        -------
        dict
            By name of the control.
        """
        if self.control.name == SETTING:
            return dict(self.presets.get(stop, {}))
        return {self.control.name: stop}


def axes_of(panel: Panel, text: str, n_frames: int) -> tuple[Axis, ...]:
    """What can be moved on the site.

    Parameters
    ----------
    panel : Panel
        As the lesson shows it.
    text : str
        Of the lesson; values that it names are kept.
    n_frames : int
        How many pictures there may be, about: values that are named come on top.

    Returns
    -------
    tuple of Axis
        One for each control that is not folded away.
    """
    main = [control for control in panel.controls.values() if not control.expert]
    wanted = {control.name: wanted_values(panel, control, text) for control in main}
    most = [_most_stops(control, wanted[control.name]) for control in main]
    settings = _settings(panel)
    axes = list(settings)
    n_frames //= prod(len(axis.stops) for axis in settings)
    for control, n in zip(main, share_frames(most, n_frames), strict=True):
        stops = thinned(control, n, wanted[control.name]) if isinstance(control, Slider) else control.stops
        axes.append(Axis(control, stops, stops.index(panel.values[control.name])))
    return tuple(axes)


def _settings(panel: Panel) -> tuple[Axis, ...]:
    """The axis of the presets that move folded controls, if there are any and pictures are quick."""
    folded = {name for name, control in panel.controls.items() if control.expert}
    found = {name: {other: values[other] for other in folded & values.keys()} for name, values in panel.presets.items()}
    found = {name: moved for name, moved in found.items() if moved}
    if panel.slow or not found:
        return ()
    stops = (_AS_SHOWN, *found)
    return (Axis(Choice(SETTING, "more settings", stops, _AS_SHOWN), stops, 0, presets=found),)


def _most_stops(control: Control, wanted: set[Any]) -> int:
    """How many of a control's stops may be drawn."""
    if isinstance(control, Slider) and control.ahead is not None:
        return control.ahead + len(wanted)
    return len(control.stops)


def wanted_values(panel: Panel, control: Control, text: str) -> set[Any]:
    """Values that must be drawn: those shown first and near them, those of the presets, those that a text names.

    Parameters
    ----------
    panel : Panel
    control : Slider, Choice or Switch
        One of its controls.
    text : str

    Returns
    -------
    set
        Stops of the control.
    """
    found = {control.value, panel.values[control.name]}
    found |= {values[control.name] for values in panel.presets.values() if control.name in values}
    if isinstance(control, Slider):
        found |= {float(hit) for hit in re.findall(_PAIR.format(control.name), text)}
        at = control.stops.index(control.taken(panel.values[control.name]))
        found |= set(control.stops[max(at - control.near, 0) : at + control.near + 1])
    return {control.taken(value) for value in found}


def share_frames(lengths: Sequence[int], n_frames: int) -> list[int]:
    """How many stops each control may have, so that all combinations come to a number of pictures.

    Parameters
    ----------
    lengths : sequence of int
        How many stops each has.
    n_frames : int

    Returns
    -------
    list of int
        At least two for each, or all that it has.

    Examples
    --------
    >>> share_frames([2, 60, 200], 200)  # the short one whole, the rest alike
    [2, 10, 10]
    >>> share_frames([5], 200)
    [5]
    """
    counts = [0] * len(lengths)
    left = n_frames
    # the shortest first: what it leaves over goes to the others
    order = sorted(range(len(lengths)), key=lengths.__getitem__)
    for done, i in enumerate(order):
        fair = int(left ** (1 / (len(order) - done)) + 1e-9)
        counts[i] = min(lengths[i], max(fair, 2))
        left = max(n_frames // prod(counts[j] for j in order[: done + 1]), 1)
    return counts


def thinned(slider: Slider, n: int, wanted: set[float]) -> tuple[float, ...]:
    """Some of a slider's stops: both ends, even steps between them, and those that are wanted.

    Parameters
    ----------
    slider : Slider
        One that can be played gets ever longer steps, for a film begins fast.
    n : int
        About how many: fewer where it says how many are drawn ahead, and the wanted ones come on top.
    wanted : set of float
        Stops of the slider.

    Returns
    -------
    tuple of float
        Rising.

    Examples
    --------
    >>> thinned(Slider("n", "snaxels", 0, 100, 0), 5, {30})
    (0, 25, 30, 50, 75, 100)
    >>> thinned(Slider("step", "step", 0, 100, 0, player=True), 5, set())
    (0, 2, 9, 31, 100)
    >>> thinned(Slider("centre", "centre", -1000, 2000, 300, ahead=0), 9, {40, 300})
    (40, 300)
    """
    last = len(slider.stops) - 1
    n = n if slider.ahead is None else slider.ahead
    if n > last:
        return slider.stops
    places = np.expm1(np.linspace(0, np.log1p(last), n)) if slider.player else np.linspace(0, last, n)
    kept = {slider.stops[int(place)] for place in np.rint(places)} | wanted
    return tuple(stop for stop in slider.stops if stop in kept)


def presets_on(axes: Sequence[Axis], panel: Panel) -> dict[str, Mapping[str, Any]]:
    """The presets that can be gone to with these axes alone; the start is what the lesson shows.

    Parameters
    ----------
    axes : sequence of Axis
    panel : Panel
        As the lesson shows it.

    Returns
    -------
    dict of str to mapping
        Name of the preset -> values by name of the axes' controls.
    """
    moved = {axis.control.name for axis in axes}
    settings: set[str] = set().union(*(axis.presets for axis in axes))
    found: dict[str, Mapping[str, Any]] = {}
    for name, values in ({START: panel.values} | panel.presets).items():
        kept = {other: value for other, value in values.items() if other in moved}
        if name in settings:
            found[name] = kept | {SETTING: name}
        elif all(panel.values[other] == value for other, value in values.items() if other not in moved):
            found[name] = kept | ({SETTING: _AS_SHOWN} if settings and name == START else {})
    return found
