"""The commands `lessons ...` print what was done, and fail where lessons are out of step."""

from pathlib import Path

from cli_runs import cranio

from cranio_nb.teaching import build, web_pages


def test_build_prints_what_it_wrote(monkeypatch):
    monkeypatch.setattr(build, "build", lambda folder, only: [folder / f"{only}_a.ipynb"])
    result = cranio("lessons", "build", "--folder", "here", "--only", "04")
    assert result.exit_code == 0 and result.stdout == str(Path("here") / "04_a.ipynb") + "\n"


def test_a_check_fails_on_problems_and_writes_nothing(monkeypatch):
    monkeypatch.setattr(build, "build", lambda *a: 1 / 0)
    monkeypatch.setattr(build, "out_of_step", lambda folder, only: ["04 is older than its text."])
    result = cranio("lessons", "build", "--check")
    assert (result.exit_code, result.stdout, result.stderr) == (1, "", "04 is older than its text.\n")
    monkeypatch.setattr(build, "out_of_step", lambda folder, only: [])
    assert cranio("lessons", "build", "--check").exit_code == 0


def test_html_prints_each_page(monkeypatch, tmp_path):
    monkeypatch.setattr(web_pages, "write_pages", lambda folder, out: [out / "a.html", out / "b.html"])
    assert cranio("lessons", "html", tmp_path).stdout.split() == [str(tmp_path / "a.html"), str(tmp_path / "b.html")]


def test_grades_are_summed(monkeypatch):
    monkeypatch.setattr(build, "points", lambda path: {"4.1": (1, 2), "4.2": (3, 3)})
    result = cranio("lessons", "grade", "handed_in.ipynb")
    assert result.exit_code == 0 and result.stdout == "handed_in.ipynb  4/5  4.1: 1/2  4.2: 3/3\n"
