"""Each number of a lesson's text is shown by a cell of its section, set in its code, or quoted from a source it names.

A number is a decimal, one of two digits or more, one with a unit, or a word from seven to twelve. Its section is what
stands under one heading of the second level. What is above the first one, "Parameters" and "Summary" speak of the whole
lesson; a paragraph may name other sections ("section 2"), the paper, the README or `data_synth.phantom`. What is
printed is a result, what is written in code is a setting. Left out is what claims nothing: headings, references,
numbers of lists, years, times of reading and running, formulas but for their decimals, right and straight angles.
"""

import re

import nbformat
import pytest
from lesson_cells import FOLDER, NAMES, code
from lesson_numbers import lost_numbers, spoken, typed_texts
from nbformat import v4


@pytest.fixture(params=NAMES)
def lesson(request):
    return request.param, nbformat.read(FOLDER / f"{request.param}.ipynb", 4)


def test_each_number_of_the_text_is_shown_set_or_quoted(lesson):
    lost = lost_numbers(*lesson)
    assert not lost, "\n".join(f"{heading}: no cell shows {number} ({where})" for heading, number, where in lost)


def test_no_decimal_is_typed_into_what_is_printed(lesson):
    """A typed number would be found in the output, and prove nothing."""
    texts = [text for cell in code(lesson[1]) for text in typed_texts(cell.source)]
    plain = [text for text in texts if not re.fullmatch(r"\d\.\d|[<>+ ]*\d*\.\d+f?", text)]  # exercises, formats
    assert not [text for text in plain if re.search(r"\d\.\d", text)]


def test_a_number_must_be_shown_in_its_own_section_or_in_one_that_is_named():
    def section(number, text, printed):
        output = v4.new_output("stream", text=printed)
        return [v4.new_markdown_cell(f"## {number}. A part\n\n{text}"), v4.new_code_cell("show(4.5)", outputs=[output])]

    first = section(1, "We set 4.5 mm and get 7.5 mm.", "7.50 mm")
    notebook = v4.new_notebook(cells=first + section(2, "Not 7.5 mm.\n\nSection 1 has 7.5 mm; the paper 3.09.", "8"))
    assert [(heading, number) for heading, number, _ in lost_numbers("00_tour", notebook)] == [("2. A part", "7.5")]


def test_numbers_are_found_where_they_claim_something_and_not_elsewhere():
    text = "Lessons 03 and 04, section 2: 3 px, 4.5 mm and $r = 0.38$ in `x = 7.5`, ten steps, 5 % of 12.\n1. Two"
    assert spoken(text) == ["3", "4.5", "0.38", "ten", "5", "12"]
