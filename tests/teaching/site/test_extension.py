"""Formulas become MathML: drawn by the browser, read aloud, without a script."""

from types import SimpleNamespace
from xml.etree import ElementTree

import pytest

pytest.importorskip("sphinx", reason='the extra "site" is not installed')


@pytest.mark.parametrize("display", [False, True])
def test_a_formula_is_well_formed_mathml(display):
    nodes = pytest.importorskip("docutils.nodes")
    from cranio_nb.teaching.site import extension

    made = {}
    app = SimpleNamespace(
        add_html_math_renderer=lambda name, *visits: made.update({name: visits}), connect=lambda *event, priority: None
    )
    assert extension.setup(app)["parallel_read_safe"]
    writer = SimpleNamespace(body=[])
    with pytest.raises(nodes.SkipNode):
        made["mathml"][int(display)][0](writer, nodes.math("", r"\frac{k N^2}{8}"))
    (text,) = writer.body
    tree = ElementTree.fromstring(text)
    assert tree.tag.endswith("math") and (tree.get("display") == "block") == display
    assert [leaf.text for leaf in tree.iter() if leaf.tag.endswith("}mn") or leaf.tag == "mn"] == ["2", "8"]


def test_headings_have_a_level_and_folded_answers_the_name_they_show():
    from cranio_nb.teaching.site import extension

    heard = {}
    app = SimpleNamespace(
        add_html_math_renderer=lambda *a: None, connect=lambda event, act, priority: heard.update({event: act})
    )
    extension.setup(app)
    folded = '<summary aria-label="Toggle hidden content">Show the answer</summary>'
    context = {"body": f'<p class="caption" role="heading">Part</p>{folded}', "title": 'role="heading">'}
    heard["html-page-context"](app, "index", "page.html", context, None)
    assert (
        context["body"] == '<p class="caption" role="heading" aria-level="2">Part</p><summary>Show the answer</summary>'
    )
    assert context["title"] == 'role="heading">'
