"""What a reader may move on a panel, as plain values, and what the panel then shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Slider:
    """A number to choose.

    Parameters
    ----------
    name : str
    label : str
        Names it, with its unit.
    low, high, value, step : float
    log : bool
        Whether values are spaced evenly in their logarithm; `step` is not used then.
    player : bool
        Whether it can be played.
    """

    name: str
    label: str
    low: float
    high: float
    value: float
    step: float = 1.0
    log: bool = False
    player: bool = False


@dataclass(frozen=True)
class Choice:
    """One of a few words to choose.

    Parameters
    ----------
    name, label : str
    options : tuple of str
    value : str
    """

    name: str
    label: str
    options: tuple[str, ...]
    value: str


@dataclass(frozen=True)
class Switch:
    """Something to turn on and off.

    Parameters
    ----------
    name, label : str
    value : bool
    """

    name: str
    label: str
    value: bool


Control = Slider | Choice | Switch


@dataclass(frozen=True, eq=False)
class View:
    """What a panel shows for one setting of its controls.

    Parameters
    ----------
    rgb : ndarray of uint8, shape (H, W, 3)
    line : str
        One line in words and numbers, the same on every run.
    limits : dict of str to float
        New upper ends of sliders, by name.
    off : tuple of str
        Controls without effect at this setting.
    """

    rgb: NDArray[np.uint8]
    line: str
    limits: dict[str, float] | None = None
    off: tuple[str, ...] = ()
