"""Texts of lessons become notebooks: cells in order, tags kept, ids that follow from the text alone."""

import subprocess
import sys

import nbformat
import pytest
from lesson_cells import code, tagged
from packaging.requirements import Requirement

from cranio_nb.errors import InputRefused
from cranio_nb.teaching.lesson_text import read_lesson

TEXT = '''# %% [markdown]
# # A lesson

# %% tags=["solution"]
def half(x):
    """Half of x."""
    return x / 2

# %%
1 + 1

# %%
1 + 1
'''


@pytest.fixture
def read(tmp_path):
    """Reads a text as a lesson."""

    def as_lesson(text):
        path = tmp_path / "90_small.py"
        path.write_text(text)
        return read_lesson(path)

    return as_lesson


def test_cells_keep_their_order_and_tags_below_the_one_for_colab(read):
    notebook = read(TEXT)
    nbformat.validate(notebook)
    kinds = [cell.cell_type for cell in notebook.cells]
    assert kinds == ["markdown", "code", "code", "code", "code"] and notebook.cells[0].source == "# A lesson"
    assert "google.colab" in notebook.cells[1].source and not any(cell.outputs for cell in code(notebook))
    assert [cell.source.split("(")[0] for cell in tagged(notebook, "solution")] == ["def half"]


@pytest.mark.parametrize("source", ["cranio-nb", "./cranio_nb-0.1-py3-none-any.whl", "git+https://localhost/b/c"])
def test_on_colab_pip_is_asked_for_what_it_understands(read, monkeypatch, source):
    asked = []
    monkeypatch.setitem(sys.modules, "google.colab", None)
    monkeypatch.setattr(subprocess, "run", lambda command, check: asked.extend(command))
    exec(read(TEXT).cells[1].source.replace('SOURCE = "cranio-nb"', f"SOURCE = {source!r}"), {})
    wanted = asked[-2]
    if source.endswith(".whl"):
        assert wanted == f"{source}[view]"  # pip takes a path with extras, which is no requirement of the standard
    else:
        requirement = Requirement(wanted)
        assert requirement.extras == {"view"} and requirement.name == "cranio-nb"
        assert requirement.url == (source if "+" in source else None)


def test_ids_are_unique_and_follow_from_the_text(read):
    ids = [cell.id for cell in read(TEXT).cells]
    assert len(set(ids)) == len(ids) and ids == [cell.id for cell in read(TEXT).cells]
    changed = [cell.id for cell in read(TEXT.replace("A lesson", "Another")).cells]
    assert changed[0] != ids[0] and changed[1:] == ids[1:]


@pytest.mark.parametrize("old", ['    """Half of x."""\n', "def half(x):"], ids=["no docstring", "two functions"])
def test_a_solution_is_one_function_with_a_docstring(read, old):
    new = "" if "Half" in old else "def other():\n    pass\n\ndef half(x):"
    with pytest.raises(InputRefused) as refused:
        read(TEXT.replace(old, new))
    assert refused.value.code == "BadLesson"
