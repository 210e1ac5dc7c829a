"""Whatever is handed in is run as far as it goes, and ends nothing but itself."""

import json

import pytest
from hand_ins import write_hand_in

from cranio_nb.teaching.grading import running


def shown(cell):
    return "".join(output.get("text", output.get("ename", "")) for output in cell.outputs)


def test_a_notebook_is_run_past_everything_that_goes_wrong_in_it(tmp_path, monkeypatch, capfd):
    monkeypatch.setattr(running, "CELL_S", 2)
    texts = [
        "while True: pass",
        "1 / 0",
        "input()",
        "for i in range(3000): print(i, flush=True)",
        "print('here')",
        "import os, sys; print('bye', file=sys.stderr, flush=True); os._exit(3)",
        "print('never')",
    ]
    notebook, remark = running.read_hand_in(write_hand_in(tmp_path / "a.ipynb", *texts))
    assert remark == ""
    remark = running.run_hand_in(notebook)
    assert remark == "The notebook could not be run to its end (DeadKernelError)."
    endless, failed, asked, flood, here, _, never = map(shown, notebook.cells)
    assert "KeyboardInterrupt" in endless and failed == "ZeroDivisionError" and asked == "StdinNotImplementedError"
    assert here == "here\n" and never == "" and flood.count("\n") <= 3000
    assert capfd.readouterr() == ("", "")


HEAD = {"nbformat": 4, "nbformat_minor": 5, "metadata": {}}
CODE = {"cell_type": "code", "source": ["a = 1\n", "a"], "metadata": {}}
OLD = {"cell_type": "code", "language": "python", "input": ["a = 1\n", "a"], "outputs": [], "metadata": {}}


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"no notebook",
        b"{}",
        b"3",
        b"\xff\xfe\x00",
        b"[" * 100_000,
        *(json.dumps(HEAD | {"cells": cells}).encode() for cells in (3, [1], [{"cell_type": "code", "source": {}}])),
        json.dumps(HEAD).encode(),
        json.dumps(HEAD | {"cells": [{"cell_type": "code"}]}).encode(),
        json.dumps(HEAD | {"cells": [CODE | {"outputs": "none"}]}).encode(),
    ],
)
def test_what_is_no_notebook_is_told_and_has_no_cells(tmp_path, content):
    path = tmp_path / "a.ipynb"
    path.write_bytes(content)
    notebook, remark = running.read_hand_in(path)
    assert notebook.cells == [] and remark.startswith("The file cannot be read as a notebook")


@pytest.mark.parametrize(
    "content",
    [
        HEAD | {"cells": [CODE, {"cell_type": "markdown", "source": "words", "metadata": {}}]},
        HEAD | {"cells": [CODE | {"metadata": {"tags": ["skip-execution"]}, "execution_count": "x"}]},
        {"nbformat": 3, "nbformat_minor": 0, "metadata": {}, "worksheets": [{"cells": [OLD]}]},
    ],
    ids=["no ids", "tags", "version 3"],
)
def test_the_code_of_odd_notebooks_is_read(tmp_path, content):
    (tmp_path / "a.ipynb").write_text(json.dumps(content))
    notebook, remark = running.read_hand_in(tmp_path / "a.ipynb")
    assert remark == "" and [cell.source for cell in notebook.cells] == ["a = 1\na"]
    assert notebook.cells[0].metadata == {} and notebook.cells[0].outputs == []


def test_a_folder_in_place_of_a_notebook_is_told(tmp_path):
    notebook, remark = running.read_hand_in(tmp_path)
    assert notebook.cells == [] and remark
