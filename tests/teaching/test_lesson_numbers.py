"""Each decimal and each number of mm, degrees or percent in a lesson's text stands in its outputs or its code."""

import re

import nbformat
import pytest
from lesson_cells import FOLDER, NAMES

CHECKED = [name for name in NAMES if name[:2] in ("06", "07", "08", "09", "10")]
CITED = {"09_three_d": {"0.935", "0.943"}}  # measured on real skulls, in the README's table
SUPPOSED = {"06_surface_reconstruction": {"45"}, "09_three_d": {"100"}}  # a slope of 1 in 1; a hole to think of
NUMBER = re.compile(r"(?<![\w.-])(?:\d+\.\d+(?![\w.])|\d{2,}(?= (?:mm|degrees|%)))")


def spoken(notebook):
    """The numbers of the text, without headings and the numbers of exercises."""
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            text = re.sub(r"^#.*$|[Ee]xercise\s+\d+\.\d+|`[^`]*`", "", cell.source, flags=re.M)
            yield from NUMBER.findall(text)


def shown(notebook):
    """What the cells print, draw a line about, or are given."""
    for cell in notebook.cells:
        if cell.cell_type == "code":
            yield cell.source
            for out in cell.outputs:
                yield out.get("text") or out.get("evalue") or out.data.get("text/plain", "")


@pytest.mark.parametrize("name", CHECKED)
def test_each_number_of_the_text_stands_in_an_output_or_in_code(name):
    notebook = nbformat.read(FOLDER / f"{name}.ipynb", 4)
    known = set(re.findall(r"\d+\.\d+|(?<![\d.])\d+(?![\d.])", "\n".join(shown(notebook))))
    cited = CITED.get(name, set())
    assert cited <= set(NUMBER.findall((FOLDER.parent / "README.md").read_text()))
    lost = [
        number for number in dict.fromkeys(spoken(notebook)) if number not in known | cited | SUPPOSED.get(name, set())
    ]
    assert not lost, f"{name}: no cell shows {', '.join(lost)}"
