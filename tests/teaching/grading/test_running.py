"""Whatever is handed in is run as far as it goes, and ends nothing but itself."""

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


@pytest.mark.parametrize("content", [b"", b"no notebook", b"{}", b'{"cells": 3}', b"\xff\xfe\x00", b"[" * 100_000])
def test_what_is_no_notebook_is_told_and_has_no_cells(tmp_path, content):
    path = tmp_path / "a.ipynb"
    path.write_bytes(content)
    notebook, remark = running.read_hand_in(path)
    assert notebook.cells == [] and remark.startswith("The file cannot be read as a notebook")


def test_a_folder_in_place_of_a_notebook_is_told(tmp_path):
    notebook, remark = running.read_hand_in(tmp_path)
    assert notebook.cells == [] and remark
