"""The shipped lessons, and the cells of a notebook by kind and tag."""

from pathlib import Path

from cranio_nb.teaching.lesson_text import tags

FOLDER = Path(__file__).parents[2] / "notebooks"
SOURCES = sorted((FOLDER / "src").glob("*.py"))
NAMES = [path.stem for path in SOURCES]


def code(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def tagged(notebook, tag):
    return [cell for cell in code(notebook) if tag in tags(cell)]
