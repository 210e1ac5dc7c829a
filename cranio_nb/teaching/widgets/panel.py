"""Controls as plain values and a function from them to a picture -> something a notebook shows.

In both modes a panel makes the same picture; `live` adds controls in the browser that move it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import Any

from ...drawing.described import Bundle, bundle, encoded_png
from ...drawing.front_end import mode
from ...errors import CranioError, InputRefused
from .controls import Control, View


class Panel:
    """Controls and the picture they lead to; displays itself.

    Parameters
    ----------
    controls : sequence of Control
    draw : callable
        Values by name -> `View`; a pure function.
    alt : str
        What the picture shows, in words.
    presets : dict of str to dict, optional
        Settings to go to at once: their name -> values by name of the control.
    actions : dict of str to callable, optional
        Buttons: label -> what to do with the panel, returning a line to show.
    slow : bool
        Whether a picture takes long: controls then speak when they are let go.
    ahead : str
        Name of a slider whose stops are worth drawing while the kernel has nothing else to do, because `draw` keeps
        what takes long of each.
    """

    def __init__(
        self,
        controls: tuple[Control, ...],
        draw: Callable[..., View],
        *,
        alt: str,
        presets: dict[str, dict[str, Any]] | None = None,
        actions: dict[str, Callable[[Any], str]] | None = None,
        slow: bool = False,
        ahead: str = "",
    ) -> None:
        self.controls = {control.name: control for control in controls}
        self.values: dict[str, Any] = {control.name: control.value for control in controls}
        self.alt = alt
        self.presets = dict(presets or {})
        self.actions = dict(actions or {})
        self.slow = slow
        self.ahead = ahead
        self._draw = draw
        self.view = self.first = draw(**self.values)
        self.values |= {name: min(self.values[name], top) for name, top in self._tops.items()}

    def picture(self, **values: Any) -> View:
        """The picture of a setting, whatever the panel shows now; nothing is moved.

        Parameters
        ----------
        **values
            By name of the control, each one of its `stops`; what is not given is as at the start.

        Returns
        -------
        View
            A setting that cannot be drawn: the first picture, faded, and a line that says why.
        """
        start = {name: control.value for name, control in self.controls.items()}
        try:
            return self._draw(**start | values)
        except CranioError as problem:
            return View(self.first.rgb // 2 + 127, str(problem))

    def set(self, **values: Any) -> Panel:
        """Move controls and draw at once.

        Parameters
        ----------
        **values
            By name of the control; a number between two stops of a slider goes to the nearer one, as by hand. What
            has no effect at this setting is named in the picture's line.

        Returns
        -------
        Panel
            This one.

        Raises
        ------
        InputRefused
            ``UnknownControl``, ``UnknownOption``, ``OutOfRange``.
        """
        # refused before anything is moved
        for name, value in values.items():
            if name not in self.controls:
                known = ", ".join(self.controls)
                raise InputRefused("UnknownControl", f"This panel has no control {name!r}.", f"It has: {known}.")
            self.controls[name].check(value)
        self.update(values)
        idle = [name for name in values if name in self.view.off and self.values[name] != self.controls[name].value]
        if idle:
            self.view = replace(self.view, line=f"{self.view.line} No effect at this setting: {', '.join(idle)}.")
        if mode() == "widget":
            self.front.show()
        return self

    def update(self, values: dict[str, Any]) -> View:
        """Take new values and draw.

        Parameters
        ----------
        values : dict
            By name of the control.

        Returns
        -------
        View
        """
        asked = self.values | {name: self.controls[name].taken(value) for name, value in values.items()}
        # a slider at its end stays at its end where the picture moves that end, and none stands beyond it
        asked |= {name: self.controls[name].stops[-1] for name, top in self._tops.items() if asked[name] == top}
        self.view = self.picture(**asked)
        self.values = asked | {name: min(asked[name], top) for name, top in self._tops.items()}
        return self.view

    @property
    def _tops(self) -> dict[str, float]:
        """Upper ends of sliders that the picture of now has moved."""
        return self.view.limits or {}

    @cached_property
    def front(self) -> Any:
        """The panel in a browser.

        Returns
        -------
        live.Front
        """
        from .live import Front

        return Front(self)

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> Bundle:
        data, metadata = bundle(encoded_png(self.view.rgb), self.alt, self.view.line)
        if mode() == "widget":
            data |= self.front.widget._repr_mimebundle_()[0]
        return data, metadata
