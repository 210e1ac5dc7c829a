"""Shared options: what is read from them, and what is refused before any work."""

from pathlib import Path

import click
import pytest

from cranio_nb.cli import options
from cranio_nb.errors import CannotWrite


@pytest.mark.parametrize(("text", "planes"), [("0:0", (0, 0)), ("40:75", (40, 75)), (None, None)])
def test_planes_are_two_numbers(text, planes):
    assert options.parse_planes(text) == planes


@pytest.mark.parametrize("text", ["", "3", "a:b", "1:2:3", "1.5:2"])
def test_other_planes_are_a_usage_error(text):
    with pytest.raises(click.BadParameter) as error:
        options.parse_planes(text)
    assert error.value.param_hint == "--planes"


def test_params_are_those_of_the_file(tmp_path):
    (tmp_path / "a.json").write_text('{"n_snaxels": 31, "axial": true}')
    assert options.read_params("slicewise", tmp_path / "a.json") == {"n_snaxels": 31, "axial": True}
    assert options.read_params("slicewise", None) == {}


@pytest.mark.parametrize("text", ["[1]", "{", '{"snaxels": 3}', None], ids=str)
def test_other_params_are_a_usage_error(text, tmp_path):
    if text is not None:
        (tmp_path / "a.json").write_text(text)
    with pytest.raises(click.BadParameter) as error:
        options.read_params("slicewise", tmp_path / "a.json")
    assert error.value.param_hint == "--params" and str(tmp_path) not in str(error.value)


def test_the_input_is_no_output(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(click.BadParameter):
        options.check_not_input(Path("ct"), tmp_path / "ct")
    options.check_not_input(Path("out"), tmp_path / "ct")


def test_a_series_of_another_is_not_replaced(tmp_path):
    options.check_case_folder(tmp_path)
    (tmp_path / "ct").mkdir()
    with pytest.raises(CannotWrite, match="named ct"):
        options.check_case_folder(tmp_path)
    (tmp_path / "truth.json").write_text("{}")
    options.check_case_folder(tmp_path)
