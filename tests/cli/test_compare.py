"""The command `compare`: its table, its folder, its exit codes."""

import pytest
from cli_runs import cranio
from html_page import Page
from stand_ins import only_stand_ins

from cranio_nb.methods import catalogue
from cranio_nb.output import comparison_folder
from cranio_nb.pipeline import compare
from cranio_nb.pipeline.trial import attempt, contenders


def test_writes_its_files_and_prints_the_table(compared_home, tmp_path):
    arguments = ("--truth", compared_home / "truth.nii.gz", "--method", "slicewise:paper", "--out", tmp_path / "out")
    result = cranio("compare", compared_home / "skull.nii.gz", *arguments)
    assert result.exit_code == 0, result.output
    assert {p.name for p in (tmp_path / "out").iterdir()} == set(comparison_folder.FILES)
    assert "slicewise:paper" in result.stdout and "Border DSC" in result.stdout and result.stderr == ""
    text = (tmp_path / "out" / "comparison.html").read_text()
    assert str(compared_home) not in text


def test_without_a_folder_nothing_is_written(compared_home, found, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(compare, "compare", lambda *a, **k: found)
    result = cranio("compare", compared_home / "skull.nii.gz")
    assert result.exit_code == 0 and list(tmp_path.iterdir()) == []
    assert "faulty: broken" in result.stdout and "refusing: refused" in result.stdout


@pytest.mark.parametrize("arguments", [("--method", "magic"), ("--method", "slicewise:best")], ids=str)
def test_usage_errors(arguments, compared_home, tmp_path):
    assert cranio("compare", compared_home / "skull.nii.gz", *arguments, "--out", tmp_path / "out").exit_code == 2
    assert cranio("compare", compared_home / "skull.nii.gz", "--out", compared_home / "skull.nii.gz").exit_code == 2
    assert list(tmp_path.iterdir()) == []


def test_where_none_makes_anything_the_page_says_why(compared_home, compared_case, tmp_path, monkeypatch):
    with only_stand_ins():
        none = compare.compare(compared_case, contenders(["finding_nothing", "refusing"]), attempt=attempt)
    assert none.distances == {} and none.pairs == {}
    monkeypatch.setattr(compare, "compare", lambda *a, **k: none)
    result = cranio("compare", compared_home / "skull.nii.gz", "--out", tmp_path)
    assert result.exit_code == 4 and "Nothing was bridged." in result.stdout
    page = Page((tmp_path / "comparison.html").read_text())
    assert not page.all("img") and "Nothing was bridged." in page.text


def test_refused_inputs_leave_nothing(tmp_path):
    assert cranio("compare", tmp_path / "missing", "--out", tmp_path / "out").exit_code == 3
    assert list(tmp_path.iterdir()) == []


def test_every_method_is_named_in_the_help():
    for command in ("compare", "design"):
        text = "".join(cranio(command, "--help").stdout.split())  # names may be wrapped
        assert all(name in text for name in catalogue.METHODS)
