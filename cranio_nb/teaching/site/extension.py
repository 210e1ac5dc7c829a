"""What Sphinx must know beyond its own: formulas as MathML, which browsers draw without a script or a network."""

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
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _inline(writer: Any, node: nodes.Element) -> None:
    _write(writer, node, display=False)


def _display(writer: Any, node: nodes.Element) -> None:
    _write(writer, node, display=True)


def _write(writer: Any, node: nodes.Element, *, display: bool) -> None:
    writer.body.append(latex2mathml.tex2mathml(node.astext(), as_block=display))
    raise nodes.SkipNode
