"""The lessons come with the package: from a checkout, and from what is built of it."""

import json
import runpy
from pathlib import Path

import pytest

from cranio_nb.errors import CannotWrite, InputRefused
from cranio_nb.teaching import shipped
from cranio_nb.teaching.exercises import LESSONS
from cranio_nb.teaching.lab.start import first_shown, lessons_folder

ROOT = Path(__file__).parents[2]


@pytest.fixture
def built(tmp_path, monkeypatch):
    """Where a wheel would have its lessons, made by the project's own build step."""
    setuptools = pytest.importorskip("setuptools", reason="setuptools, which builds the package, is not installed")
    monkeypatch.setattr(setuptools, "setup", lambda **given: None)
    monkeypatch.chdir(ROOT)
    script = runpy.run_path("setup.py")
    step = script["WithLessons"](setuptools.Distribution({"name": "cranio-nb", "packages": []}))
    step.build_lib, step.editable_mode = str(tmp_path), False
    step.finalize_options()
    step.run()
    return tmp_path / script["HOME"]


def test_a_built_package_holds_the_lessons_and_the_students_copies(built, monkeypatch, tmp_path):
    monkeypatch.setattr(shipped, "_HOMES", (built, tmp_path / "none"))
    assert shipped.shipped_lessons() == built
    wanted = {f"{home}{name}.ipynb" for name in LESSONS for home in ("", "exercises/")}
    assert set(shipped.lesson_names()) == wanted
    assert {path.relative_to(built).as_posix() for path in built.rglob("*.*")} == wanted


def test_copies_are_the_lessons_and_the_lab_opens_the_students_tour(tmp_path):
    made = shipped.copy_lessons(tmp_path / "mine")
    assert [path.relative_to(tmp_path / "mine").as_posix() for path in made] == shipped.lesson_names()
    for path, name in zip(made, shipped.lesson_names(), strict=True):
        assert path.read_bytes() == (ROOT / "notebooks" / name).read_bytes()
    assert first_shown(lessons_folder(tmp_path / "mine")) == "exercises/00_tour.ipynb"
    assert first_shown(lessons_folder(tmp_path / "mine" / "exercises")) == "00_tour.ipynb"


def test_the_first_words_to_students_tell_of_the_solved_lessons():
    for name in LESSONS:
        copy = json.loads((ROOT / "notebooks" / "exercises" / f"{name}.ipynb").read_text())
        assert "solved" in "".join(copy["cells"][1]["source"])


def test_an_installation_without_lessons_says_so(monkeypatch, tmp_path):
    monkeypatch.setattr(shipped, "_HOMES", (tmp_path,))
    with pytest.raises(InputRefused, match="no lessons"):
        shipped.copy_lessons(tmp_path / "mine")


def test_a_folder_that_takes_no_files_is_told(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(CannotWrite):
        shipped.copy_lessons(tmp_path / "file" / "mine")


@pytest.mark.parametrize(
    ("checkout", "words"), [(True, "pip install -e '.[lab]'"), (False, "pip install 'cranio-nb[lab]'")]
)
def test_what_to_install_works_where_it_is_read(monkeypatch, tmp_path, checkout, words):
    monkeypatch.setattr(shipped, "_PACKAGE", ROOT / "cranio_nb" if checkout else tmp_path / "cranio_nb")
    assert shipped.install_command("lab") == words
