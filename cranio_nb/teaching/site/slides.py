"""A lesson -> slides for a lecture, with its figures large and its panels alive; they open from disk.

Reveal.js comes from the installed package sphinx-revealjs, the slides from nbconvert.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import nbformat
from nbformat import NotebookNode
from nbformat.v4 import new_markdown_cell

from ...errors import InputRefused
from ...output.staging import staged
from ..lesson_text import tags
from .lesson_page import COLAB, lesson_page
from .panel_html import write_front

_MOST_LETTERS = 620  # of text on one slide
_FORMULA = re.compile(r"\$\$(.+?)\$\$|(?<![\\$])\$([^$\n]+)\$", re.S)
_LEFT_OUT = {"solution", "check", "expected"}
_TEMPLATE = "slides.html.j2"


def write_slides(notebook: Path, out: Path) -> Path:
    """Write the slides of an executed lesson; only what draws its panels is run.

    Parameters
    ----------
    notebook : path
    out : path
        Folder for the slides, their pictures and reveal.js.

    Returns
    -------
    path
        The page.

    Raises
    ------
    InputRefused
        ``NoSlides`` without the extra ``site``, ``NotFound``, ``OutOfStep``.
    CannotWrite
        Where the system refuses.
    """
    if find_spec("sphinx_revealjs") is None:
        raise InputRefused("NoSlides", "Not installed: sphinx-revealjs.", 'Run: pip install "cranio-nb[lab,site]".')
    if not notebook.is_file():
        raise InputRefused("NotFound", f"There is no notebook {notebook.name}.")
    folder = f"{notebook.stem}_pictures"
    page = lesson_page(nbformat.read(notebook, as_version=4), folder)
    text = slides_html(page.notebook, notebook.stem)
    with staged(out) as part:
        (part / folder).mkdir()
        for name, data in page.files.items():
            (part / folder / name).write_bytes(data)
        (part / f"{notebook.stem}.html").write_text(text, "utf-8")
        _copy_reveal(part / "reveal")
    return out / f"{notebook.stem}.html"


def slides_html(lesson: NotebookNode, title: str) -> str:
    """The page that reveal.js turns into slides.

    Parameters
    ----------
    lesson : NotebookNode
        As `lesson_page` makes it.
    title : str
        Of the page.

    Returns
    -------
    str
        HTML.
    """
    from jinja2 import FileSystemLoader
    from nbconvert import SlidesExporter

    cells = [slide for cell in lesson.cells for slide in slides_of(cell)]
    exporter = SlidesExporter(
        extra_loaders=[FileSystemLoader(Path(__file__).parent / "templates")],
        template_file=_TEMPLATE,
        reveal_url_prefix="reveal",
        reveal_theme="white",
        reveal_number="c/t",
        reveal_width="1280",
        reveal_height="720",
        exclude_input_prompt=True,
        exclude_output_prompt=True,
    )
    made = nbformat.v4.new_notebook(cells=cells, metadata={"title": title})
    return str(exporter.from_notebook_node(made)[0])


def slides_of(cell: NotebookNode) -> Iterator[NotebookNode]:
    """The slides of one cell: none of an answer, several of a long text.

    Parameters
    ----------
    cell : NotebookNode

    Yields
    ------
    NotebookNode
        With the kind of its slide; a heading begins a new column of slides.
    """
    if cell.cell_type == "markdown":
        for text in split_text(cell.source):
            kind = "slide" if re.match(r"#{1,2} ", text) else "subslide"
            yield new_markdown_cell(with_mathml(text), metadata={"slideshow": {"slide_type": kind}})
    elif cell.source.strip() and not cell.source.startswith(COLAB) and not _LEFT_OUT & set(tags(cell)):
        shows = any("text/html" in output.get("data", {}) for output in cell.outputs)
        cell.metadata["slideshow"] = {"slide_type": "subslide"}
        if shows:  # the picture has the slide for itself
            cell.metadata["transient"] = {"remove_source": True}
        yield cell


def split_text(text: str) -> list[str]:
    r"""A text in parts that fit a slide each.

    Parameters
    ----------
    text : str
        Markdown.

    Returns
    -------
    list of str
        A heading begins a part; what is folded, a table or code stays in one.

    Examples
    --------
    >>> split_text("# One\n\na\n\n## Two\n\nb")
    ['# One\n\na', '## Two\n\nb']
    """
    blocks: list[str] = []
    for block in re.split(r"\n\s*\n", text.strip()):
        # a folded answer has empty lines within
        open_above = bool(blocks) and blocks[-1].count("<details") > blocks[-1].count("</details")
        if open_above:
            blocks[-1] += f"\n\n{block}"
        else:
            blocks.append(block)
    parts: list[str] = []
    for block in blocks:
        if parts and not block.startswith("#") and len(parts[-1]) + len(block) < _MOST_LETTERS:
            parts[-1] += f"\n\n{block}"
        else:
            parts.append(block)
    return parts


def with_mathml(text: str) -> str:
    """A text whose formulas browsers draw themselves.

    Parameters
    ----------
    text : str
        Markdown with TeX between dollars.

    Returns
    -------
    str
    """
    from docutils.utils.math.latex2mathml import tex2mathml

    def drawn(hit: re.Match[str]) -> str:
        made = tex2mathml(hit[1] or hit[2], as_block=bool(hit[1]))
        return re.sub(r"\s*\n\s*", "", str(made))

    return _FORMULA.sub(drawn, text)


def _copy_reveal(folder: Path) -> None:
    """What slides need of reveal.js, with its licence, and the panels' script and styles."""
    spec: Any = find_spec("sphinx_revealjs")
    reveal = Path(spec.origin).parent / "_static" / "revealjs"
    for name in ("LICENSE", "dist/reveal.js", "dist/reveal.css", "dist/theme/white.css", "plugin/notes/notes.js"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(reveal / name, folder / name)
    font = "dist/theme/fonts/source-sans-pro"
    shutil.copytree(reveal / font, folder / font)
    write_front(folder)
