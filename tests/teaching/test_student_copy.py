"""What students get: stubs, answers folded away, expected pictures with their descriptions."""

import re

import nbformat
import pytest
from lesson_cells import FOLDER, NAMES, code, tagged
from nbformat.v4 import new_code_cell, new_markdown_cell

from cranio_nb.errors import InputRefused
from cranio_nb.teaching.lesson_text import make_notebook
from cranio_nb.teaching.student_copy import exercise_copy, exercise_number, make_stub

SOLUTION = 'def half(x):\n    """Half of x."""\n    return x / 2'


def cell(source, *tags):
    return new_code_cell(source, metadata={"tags": list(tags)})


@pytest.fixture(params=NAMES)
def copy(request):
    return nbformat.read(FOLDER / "exercises" / f"{request.param}.ipynb", as_version=4)


def test_shipped_copies_hold_no_answer_but_folded_away(copy):
    assert not any(cell.outputs or cell.execution_count for cell in code(copy))
    stubs = [cell for cell in code(copy) if "NotImplementedError" in cell.source]
    folded = [c for c in copy.cells if c.cell_type == "markdown" and "<summary>Solution</summary>" in c.source]
    assert len(stubs) == len(folded) == len(tagged(copy, "check")) >= 2
    assert not any("return" in cell.source.split("NotImplementedError")[-1] for cell in stubs)


def test_shipped_copies_name_the_exercise_in_each_stub(copy):
    numbers = [re.search(r'NotImplementedError\("Exercise ([\d.]+)"', cell.source) for cell in code(copy)]
    checks = [re.search(r'check\.exercise\("([\d.]+)"', cell.source)[1] for cell in tagged(copy, "check")]
    assert [hit[1] for hit in numbers if hit] == checks


def test_expected_pictures_lie_in_their_cells_and_are_described(copy):
    for cell in (c for c in copy.cells if "Expected picture" in c.source):
        assert re.search(r"!\[\S.{40,}\]\(data:image/png;base64,[\w+/=]{1000,}\)", cell.source)


def test_a_solution_becomes_a_stub_and_is_folded_away_below_its_check():
    check = cell('check.exercise("1.2", half)', "check")
    check.outputs = [nbformat.v4.new_output("stream", text="3 of 3 points")]
    copy = exercise_copy(make_notebook([new_markdown_cell("# A"), cell(SOLUTION, "solution"), check]))
    title, how, stub, asked, answer = copy.cells
    assert title.source == "# A" and "copy to work in" in how.source
    assert "return" not in stub.source and stub.source.endswith('raise NotImplementedError("Exercise 1.2")')
    assert "solution" not in stub.metadata.get("tags", []) and not asked.outputs
    assert SOLUTION in answer.source and answer.source.startswith("<details>")


def test_a_solution_has_the_number_of_the_first_check_after_it():
    first, second = cell("def a(): ...", "solution"), cell("def b(): ...", "solution")
    cells = [first, cell('check.exercise("1.1", a)', "check"), second, cell('check.exercise("1.2", b)', "check")]
    assert [exercise_number(cells, one) for one in (first, second)] == ["1.1", "1.2"]
    with pytest.raises(InputRefused, match="no check after it"):
        exercise_number(cells[:3], second)


def test_a_stub_keeps_head_and_docstring_and_says_what_is_missing():
    names = {}
    exec(make_stub(SOLUTION, "7.3"), names)  # text of this test
    assert names["half"].__doc__ == "Half of x."
    with pytest.raises(NotImplementedError, match=r"Exercise 7\.3"):
        names["half"](1)
