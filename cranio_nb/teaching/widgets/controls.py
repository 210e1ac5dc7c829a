"""What a reader may move on a panel, as plain values, and what the panel then shows."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...errors import InputRefused

_DECADE = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)
"""Preferred numbers, series R10 of ISO 3: even steps of the logarithm, in round numbers."""


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
        Whether values are spaced evenly in their logarithm, as `stops`; `step` is not used then.
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

    @property
    def stops(self) -> tuple[float, ...]:
        """The values of a logarithmic slider, ten in each decade.

        Returns
        -------
        tuple of float
            From `low` to `high`.

        Examples
        --------
        >>> Slider("dt", "time step", 1, 10, 1, log=True).stops
        (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0, 10.0)
        """
        decades = range(math.floor(math.log10(self.low)), math.ceil(math.log10(self.high)) + 1)
        # written as decimals, so that 6.3 / 10 is 0.63
        values = (float(f"{number}e{decade}") for decade in decades for number in _DECADE)
        return tuple(value for value in values if self.low <= value <= self.high)

    def taken(self, value: float) -> float:
        """The value that a hand on the slider reaches, nearest to the one asked for.

        Parameters
        ----------
        value : float

        Returns
        -------
        float
            A stop of the slider, an int where its steps are whole.

        Examples
        --------
        >>> Slider("width", "width (HU)", 50, 4000, 1500, 10).taken(83)
        80
        >>> Slider("dt", "time step", 0.1, 10, 1, log=True).taken(4)
        4.0
        """
        if self.log:
            return min(self.stops, key=lambda stop: abs(stop - value))
        if self.whole:
            nearest = self.low + self.step * round((value - self.low) / self.step)
            return int(min(max(nearest, self.low), self.high))
        # tenths have no exact float: rounded, so that they print as they were typed
        nearest = round(self.low + self.step * round((value - self.low) / self.step), 9)
        return float(min(max(nearest, self.low), self.high))

    @property
    def whole(self) -> bool:
        """Whether all its values are whole numbers.

        Returns
        -------
        bool
        """
        return not self.log and all(float(v).is_integer() for v in (self.low, self.high, self.value, self.step))


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

    def taken(self, value: str) -> str:
        """The word, if it is one of the options.

        Parameters
        ----------
        value : str

        Returns
        -------
        str

        Raises
        ------
        InputRefused
            ``UnknownOption``.
        """
        if value not in self.options:
            known = ", ".join(map(repr, self.options))
            raise InputRefused("UnknownOption", f"{self.name} cannot be {value!r}.", f"It takes: {known}.")
        return value


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

    def taken(self, value: Any) -> bool:
        """On or off.

        Parameters
        ----------
        value : bool

        Returns
        -------
        bool
        """
        return bool(value)


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
