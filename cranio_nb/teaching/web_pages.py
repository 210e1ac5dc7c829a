"""Lesson notebooks -> web pages whose pictures carry their descriptions, for reading where nothing is installed.

Nbconvert and JupyterLab draw stored pictures but leave their descriptions out; these pages put them in, and the line
of numbers of each picture below it. Formulas are typeset where there is a network, and stay readable as text elsewhere.
"""

from __future__ import annotations

from pathlib import Path

import nbformat
from jinja2 import DictLoader
from nbconvert import HTMLExporter

from ..errors import InputRefused
from ..output.files import write_text
from ..output.staging import staged

_PICTURE = """
{%- extends 'lab/index.html.j2' -%}
{% block data_png scoped %}
<figure class="jp-RenderedImage jp-OutputArea-output" style="margin: 0">
<img src="data:image/png;base64,{{ output.data['image/png'] | escape_html }}"
 alt="{{ (output | get_metadata('alt', 'image/png') or '') | escape_html }}">
<figcaption>{{ output.data['text/plain'] | escape_html }}</figcaption>
</figure>
{% endblock data_png %}
"""


def write_pages(folder: Path, out: Path) -> list[Path]:
    """Write a page for each executed notebook of a folder; nothing is run.

    Parameters
    ----------
    folder : path
        Holds ``NN_topic.ipynb``.
    out : path
        Folder for ``NN_topic.html``; made where it is missing.

    Returns
    -------
    list of Path
        The pages.

    Raises
    ------
    InputRefused
        ``NoLessons`` where there are no notebooks.
    CannotWrite
        Where the pages cannot be written.
    """
    notebooks = sorted(folder.glob("*.ipynb"))
    if not notebooks:
        raise InputRefused("NoLessons", f"There are no notebooks in {folder.name}.", "Name the folder of the lessons.")
    # the template gives every picture its alternative text and its line as caption
    exporter = HTMLExporter(
        extra_loaders=[DictLoader({"described.html.j2": _PICTURE})], template_file="described.html.j2"
    )
    pages = {path.stem: exporter.from_notebook_node(nbformat.read(path, as_version=4))[0] for path in notebooks}
    # written only when all pages are made, and together
    with staged(out) as part:
        for name, text in pages.items():
            write_text(part / f"{name}.html", text)
    return [out / f"{name}.html" for name in pages]
