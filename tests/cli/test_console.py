"""What is printed: plain text, strict JSON, and nothing on stdout but results."""

import json

import numpy as np
import pytest

from cranio_nb.cli import console


def test_a_table_shows_every_cell_and_no_markup(capsys):
    console.print_table("Title", ("Name", "Value"), [("[bold]a[/bold]", "1"), ("b", "[2]")])
    said = capsys.readouterr().out
    assert all(word in said for word in ("Title", "Name", "Value", "[bold]a[/bold]", "[2]")) and "\x1b" not in said


def test_a_table_without_a_head_has_none(capsys):
    console.print_table("", ("", ""), [("a", "1")])
    assert [line.split() for line in capsys.readouterr().out.splitlines() if line.strip()] == [["a", "1"]]


def test_json_is_strict(capsys):
    console.print_json({"gap": np.float32(0.5), "ratio": np.nan})
    assert json.loads(capsys.readouterr().out, parse_constant=pytest.fail) == {"gap": 0.5, "ratio": None}


def test_no_openings_are_no_table(capsys):
    console.print_openings([])
    assert capsys.readouterr().out == ""


def test_progress_says_nothing_where_there_is_no_terminal(capsys):
    with console.progress_bar() as progress:
        progress("reading", 0.5)
    assert capsys.readouterr() == ("", "")
