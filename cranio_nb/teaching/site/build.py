"""The whole site: pages and lessons to Sphinx, panels to pictures, and all of it into one folder.

Nothing on it asks a server for anything: no font, script or formula comes from elsewhere, and the search works in a
page opened from disk.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from importlib.metadata import version
from importlib.util import find_spec
from io import StringIO
from pathlib import Path
from typing import Any

import nbformat
from nbformat.v4 import new_markdown_cell

from ...errors import InputRefused
from ...output.staging import staged
from .lesson_page import lesson_page
from .pages import lesson_head, write_pages
from .panel_html import SCRIPTS, STYLES, write_front

NEEDS = ("nbformat", "anywidget", "sphinx", "myst_nb", "numpydoc", "furo")
"""Modules of the extras ``lab`` and ``site``."""
NAMES = (
    *("index.html", "genindex.html", "py-modindex.html", "search.html", "searchindex.js"),
    *("CONTRIBUTING.html", "CHANGELOG.html"),
    *("lessons", "docs", "api", "pictures", "_static", "_images", "_downloads"),
)
"""All that lies in the folder of a site."""
_FRONT = "front"  # folder of the panels' scripts and styles among the pages
_NAMED = (
    ('<aside class="sidebar-drawer"', '<aside aria-label="All pages" class="sidebar-drawer"'),
    ('<aside class="toc-drawer', '<aside aria-label="This page" class="toc-drawer'),
    ('<div id="search-results">', '<h1>Search</h1>\n<div id="search-results">'),
)
"""Parts of the theme's pages that screen readers could not tell apart, and what they become."""
_CONFIG: dict[str, Any] = {
    "project": "cranio-nb",
    "copyright": "the cranio-nb developers",
    "release": version("cranio-nb"),
    "root_doc": "index",
    "language": "en",
    "extensions": ["myst_nb", "sphinx.ext.autodoc", "numpydoc", "cranio_nb.teaching.site.extension"],
    "exclude_patterns": ["notebooks", _FRONT],
    "default_role": "py:obj",
    "html_theme": "furo",
    "html_title": "cranio-nb",
    "html_css_files": list(STYLES),
    "html_js_files": [(name, {"defer": "defer"}) for name in SCRIPTS],
    "html_math_renderer": "mathml",
    "html_copy_source": False,
    "html_show_sphinx": False,
    "html_show_search_summary": False,  # a summary is fetched, which a page opened from disk may not do
    "html_domain_indices": True,
    "autodoc_typehints": "none",
    "autodoc_member_order": "bysource",
    "numpydoc_show_class_members": False,
    "nb_execution_mode": "off",
    "nb_merge_streams": True,
    "nb_code_prompt_show": "Show the answer",
    "nb_code_prompt_hide": "Hide the answer",
    "myst_enable_extensions": ["dollarmath"],
    "myst_heading_anchors": 3,
}


def build_site(
    project: Path, out: Path, only: str = "", repository: str = "", tell: Callable[[str], None] = lambda line: None
) -> Path:
    """Build the site from the stored notebooks; only what draws their panels is run.

    Parameters
    ----------
    project : path
        The project's folder, with its ``notebooks``, ``docs`` and README.
    out : path
        Folder for the site.
    only : str
        Only lessons whose name starts so, e.g. "04".
    repository : str
        "OWNER/NAME" on GitHub, for links that open the lessons in Binder and Colab.
    tell : callable
        Is given one line for each part that is done.

    Returns
    -------
    path
        The start page.

    Raises
    ------
    InputRefused
        ``NoSite`` without the extra, ``NoLessons``, ``NoProject``, ``OutOfStep``, ``BadPage`` where Sphinx warns.
    CannotWrite
        Where the system refuses.
    """
    if lacking := [name for name in NEEDS if find_spec(name) is None]:
        raise InputRefused("NoSite", f"Not installed: {', '.join(lacking)}.", 'Run: pip install "cranio-nb[lab,site]".')
    notebooks = sorted((project / "notebooks").glob(f"{only}*.ipynb"))
    if not notebooks:
        raise InputRefused("NoLessons", f"There are no notebooks in {project.name}/notebooks.", "Build them first.")
    with tempfile.TemporaryDirectory() as folder, staged(out, NAMES) as part:
        source = Path(folder) / "source"
        source.mkdir()
        write_pages(project, source, [path.stem for path in notebooks])
        shutil.copytree(project / "notebooks", source / "notebooks", ignore=shutil.ignore_patterns("src", "*.toml"))
        (source / "lessons").mkdir()
        (source / _FRONT).mkdir()
        write_front(source / _FRONT)
        for path in notebooks:
            # the lesson, with the ways to a running copy below its title
            page = lesson_page(nbformat.read(path, as_version=4), f"../pictures/{path.stem}")
            page.notebook.cells.insert(1, new_markdown_cell(lesson_head(path.stem, repository), id="head"))
            nbformat.write(page.notebook, source / "lessons" / path.name)
            _write_pictures(part / "pictures" / path.stem, page.files)
            tell(f"{path.stem}: {len(page.files)} pictures, {sum(map(len, page.files.values())) / 1e6:.1f} MB")
        run_sphinx(source, part, Path(folder) / "trees")
    return out / "index.html"


def run_sphinx(source: Path, out: Path, trees: Path) -> None:
    """Let Sphinx make the pages.

    Parameters
    ----------
    source, out, trees : path
        Folders of its pages, of the HTML and of its own notes.

    Raises
    ------
    InputRefused
        ``BadPage``, with Sphinx's first warnings: a link that leads nowhere, a page that nothing leads to.
    """
    from sphinx.application import Sphinx
    from sphinx.util.docutils import docutils_namespace, patch_docutils

    said = StringIO()
    config = _CONFIG | {"html_static_path": [str(source / _FRONT)]}
    with patch_docutils(), docutils_namespace():  # else a second site in one process hears of the first
        Sphinx(source, None, out, trees, "html", config, status=None, warning=said).build()
    if said.getvalue():
        raise InputRefused("BadPage", f"Sphinx warns: {said.getvalue()[:1000]}", "Mend the page.")
    for path in out.rglob("*.html"):
        text = path.read_text("utf-8")
        for part, named in _NAMED:
            text = text.replace(part, named)
        path.write_bytes(text.encode())
    # for machines that build upon each other's docs, and for the next build: nothing a reader needs
    for name in (".buildinfo", "objects.inv"):
        (out / name).unlink(missing_ok=True)
    shutil.rmtree(out / "_sources", ignore_errors=True)


def _write_pictures(folder: Path, files: dict[str, bytes]) -> None:
    folder.mkdir(parents=True)
    for name, data in files.items():
        (folder / name).write_bytes(data)
