"""A panel's controls -> widgets that move its picture. The only importer of ipywidgets.

A slow picture must not fall behind a fast hand: while one was just drawn, newer values only replace the waiting ones.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Any

import ipywidgets as ipw  # noqa: TID251  (this is the module that may)

from ...drawing.described import encoded_jpeg
from ...errors import CranioError
from .controls import Choice, Control, Slider, Switch

_UNSEEN = (
    '<p style="position:absolute;left:-9999px">%s</p>'  # read aloud only: the image widget takes no alternative text
)
_PAUSE = 0.02  # s between two pictures, in which waiting messages are read
_LABEL = {"description_width": "290px"}
_WIDE = ipw.Layout(width="580px")


class Front:
    """The widgets of a panel: `controls` by name, `image`, `caption`, and the `box` that holds them.

    Parameters
    ----------
    panel : Panel
    """

    def __init__(self, panel: Any) -> None:
        self.panel = panel
        # a widget for each control, an image and a caption that screen readers announce
        self.controls = {name: _widget(control) for name, control in panel.controls.items()}
        height, width = panel.view.rgb.shape[:2]
        self.image = ipw.Image(format="jpeg", width=width, height=height)
        self.image.layout = ipw.Layout(max_width="100%", object_fit="contain")
        self.caption = ipw.HTML()
        self._later = Latest(self._draw)
        self._paused = False
        self._show()
        # a slow panel answers when a slider is let go, others follow it
        for widget in self.controls.values():
            if panel.slow and hasattr(widget, "continuous_update"):
                widget.continuous_update = False
            widget.observe(self._moved, "value")
        rows = [self._row(control) for control in panel.controls.values()]
        self.box = ipw.VBox([*rows, *self._buttons(), self.image, self.caption])

    def set(self, values: dict[str, Any]) -> None:
        """Move the widgets and draw once, at once.

        Parameters
        ----------
        values : dict
            By name of the control.
        """
        self._paused = True
        for name, value in values.items():
            self.controls[name].value = value
        self._paused = False
        self._draw()

    def _moved(self, change: dict[str, Any]) -> None:
        if not self._paused:
            self._later()

    def _draw(self) -> None:
        # said before the work begins
        if self.panel.slow:
            self.caption.value = '<p role="status">Working …</p>'
        # a slider at its end stays at its end when the picture moves that end
        view = self.panel.update(self._values())
        at_end = [name for name in view.limits or {} if self.controls[name].value == self.controls[name].max]
        self._show()
        moved = [name for name in at_end if self._follow(name)]
        if moved:
            self.panel.update(self._values())
            self._show()

    def _values(self) -> dict[str, Any]:
        return {name: widget.value for name, widget in self.controls.items()}

    def _follow(self, name: str) -> bool:
        """Keep a slider that stood at its upper end there; whether that moved it."""
        widget = self.controls[name]
        self._paused, before = True, widget.value
        widget.value = widget.max
        self._paused = False
        return bool(widget.value != before)

    def _show(self) -> None:
        view = self.panel.view
        self.image.value = encoded_jpeg(view.rgb)
        self.caption.value = f'{_UNSEEN % _escaped(self.panel.alt)}<p role="status">{_escaped(view.line)}</p>'
        # new limits and switched-off controls are set without being taken for moves
        self._paused = True
        for name, high in (view.limits or {}).items():
            self.controls[name].max = high
        for name, widget in self.controls.items():
            widget.disabled = name in view.off
        self._paused = False

    def _row(self, control: Control) -> Any:
        widget = self.controls[control.name]
        if not (isinstance(control, Slider) and control.player):
            return widget
        play = ipw.Play(value=widget.value, min=widget.min, max=widget.max, interval=80)
        ipw.jslink((play, "value"), (widget, "value"))
        ipw.jslink((widget, "max"), (play, "max"))
        back, on = (ipw.Button(icon=i, tooltip=t, layout=ipw.Layout(width="40px")) for i, t in _STEPS)
        back.on_click(lambda _: setattr(widget, "value", max(widget.value - 1, widget.min)))
        on.on_click(lambda _: setattr(widget, "value", min(widget.value + 1, widget.max)))
        return ipw.HBox([widget, play, back, on])

    def _buttons(self) -> list[Any]:
        buttons = [ipw.Button(description=label, layout=ipw.Layout(width="auto")) for label in self.panel.actions]
        for button, action in zip(buttons, self.panel.actions.values(), strict=True):
            button.on_click(lambda _, act=action: setattr(self.caption, "value", _escaped(self._said(act))))
        return [ipw.HBox(buttons)] if buttons else []

    def _said(self, act: Callable[[Any], str]) -> str:
        """What an action answers, or why it could not be done."""
        try:
            return act(self.panel)
        except CranioError as problem:
            return str(problem)


_STEPS = (("step-backward", "one step back"), ("step-forward", "one step on"))


class Latest:
    """Calls that come too fast: the first is done at once, of those that wait only the last.

    Parameters
    ----------
    call : callable
        () -> None.
    """

    def __init__(self, call: Callable[[], None]) -> None:
        self._call = call
        self._free = 0.0
        self._waiting = False

    def __call__(self) -> None:
        """Ask for a call."""
        loop = _running_loop()
        wait = self._free - time.monotonic()
        if wait <= 0 or loop is None:
            self._now()
        elif not self._waiting:
            self._waiting = True
            loop.call_later(wait, self._now)

    def _now(self) -> None:
        self._waiting = False
        try:
            self._call()
        finally:
            self._free = time.monotonic() + _PAUSE


def _running_loop() -> asyncio.AbstractEventLoop | None:
    try:
        return asyncio.get_running_loop()
    except RuntimeError:
        return None


def _widget(control: Control) -> Any:
    look: dict[str, Any] = {"description": _title(control), "style": _LABEL, "layout": _WIDE}
    if isinstance(control, Choice):
        return ipw.Dropdown(options=control.stops, value=control.value, **look)
    if isinstance(control, Switch):
        return ipw.Checkbox(value=control.value, indent=True, **look)
    return _slider(control, look)


def _title(control: Control) -> str:
    return f"{control.label} ({control.unit})" if control.unit else control.label


def _slider(control: Slider, look: dict[str, Any]) -> Any:
    if control.log:
        options = [(f"{stop:.3g}", stop) for stop in control.stops]
        return ipw.SelectionSlider(options=options, value=control.taken(control.value), **look)
    if control.whole:
        low, high, step = int(control.low), int(control.high), int(control.step)
        return ipw.IntSlider(int(control.value), min=low, max=high, step=step, **look)
    limits = {"min": control.low, "max": control.high, "step": control.step}
    decimals = max(0, len(f"{control.step:.6f}".rstrip("0").split(".")[1]))
    return ipw.FloatSlider(control.value, **limits, readout_format=f".{decimals}f", **look)


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
