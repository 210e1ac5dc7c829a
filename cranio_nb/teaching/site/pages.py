"""The project's folder -> the pages that Sphinx reads: start page, docs, API reference, a head for each lesson.

The README and the docs keep their text; only links between files become links between pages.
"""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from urllib.parse import quote

from ...errors import InputRefused
from .downloads import EXERCISES, PROJECT, write_exercises, write_project

API = {
    "Nouns": ("volume", "mesh", "curves", "opening", "prosthesis", "errors"),
    "The paper's five stages": (
        "stages.segmentation",
        "stages.feature_extraction",
        "stages.deformable_model",
        "stages.prosthesis_volume",
        "stages.surface_reconstruction",
    ),
    "Measures": ("evaluation.scores", "evaluation.paper_tables"),
}
"""Modules that have a page, under their headings."""
TEXTS = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "LICENSE", "CITATION.cff")
"""Files of the project that the site holds beside its docs."""
_BINDER = "https://mybinder.org/v2/gh/{repository}/HEAD?urlpath={path}"
_COLAB = "https://colab.research.google.com/github/{repository}/blob/main/{path}"

_GET = f"""
Here is the whole project: {{download}}`{PROJECT} <downloads/{PROJECT}>`. Unpack it; its folder is what is called
a clone below. The students' copies of the lessons alone: {{download}}`{EXERCISES} <downloads/{EXERCISES}>`.
"""


def write_pages(project: Path, out: Path, lessons: Sequence[str]) -> None:
    """Write all pages but the lessons.

    Parameters
    ----------
    project : path
        The project's folder.
    out : path
        An empty folder.
    lessons : sequence of str
        Names of the lessons' pages, in their order.

    Raises
    ------
    InputRefused
        ``NoProject`` where a text is missing.
    """
    missing = [name for name in TEXTS if not (project / name).is_file()]
    if missing:
        message = f"The folder {project.name} holds no {', '.join(missing)}."
        raise InputRefused("NoProject", message, "Run this in a clone of the project.")
    for name in TEXTS[1:]:
        shutil.copy(project / name, out)
    shutil.copytree(project / "docs", out / "docs", ignore=shutil.ignore_patterns("*.py", "__pycache__"))
    docs = sorted(path.stem for path in (project / "docs").glob("*.md"))
    _write_api(out / "api")
    parts = {
        "Lessons": [f"lessons/{name}" for name in lessons],
        "How to": [f"docs/{name}" for name in docs],
        "Reference": ["api/index"],
        "Project": ["CONTRIBUTING", "CHANGELOG"],
    }
    (out / "downloads").mkdir()
    write_project(project, out / "downloads" / PROJECT)
    write_exercises(project, out / "downloads" / EXERCISES)
    trees = "\n\n".join(_tree(title, names) for title, names in parts.items())
    before, heading, after = (project / "README.md").read_text("utf-8").partition("## Two commands\n")
    (out / "index.md").write_text(f"{before}{heading}{_GET}{after}\n{trees}\n", "utf-8")


def lesson_head(name: str, repository: str) -> str:
    """Ways to a lesson that runs: files to download, and services that open it.

    Parameters
    ----------
    name : str
        Of the notebook, without its suffix.
    repository : str
        "OWNER/NAME" on GitHub; empty where there is none.

    Returns
    -------
    str
        Markdown.

    Examples
    --------
    >>> lesson_head("04_balloon", "").split(", ")[0]
    'Work in {download}`the copy for students <../notebooks/exercises/04_balloon.ipynb>`'
    """
    path = f"notebooks/exercises/{name}.ipynb"
    text = (
        f"Work in {{download}}`the copy for students <../{path}>`, or take {{download}}`this lesson with all answers "
        f"<../notebooks/{name}.ipynb>`. (If a browser shows it as text instead: right-click, *Save link as*; or take "
        f"{{download}}`all copies for students <../downloads/{EXERCISES}>`.)"
    )
    if repository:
        binder = _BINDER.format(repository=repository, path=quote(f"lab/tree/{path}", safe=""))
        colab = _COLAB.format(repository=repository, path=path)
        text += f" Without installing anything: [open it in Binder]({binder}) or [in Colab]({colab})."
    return text


def _write_api(folder: Path) -> None:
    """The reference: a page for the package's face, and one for each module of `API`."""
    folder.mkdir()
    package = import_module("cranio_nb")
    names = [name for name in package.__all__ if not name.startswith("_")]
    face = [_heading("The face of the package"), ".. currentmodule:: cranio_nb\n"]
    for name in names:
        kind = "class" if isinstance(getattr(package, name), type) else "function"
        face.append(f".. auto{kind}:: {name}\n" + ("   :members:\n" if kind == "class" else ""))
    (folder / "face.rst").write_text("\n".join(face), "utf-8")
    trees = [_rst_tree("", ["face"])]
    for title, modules in API.items():
        for module in modules:
            (folder / f"{module}.rst").write_text(_module_page(module), "utf-8")
        trees.append(_rst_tree(title, modules))
    (folder / "index.rst").write_text(_heading("API reference") + "\n".join(trees), "utf-8")


def _module_page(name: str) -> str:
    """A module with its public members, without what it imports."""
    module = import_module(f"cranio_nb.{name}")
    foreign = [
        key for key, value in vars(module).items() if getattr(value, "__module__", "") not in ("", module.__name__)
    ]
    options = f"   :members:\n   :exclude-members: {', '.join(foreign)}\n"
    return _heading(name) + f".. automodule:: {module.__name__}\n{options}"


def _heading(text: str) -> str:
    return f"{text}\n{'=' * len(text)}\n\n"


def _rst_tree(title: str, names: Sequence[str]) -> str:
    caption = f"   :caption: {title}\n" if title else ""
    return f".. toctree::\n{caption}\n" + "".join(f"   {name}\n" for name in names)


def _tree(title: str, names: Sequence[str]) -> str:
    return f"```{{toctree}}\n:hidden:\n:caption: {title}\n\n" + "\n".join(names) + "\n```"
