"""What a reader may move on a panel, as plain values, and what the panel then shows."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ...errors import InputRefused

START = "as at the start"
"""Name of the preset that every panel has."""
_DECADE = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)
"""Preferred numbers, series R10 of ISO 3: even steps of the logarithm, in round numbers."""


@dataclass(frozen=True)
class Slider:
    """A number to choose.

    Parameters
    ----------
    name : str
    label : str
        What it is.
    low, high, value, step : float
    unit : str
        Of its values; empty for a mere number.
    log : bool
        Whether values are spaced evenly in their logarithm, ten in each decade; `step` is not used then.
    player : bool
        Whether it can be played.
    expert : bool
        Whether it is folded away at first.
    ahead : int, optional
        How many of its stops a page without a kernel draws ahead, beside those that presets and text name; as many as
        there is room for when not given.
    near : int
        How many stops to each side of the first value are drawn ahead in any case.
    """

    name: str
    label: str
    low: float
    high: float
    value: float
    step: float = 1.0
    _: KW_ONLY
    unit: str = ""
    log: bool = False
    player: bool = False
    expert: bool = False
    ahead: int | None = None
    near: int = 0

    @property
    def stops(self) -> tuple[float, ...]:
        """All values that it takes.

        Returns
        -------
        tuple of float
            From `low` to `high`; ints where its steps are whole.

        Examples
        --------
        >>> Slider("dt", "time step", 1, 10, 1, log=True).stops
        (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0, 10.0)
        >>> Slider("n", "snaxels", 7, 13, 9, 2).stops
        (7, 9, 11, 13)
        """
        if not self.log:
            return tuple(self.taken(self.low + i * self.step) for i in range(self._n_steps + 1))
        decades = range(math.floor(math.log10(self.low)), math.ceil(math.log10(self.high)) + 1)
        # written as decimals, so that 6.3 / 10 is 0.63
        values = (float(f"{number}e{decade}") for decade in decades for number in _DECADE)
        return tuple(value for value in values if self.low <= value <= self.high)

    @property
    def _n_steps(self) -> int:
        """Whole steps between its ends."""
        return math.floor((self.high - self.low) / self.step + 1e-9)

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
        nearest = self.low + self.step * min(max(round((value - self.low) / self.step), 0), self._n_steps)
        # tenths have no exact float: rounded, so that they print as they were typed
        return int(nearest) if self.whole else float(round(nearest, 9))

    def check(self, value: float) -> None:
        """Refuse what no hand on the slider reaches.

        Parameters
        ----------
        value : float

        Raises
        ------
        InputRefused
            ``OutOfRange``.
        """
        if not (isinstance(value, int | float | np.number) and self.low <= value <= self.high):
            span = f"{self.low:g} to {self.high:g} {self.unit}".rstrip()
            raise InputRefused("OutOfRange", f"{self.name} cannot be {value!r}.", f"It takes {span}.")

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
    stops : tuple of str
        All words that it takes.
    value : str
    expert : bool
        Whether it is folded away at first.
    """

    name: str
    label: str
    stops: tuple[str, ...]
    value: str
    _: KW_ONLY
    expert: bool = False
    unit: ClassVar[str] = ""

    def check(self, value: str) -> None:
        """Refuse a word that is none of its own.

        Parameters
        ----------
        value : str

        Raises
        ------
        InputRefused
            ``UnknownOption``.
        """
        if value not in self.stops:
            known = ", ".join(map(repr, self.stops))
            raise InputRefused("UnknownOption", f"{self.name} cannot be {value!r}.", f"It takes: {known}.")

    def taken(self, value: str) -> str:
        """The word, if it is one of its own.

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
        self.check(value)
        return value


@dataclass(frozen=True)
class Switch:
    """Something to turn on and off.

    Parameters
    ----------
    name, label : str
    value : bool
    expert : bool
        Whether it is folded away at first.
    """

    name: str
    label: str
    value: bool
    _: KW_ONLY
    expert: bool = False
    unit: ClassVar[str] = ""
    stops: ClassVar[tuple[bool, ...]] = (False, True)

    def check(self, value: Any) -> None:
        """Refuse nothing: anything is on or off.

        Parameters
        ----------
        value : Any
        """

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
"""Each has a `name`, a `label`, a `unit`, its `stops`, the `value` it begins with, and may be for an `expert`."""


@dataclass(frozen=True, eq=False)
class View:
    """What a panel shows for one setting of its controls.

    Parameters
    ----------
    rgb : ndarray of uint8, shape (H, W, 3)
    line : str
        One line in words and numbers, the same on every run: the picture's caption.
    limits : dict of str to float
        New upper ends of sliders, by name; what is asked for beyond one is drawn as that end.
    off : tuple of str
        Controls without effect at this setting.
    """

    rgb: NDArray[np.uint8]
    line: str
    limits: dict[str, float] | None = None
    off: tuple[str, ...] = ()
