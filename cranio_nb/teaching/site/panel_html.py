"""The frames of a panel -> its place on a page: the first picture, and all that the script must know.

In the browser the panel's own front draws the controls, as in a notebook; ``static/ahead.js`` answers it in the
kernel's stead.
"""

from __future__ import annotations

import json
from functools import lru_cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, Template

from ..widgets import Panel, live
from .axes import Axis, presets_on
from .frames import Frames

STATIC = Path(__file__).parent / "static"
"""Folder of the script and the style of panels without a kernel."""
SCRIPTS = ("panel.js", "ahead.js", "scroll.js")
"""What a page loads, in this order."""
STYLES = ("panel.css", "site.css")
"""Its style sheets."""
_FRONT = Path(live.__file__).parent / "front"
_EXPORT = "export default { render };"


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
    moved = {axis.control.name for axis in frames.axes}
    titles = [control.label for name, control in panel.controls.items() if name not in moved]
    text = _template().render(
        id=name,
        alt=panel.alt,
        line=frames.lines[frames.start],
        picture=f"{folder}/{frames.names[frames.start]}",
        width=width,
        height=height,
        still=", ".join(titles),
        data=_data(panel, frames, folder),
    )
    return "\n".join(line for line in text.splitlines() if line.strip())


def write_front(folder: Path) -> None:
    """Write the scripts and styles of panels.

    Parameters
    ----------
    folder : path
        Gets `SCRIPTS` and `STYLES`. The panel's own front is a module, which a page opened from disk may not load:
        it becomes a plain script.
    """
    text = (_FRONT / "panel.js").read_text("utf-8")
    assert text.count(_EXPORT) == 1
    body = text.replace(_EXPORT, "window.cranioPanel = render;")
    (folder / "panel.js").write_text(f"(function () {{\n{body}}})();\n", "utf-8")
    (folder / "panel.css").write_bytes((_FRONT / "panel.css").read_bytes())
    for path in STATIC.iterdir():
        (folder / path.name).write_bytes(path.read_bytes())


def _data(panel: Panel, frames: Frames, folder: str) -> str:
    """All of it as JSON that may stand inside a script."""
    files = list(frames.files)
    place = {name: i for i, name in enumerate(files)}
    number = {axis.control.name: i for i, axis in enumerate(frames.axes)}
    found = {
        "panel": _declared(panel, frames),
        "folder": folder,
        "files": files,
        "pictures": [place[name] for name in frames.names],
        "lines": frames.lines,
        "off": [[number[name] for name in off if name in number] for off in frames.off],
        "tops": [[[number[name], *top] for name, top in tops.items()] for tops in frames.tops],
    }
    return json.dumps(found, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


def _declared(panel: Panel, frames: Frames) -> dict[str, Any]:
    """The panel as its front is told of it; only the axes can be moved."""
    height, width = panel.view.rgb.shape[:2]
    return {
        "controls": [_control(axis) for axis in frames.axes],
        "values": {axis.control.name: axis.stops[axis.start] for axis in frames.axes},
        "presets": presets_on(frames.axes, panel),
        "actions": [],
        "limits": {},
        "alt": panel.alt,
        "slow": False,  # each picture is there already
        "width": width,
        "height": height,
    }


def _control(axis: Axis) -> dict[str, Any]:
    told = live.declared(axis.control, slow=False)
    return told | {"stops": list(axis.stops), "cyclic": axis.cyclic}


@lru_cache(maxsize=1)
def _template() -> Template:
    loader = PackageLoader("cranio_nb.teaching.site")
    return Environment(loader=loader, autoescape=True, undefined=StrictUndefined).get_template("panel_html.html")
