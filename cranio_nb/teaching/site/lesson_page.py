"""An executed lesson -> the notebook that becomes its page: described pictures, panels that move, answers folded.

Pictures become files beside the page, so that the page itself stays small.
"""

from __future__ import annotations

import base64
import html
from copy import deepcopy
from dataclasses import dataclass, field

from nbformat import NotebookNode

from ...drawing.scene3d import Scene
from ..lesson_text import tags
from .axes import axes_of
from .frames import draw_frames, encoding
from .needed_cells import Shown, shown_by
from .panel_html import panel_html
from .turntable import all_round, turntable

_ROOM, _SLOW_FRAMES = 4_500_000, 24  # bytes for a panel's pictures; how many where each takes long
COLAB = "# On Colab this installs the package"
"""How the cell begins that prepares Colab."""


@dataclass(frozen=True, eq=False)
class LessonPage:
    """A lesson as the site shows it.

    Parameters
    ----------
    notebook : NotebookNode
        Its pictures and panels are HTML that names files.
    files : dict of str to bytes
        These files, by name.
    """

    notebook: NotebookNode
    files: dict[str, bytes] = field(default_factory=dict)


def lesson_page(lesson: NotebookNode, folder: str) -> LessonPage:
    """Make the page of a lesson; only what its panels need is run.

    Parameters
    ----------
    lesson : NotebookNode
        Executed.
    folder : str
        Address of its pictures, seen from the page.

    Returns
    -------
    LessonPage

    Raises
    ------
    InputRefused
        ``OutOfStep`` where a panel says something else than the notebook holds.
    """
    page = LessonPage(deepcopy(lesson))
    text = "\n".join(cell.source for cell in lesson.cells)
    moved = shown_by(lesson.cells)
    for cell in page.notebook.cells:
        if cell.cell_type != "code":
            continue
        cell.metadata["tags"] = [*tags(cell), *_folding(cell)]
        for number, output in enumerate(cell.outputs):
            if "image/png" in output.get("data", {}):
                name = f"{cell.id}-{number}"
                shown = moved.get(cell.id)
                made = _figure(page, output, name, folder) if shown is None else _panel(page, shown, text, name, folder)
                output.data, output.metadata = NotebookNode({"text/html": made}), NotebookNode()
    return page


def _folding(cell: NotebookNode) -> list[str]:
    """What MyST-NB is told to leave out or to fold away."""
    if cell.source.startswith(COLAB):
        return ["remove-cell"]
    return ["hide-input"] if "solution" in tags(cell) else []


def _figure(page: LessonPage, output: NotebookNode, name: str, folder: str) -> str:
    """A stored picture as a file, with its description and its line."""
    page.files[f"{name}.png"] = base64.b64decode(output.data["image/png"])
    about = output.metadata["image/png"]
    size = f'width="{about["width"]}" height="{about["height"]}"'
    alt, line = html.escape(about["alt"]), html.escape(output.data["text/plain"])
    return (
        f'<figure class="cranio-figure"><img src="{folder}/{name}.png" alt="{alt}" {size} loading="lazy">'
        f"<figcaption>{line}</figcaption></figure>"
    )


def _panel(page: LessonPage, shown: Shown, text: str, name: str, folder: str) -> str:
    """A panel or a scene, and its pictures as files."""
    if isinstance(shown, Scene):
        panel = turntable(shown)
        axes = all_round(panel)
    else:
        panel = shown
        axes = axes_of(panel, text, _SLOW_FRAMES if panel.slow else _ROOM // len(encoding(panel)(panel.view.rgb)))
    frames = draw_frames(panel, axes)
    page.files.update(frames.files)
    return panel_html(panel, frames, f"panel-{name}", folder)
