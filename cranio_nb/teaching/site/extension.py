"""What Sphinx must know beyond its own: formulas as MathML, which browsers draw without a script or a network.

And what screen readers are told: the level of headings above parts of the contents, what a folded answer is called.
"""

from __future__ import annotations

from typing import Any

from docutils import nodes
from docutils.utils.math import latex2mathml
from sphinx.application import Sphinx


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the writer of formulas; called by Sphinx.

    Parameters
    ----------
    app : Sphinx

    Returns
    -------
    dict
        What Sphinx may do with it.
    """
    app.add_html_math_renderer("mathml", (_inline, None), (_display, None))
    app.connect("html-page-context", _name_parts, priority=900)  # after the theme has made its contents
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _inline(writer: Any, node: nodes.Element) -> None:
    _write(writer, node, display=False)


def _display(writer: Any, node: nodes.Element) -> None:
    _write(writer, node, display=True)


def _write(writer: Any, node: nodes.Element, *, display: bool) -> None:
    writer.body.append(latex2mathml.tex2mathml(node.astext(), as_block=display))
    raise nodes.SkipNode


def _name_parts(app: Any, page: str, template: str, context: dict[str, Any], tree: Any) -> None:
    for part in ("body", "furo_navigation_tree"):
        if part in context:
            leveled = context[part].replace('role="heading">', 'role="heading" aria-level="2">')
            # its words are its name
            context[part] = leveled.replace('<summary aria-label="Toggle hidden content">', "<summary>")
