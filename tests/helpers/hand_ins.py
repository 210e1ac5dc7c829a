"""Notebooks as students hand them in, made of the texts of their code cells."""

import nbformat
from nbformat.v4 import new_code_cell, new_notebook

CHECKS = "from cranio_nb.teaching import check"


def write_hand_in(path, *cells):
    """A notebook of code cells at a path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    nbformat.write(new_notebook(cells=[new_code_cell(text) for text in cells]), path)
    return path
