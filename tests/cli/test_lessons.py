"""The commands `lessons ...` print what was done, and fail where lessons are out of step."""

from pathlib import Path

import pytest
from cli_runs import cranio
from small_site import NAME, write_project

from cranio_nb.teaching import build, web_pages
from cranio_nb.teaching.exercises import LESSONS
from cranio_nb.teaching.grading import marks
from cranio_nb.teaching.grading.marks import HandIn
from cranio_nb.teaching.site import build as site_build
from cranio_nb.teaching.site import slides
from cranio_nb.teaching.verdict import Verdict


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


def test_copies_are_made_once_and_never_over_what_was_worked_in(tmp_path):
    made = cranio("lessons", "copy", tmp_path / "mine")
    assert made.exit_code == 0 and f"cranio-nb lab {tmp_path / 'mine'}" in made.stdout
    assert cranio("lessons", "copy", tmp_path / "mine").exit_code == 0
    path = tmp_path / "mine" / "exercises" / "00_tour.ipynb"
    path.write_text("my work")
    assert cranio("lessons", "copy", tmp_path / "mine").exit_code != 0
    assert path.read_text() == "my work"


@pytest.mark.parametrize("tool", ["nbgrader", "otter"])
def test_assignments_are_written_for_every_lesson(tmp_path, tool):
    made = cranio("lessons", "export", tmp_path / "course", "--for", tool)
    assert made.exit_code == 0
    written = [path for path in map(Path, made.stdout.split()) if path.suffix == ".ipynb"]
    assert [path.stem for path in written] == list(LESSONS) and all(path.is_file() for path in written)


def test_html_prints_each_page(monkeypatch, tmp_path):
    monkeypatch.setattr(web_pages, "write_pages", lambda folder, out: [out / "a.html", out / "b.html"])
    assert cranio("lessons", "html", tmp_path).stdout.split() == [str(tmp_path / "a.html"), str(tmp_path / "b.html")]


def test_site_names_its_start_page_and_hands_on_what_was_asked(monkeypatch, tmp_path):
    asked = []

    def build_site(folder, out, only, repository, tell):
        asked.append((folder, only, repository))
        tell("04: 3 pictures")
        return out / "index.html"

    monkeypatch.setattr(site_build, "build_site", build_site)
    write_project(tmp_path)
    given = ("--folder", tmp_path, "--only", "04", "--repository", "someone/skulls")
    result = cranio("lessons", "site", tmp_path / "pages", *given)
    assert result.stdout.splitlines() == ["04: 3 pictures", str(tmp_path / "pages" / "index.html")]
    assert asked == [(tmp_path, "04", "someone/skulls")]


def test_a_site_is_never_written_into_what_it_is_made_from(tmp_path):
    write_project(tmp_path)
    result = cranio("lessons", "site", tmp_path / "notebooks", "--folder", tmp_path)
    assert result.exit_code == 2 and "OverInput" not in result.stderr and "notebooks" in result.stderr


def test_slides_are_of_one_lesson(monkeypatch, tmp_path):
    monkeypatch.setattr(slides, "write_slides", lambda path, out: out / f"{path.stem}.html")
    folder = write_project(tmp_path) / "notebooks"
    result = cranio("lessons", "slides", "00", tmp_path / "talk", "--folder", folder)
    assert result.stdout == f"{tmp_path / 'talk' / NAME}.html\n"
    (folder / "00_other.ipynb").write_text("{}")
    for number in ("00", "77"):
        result = cranio("lessons", "slides", number, tmp_path / "talk", "--folder", folder)
        assert result.exit_code == 3 and "One lesson was wanted" in result.stderr


def graded(path, student):
    return HandIn(student, path.stem, (Verdict("4.1", 1, 3, "Wrong."), Verdict("4.2", 3, 3, "Right.")), "", ("", ""))


def test_grades_are_summed_and_written(monkeypatch, tmp_path):
    monkeypatch.setattr(marks, "grade", graded)
    path, out = tmp_path / "anna.ipynb", tmp_path / "out"
    path.write_text("")
    result = cranio("lessons", "grade", path, path, "--out", out)
    assert result.exit_code == 0 and result.stdout.startswith(
        f"{path}  4/6  4.1: 1/3  4.2: 3/3\n{out / 'grades.csv'}\n"
    )
    assert sorted(p.name for p in out.iterdir()) == ["class.html", "feedback", "grades.csv", "manifest.json"]
    assert [p.name for p in (out / "feedback").iterdir()] == ["anna.html"]


def test_grades_go_over_nothing_that_no_run_wrote(monkeypatch, tmp_path):
    monkeypatch.setattr(marks, "grade", lambda *a: 1 / 0)
    path = tmp_path / "anna.ipynb"
    path.write_text("")
    (tmp_path / "grades.csv").write_text("mine")
    assert cranio("lessons", "grade", path, "--out", tmp_path).exit_code != 0
    assert cranio("lessons", "grade", tmp_path / "none.ipynb", "--out", tmp_path / "new").exit_code != 0
    assert not (tmp_path / "new").exists()
