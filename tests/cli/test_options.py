"""Shared options: what is read from them, and what is refused before any work."""

from pathlib import Path

import click
import pytest
from cli_runs import cranio

from cranio_nb.cli import options
from cranio_nb.errors import InputRefused


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
    (tmp_path / "ct").mkdir()
    with pytest.raises(click.BadParameter, match="INPUT"):
        options.check_writes(Path("ct"), ("a.txt",), {"scan": tmp_path / "ct"})
    options.check_writes(Path("out"), ("a.txt",), {"scan": tmp_path / "ct"})


@pytest.mark.parametrize(
    ("name", "called"), [("scan", "INPUT"), ("from_", "--from"), ("truth", "--truth"), ("patch", "PATCH")]
)
def test_the_path_that_is_missing_is_called_as_on_the_command_line(name, called, tmp_path):
    with pytest.raises(InputRefused, match=f"given as {called}") as refusal:
        options.check_reads(**{name: tmp_path / "none"})
    assert refusal.value.code == "NotFound" and str(tmp_path) not in str(refusal.value)


@pytest.mark.parametrize("value", ["-500", "49.9", "3001", "nan", "inf", "-inf"])
def test_a_threshold_that_is_none_of_bone_is_refused_with_its_range(value):
    result = cranio("inspect", "scan", "--threshold", value)
    assert result.exit_code == 2 and "Give a number from 50 to 3000 HU" in " ".join(result.stderr.split())


def test_a_tilde_is_the_home_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    assert options.PATH.convert("~/scan", None, None) == tmp_path / "scan"
    assert options.PATH.convert("a~b", None, None) == Path("a~b")


def test_an_index_is_not_a_scan(tmp_path):
    (tmp_path / "DICOMDIR").write_bytes(bytes(200))
    result = cranio("inspect", tmp_path / "DICOMDIR")
    assert result.exit_code == 3 and "Give the folder" in result.stderr


@pytest.mark.parametrize(
    "text",
    [
        *(
            '{"tol": NaN}',
            '{"tol": Infinity}',
            '{"tol": 1e999}',
            '{"max_iter": -1}',
            '{"skip_mm": -1}',
            '{"tension": 0}',
        ),
        *('{"tol": true}', '{"max_iter": 2.0}', '{"max_iter": 1' + "0" * 6000 + "}", "[" * 100_000, "\ufeff", "1", ""),
        *('{"tol": ' + "[" * 100_000 + "]" * 100_000 + "}", '{"' + "a" * 2_000_000 + '": 1}', '{"tol": null}'),
    ],
    ids=lambda text: text[:14],
)
def test_params_that_are_none_are_a_usage_error_in_one_sentence(text, tmp_path):
    (tmp_path / "a.json").write_text(text, encoding="utf-8")
    result = cranio("design", "scan", "--params", tmp_path / "a.json", "--out", tmp_path / "out")
    assert result.exit_code == 2 and "--params" in result.stderr and len(result.stderr) < 700


@pytest.mark.parametrize(
    ("command", "option", "range_"),
    [
        (("inspect", "scan"), "--label", "1 to 2147483647"),
        (("phantom", "out"), "--seed", "0 to 4294967295"),
        (("lab",), "--port", "1024 to 65535"),
    ],
)
def test_a_number_beyond_its_range_is_a_usage_error_with_the_range(command, option, range_):
    for value in ("-1", "1" + "0" * 30, "1" * 6000, "nan", "1.5", "x", ""):
        result = cranio(*command, f"{option}={value}")
        assert result.exit_code == 2 and range_ in " ".join(result.stderr.split()), value


@pytest.mark.parametrize("text", ["-1:3", "5:3", "0:65536", "1:" + "9" * 6000])
def test_planes_have_a_range(text):
    with pytest.raises(click.BadParameter, match="two plane numbers"):
        options.parse_planes(text)
