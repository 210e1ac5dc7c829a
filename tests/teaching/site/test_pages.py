"""The pages around the lessons hold the project's own texts, and name every module they promise."""

from importlib import import_module

import pytest
from small_site import write_project

import cranio_nb as cn
from cranio_nb.errors import InputRefused
from cranio_nb.teaching.site.pages import API, TEXTS, lesson_head, write_pages


@pytest.fixture
def written(tmp_path):
    (tmp_path / "project").mkdir()
    (tmp_path / "pages").mkdir()
    write_pages(write_project(tmp_path / "project"), tmp_path / "pages", ["00_small"])
    return tmp_path / "pages"


def test_the_start_page_is_the_readme_and_leads_to_all_others(written):
    text = (written / "index.md").read_text()
    assert text.startswith("# README.md")
    for name in ("lessons/00_small", "docs/how", "api/index", "CONTRIBUTING", "CHANGELOG"):
        assert f"\n{name}\n" in text


def test_each_name_of_the_face_and_each_module_has_its_place(written):
    face = (written / "api" / "face.rst").read_text()
    assert all(f":: {name}\n" in face for name in cn.__all__ if name != "__version__")
    for name in (module for modules in API.values() for module in modules):
        assert f"automodule:: cranio_nb.{name}\n" in (written / "api" / f"{name}.rst").read_text()
        assert import_module(f"cranio_nb.{name}").__doc__


def test_what_a_module_imports_is_not_its_own(written):
    text = (written / "api" / "evaluation.scores.rst").read_text()
    left_out = text.split(":exclude-members: ")[1]
    assert "cKDTree" in left_out and "dice" not in left_out.split(", ")


def test_a_lesson_opens_elsewhere_only_where_the_repository_is_known():
    assert "Binder" not in lesson_head("04_x", "")
    text = lesson_head("04_x", "someone/skulls")
    assert "mybinder.org/v2/gh/someone/skulls/HEAD?urlpath=lab%2Ftree%2Fnotebooks%2Fexercises%2F04_x.ipynb" in text
    assert "colab.research.google.com/github/someone/skulls/blob/main/notebooks/exercises/04_x.ipynb" in text


def test_a_folder_without_the_project_is_refused(tmp_path):
    with pytest.raises(InputRefused, match=TEXTS[0]):
        write_pages(tmp_path, tmp_path, [])
