"""The commands `lessons ...` print what was done, and fail where lessons are out of step."""

from pathlib import Path

from cli_runs import cranio
from small_site import NAME, write_project

from cranio_nb.teaching import build, web_pages
from cranio_nb.teaching.site import build as site_build
from cranio_nb.teaching.site import slides


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
