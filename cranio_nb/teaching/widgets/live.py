"""A panel's controls -> a widget that moves its picture. The only importer of anywidget.

``front/panel.js`` draws it in the browser, with native elements: each control has a name and obeys the keyboard.
Values go to and fro as `Control.stops`; while a picture is made, newer values only replace those that wait. Pictures
that take long are drawn ahead while the kernel rests, so that they are there when a hand asks for them.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import anywidget  # noqa: TID251  (this is the module that may)
import traitlets

from ...drawing.described import encoded_jpeg
from ...errors import CranioError
from .controls import START, Choice, Control, Slider

REST_S = 0.2
"""How long the kernel rests before a picture is drawn ahead."""
LATE_S = 0.05
"""Called so much later than asked for, it did not rest."""
_FRONT = Path(__file__).parent / "front"


class PanelWidget(anywidget.AnyWidget):
    """What kernel and browser share of a panel; ``front/panel.js`` reads it."""

    _esm = _FRONT / "panel.js"
    _css = _FRONT / "panel.css"
    # what a panel is: these stay as they are
    controls: traitlets.List[Any] = traitlets.List().tag(sync=True)
    presets = traitlets.Dict().tag(sync=True)
    actions: traitlets.List[Any] = traitlets.List().tag(sync=True)
    alt = traitlets.Unicode().tag(sync=True)
    slow = traitlets.Bool().tag(sync=True)
    width = traitlets.Int().tag(sync=True)
    height = traitlets.Int().tag(sync=True)
    # what it shows; `drawn` counts the pictures
    values = traitlets.Dict().tag(sync=True)
    limits = traitlets.Dict().tag(sync=True)
    off: traitlets.List[Any] = traitlets.List().tag(sync=True)
    picture = traitlets.Bytes().tag(sync=True)
    caption = traitlets.Unicode().tag(sync=True)
    drawn = traitlets.Int().tag(sync=True)


class Front:
    """A panel in the browser.

    Parameters
    ----------
    panel : Panel

    Attributes
    ----------
    widget : PanelWidget
    """

    def __init__(self, panel: Any) -> None:
        self.panel = panel
        height, width = panel.view.rgb.shape[:2]
        start = {name: control.value for name, control in panel.controls.items()}
        self.widget = PanelWidget(
            controls=[declared(control, slow=panel.slow) for control in panel.controls.values()],
            presets={START: start} | panel.presets,
            actions=list(panel.actions),
            alt=panel.alt,
            slow=panel.slow,
            width=width,
            height=height,
        )
        self.show()
        self.widget.observe(self._moved, "values")
        self.widget.on_msg(self._pressed)
        if panel.ahead:
            self._rest(iter(stops_ahead(panel)))

    def show(self) -> None:
        """Show what the panel shows."""
        view, widget = self.panel.view, self.widget
        with widget.hold_sync():
            widget.values = dict(self.panel.values)
            widget.limits, widget.off = dict(view.limits or {}), list(view.off)
            widget.picture, widget.caption = encoded_jpeg(view.rgb), view.line
            widget.drawn += 1

    def _moved(self, change: Any) -> None:
        if change["new"] != self.panel.values:
            self.panel.update(change["new"])
            self.show()

    def _pressed(self, widget: Any, message: dict[str, Any], buffers: Any) -> None:
        """Do what a button is for, and say what came of it."""
        act = self.panel.actions.get(message.get("action"))
        if act is None:
            return
        try:
            self.widget.caption = act(self.panel)
        except CranioError as problem:
            self.widget.caption = str(problem)

    def _rest(self, stops: Iterator[Any]) -> None:
        """Draw the next stop after a rest of the kernel; outside of one there is none to wait for."""
        with suppress(RuntimeError):
            loop = asyncio.get_running_loop()
            loop.call_later(REST_S, self._draw_ahead, stops, loop.time() + REST_S)

    def _draw_ahead(self, stops: Iterator[Any], due: float) -> None:
        # called late, the kernel was busy: run-all is not held up
        if asyncio.get_running_loop().time() - due < LATE_S:
            stop = next(stops, None)
            if stop is None:
                return
            self.panel.picture(**self.panel.values | {self.panel.ahead: stop})
        self._rest(stops)


def stops_ahead(panel: Any) -> list[float]:
    """The stops to draw ahead, those next to where the slider stands first.

    Parameters
    ----------
    panel : Panel
        With a slider `ahead`.

    Returns
    -------
    list of float
    """
    now = panel.values[panel.ahead]
    return sorted(panel.controls[panel.ahead].stops, key=lambda stop: abs(stop - now))[1:]


def declared(control: Control, *, slow: bool) -> dict[str, Any]:
    """A control as the browser is told of it.

    Parameters
    ----------
    control : Control
    slow : bool
        Whether it speaks only when it is let go.

    Returns
    -------
    dict
        JSON.
    """
    kind = "slider" if isinstance(control, Slider) else "choice" if isinstance(control, Choice) else "switch"
    named = {"name": control.name, "label": control.label, "unit": control.unit, "expert": control.expert}
    player = isinstance(control, Slider) and control.player
    return named | {"kind": kind, "stops": list(control.stops), "player": player, "slow": slow}
