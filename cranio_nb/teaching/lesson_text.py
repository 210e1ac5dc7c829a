"""A lesson text (`src/NN_topic.py`, jupytext percent) -> a notebook without outputs.

Tags of a cell say what it is: ``solution`` (one function; the student's copy holds its head and a stub), ``check``
(calls `check.exercise`), ``expected`` (draws with the student's function), ``raises-exception`` (a mistake shown on
purpose). A cell whose text output is compared in tests has the tag ``nbval-check-output``.
"""

from __future__ import annotations

import ast
import hashlib
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

import jupytext
import nbformat
from nbformat import NotebookNode
from nbformat.v4 import new_code_cell, new_markdown_cell

from ..errors import InputRefused

METADATA = {
    "kernelspec": {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"},
    "language_info": {"file_extension": ".py", "mimetype": "text/x-python", "name": "python"},
}
"""Metadata of every notebook: no traces of the machine it was made on."""
_PICTURE = re.compile(r"\(data:image/[^)]*\)")
_SET_UP = """# On Colab this installs the package; elsewhere it does nothing. SOURCE is what pip can take:
# the package's name, a wheel or zip that you uploaded, or "git+" and the project's address.
SOURCE = "cranio-nb"
import subprocess, sys

if "google.colab" in sys.modules:
    wanted = f"cranio-nb[view] @ {SOURCE}" if "git+" in SOURCE else f"{SOURCE}[view]"
    command = [sys.executable, "-m", "pip", "install", "-q", wanted, "anywidget"]
    subprocess.run(command, check=True)"""


def read_lesson(source: Path) -> NotebookNode:
    """A lesson text as a notebook without outputs, with a cell for Colab; ids follow from the cells' text.

    Parameters
    ----------
    source : path
        A script in Jupytext's percent format.

    Returns
    -------
    NotebookNode

    Raises
    ------
    InputRefused
        ``BadLesson`` where a solution is not one function with a docstring.
    """
    notebook = jupytext.read(source, fmt="py:percent")
    cells = [
        (new_markdown_cell if cell.cell_type == "markdown" else new_code_cell)(
            cell.source, metadata={"tags": cell.metadata["tags"]} if cell.metadata.get("tags") else {}
        )
        for cell in notebook.cells
    ]
    _check_solutions(source.stem, cells)
    return make_notebook([cells[0], new_code_cell(_SET_UP), *cells[1:]])


def tags(cell: NotebookNode) -> list[str]:
    """Tags of a cell.

    Parameters
    ----------
    cell : NotebookNode

    Returns
    -------
    list of str

    Examples
    --------
    >>> tags(new_code_cell("1 / 0", metadata={"tags": ["raises-exception"]}))
    ['raises-exception']
    """
    return list(cell.metadata.get("tags", []))


def make_notebook(cells: Sequence[NotebookNode]) -> NotebookNode:
    """A notebook whose ids are the same whenever its cells are.

    Parameters
    ----------
    cells : sequence of NotebookNode
        They get their ids.

    Returns
    -------
    NotebookNode

    Examples
    --------
    >>> one, other = (make_notebook([new_code_cell("1"), new_code_cell("1")]) for _ in range(2))
    >>> one == other, one.cells[0].id == one.cells[1].id
    (True, False)
    """
    for cell, name in zip(cells, cell_ids(cells), strict=True):
        cell.id = name
    return nbformat.v4.new_notebook(cells=list(cells), metadata=METADATA)


def cell_ids(cells: Iterable[NotebookNode]) -> list[str]:
    """Names of cells that follow from their texts, not from the pictures in them: these differ between machines.

    Parameters
    ----------
    cells : iterable of NotebookNode

    Returns
    -------
    list of str
        Each of 12 letters and digits; cells of one text have different ones.
    """
    seen: dict[str, int] = {}
    found = []
    for cell in cells:
        words = without_pictures(cell.source)
        n = seen[words] = seen.get(words, 0) + 1
        found.append(hashlib.sha256(f"{n} {cell.cell_type} {words}".encode()).hexdigest()[:12])
    return found


def without_pictures(source: str) -> str:
    """The text of a cell without the pictures that are written into it.

    Parameters
    ----------
    source : str

    Returns
    -------
    str

    Examples
    --------
    >>> without_pictures("![a hole](data:image/png;base64,iVBORw0K) is what you should see")
    '![a hole]() is what you should see'
    """
    return _PICTURE.sub("()", source)


def _check_solutions(name: str, cells: list[NotebookNode]) -> None:
    """Refuse a solution that is not one documented function."""
    for cell in cells:
        if "solution" in tags(cell):
            body = ast.parse(cell.source).body
            if len(body) != 1 or not isinstance(body[0], ast.FunctionDef) or not ast.get_docstring(body[0]):
                raise InputRefused("BadLesson", f"A solution of {name} is not just one function with a docstring.")
