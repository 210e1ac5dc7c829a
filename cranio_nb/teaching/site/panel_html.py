"""The frames of a panel -> its place on a page: controls, picture, caption, and what the script must know."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import lru_cache
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, Template

from ..widgets import Panel
from ..widgets.controls import Choice, Switch
from .axes import Axis, presets_on
from .frames import Frames


def panel_html(panel: Panel, frames: Frames, name: str, folder: str) -> str:
    """A panel that is moved without a kernel.

    Parameters
    ----------
    panel : Panel
        As the lesson shows it.
    frames : Frames
        Its pictures.
    name : str
        Identifies it on its page.
    folder : str
        Address of the pictures, seen from the page.

    Returns
    -------
    str
        HTML, without an empty line: Markdown would end it there.
    """
    height, width = panel.view.rgb.shape[:2]
    axes = [_axis(axis) for axis in frames.axes]
    text = _template().render(
        id=name,
        name=panel.alt,
        axes=axes,
        presets=list(_presets(panel, frames)),
        frames=frames,
        folder=folder,
        alt=panel.alt,
        width=width,
        height=height,
        data=_data(panel, frames, axes, folder),
    )
    return "\n".join(line for line in text.splitlines() if line.strip())


def stop_text(axis: Axis, stop: Any) -> str:
    """A stop in words, with its unit.

    Parameters
    ----------
    axis : Axis
    stop : float, str or bool

    Returns
    -------
    str

    Examples
    --------
    >>> from cranio_nb.teaching.widgets.controls import Slider
    >>> axis = Axis(Slider("width", "width", 0, 100, 50, 0.5, unit="HU"), (0.0, 62.5), 0)
    >>> stop_text(axis, 62.5)
    '62.5 HU'
    """
    if isinstance(stop, bool):
        return "on" if stop else "off"
    text = stop if isinstance(stop, str) else f"{stop:.6g}".replace("-", "\N{MINUS SIGN}")
    return f"{text} {axis.control.unit}".strip()


def _axis(axis: Axis) -> dict[str, Any]:
    """What the template and the script must know of an axis."""
    control = axis.control
    kind = "choice" if isinstance(control, Choice) else "switch" if isinstance(control, Switch) else "range"
    return {
        "kind": kind,
        "label": control.label,
        "texts": [stop_text(axis, stop) for stop in axis.stops],
        "start": axis.start,
        "player": bool(getattr(control, "player", False)),
        "cyclic": axis.cyclic,
    }


def _presets(panel: Panel, frames: Frames) -> Any:
    """Name of each preset that the axes reach, and the places it goes to; what it leaves open starts anew."""
    for name, values in presets_on(frames.axes, panel).items():
        yield name, [_place(axis, values) for axis in frames.axes]


def _place(axis: Axis, values: Mapping[str, Any]) -> int:
    if axis.control.name not in values:
        return axis.start
    return axis.stops.index(axis.control.taken(values[axis.control.name]))


def _data(panel: Panel, frames: Frames, axes: list[dict[str, Any]], folder: str) -> str:
    """All of it as JSON that may stand inside a script."""
    files = list(frames.files)
    place = {name: i for i, name in enumerate(files)}
    number = {axis.control.name: i for i, axis in enumerate(frames.axes)}
    found = {
        "alt": panel.alt,
        "folder": folder,
        "axes": [{key: axis[key] for key in ("texts", "start", "cyclic")} for axis in axes],
        "files": files,
        "pictures": [place[name] for name in frames.names],
        "lines": frames.lines,
        "off": [[number[name] for name in off if name in number] for off in frames.off],
    }
    return json.dumps(found, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


@lru_cache(maxsize=1)
def _template() -> Template:
    loader = PackageLoader("cranio_nb.teaching.site")
    return Environment(loader=loader, autoescape=True, undefined=StrictUndefined).get_template("panel.html.j2")
