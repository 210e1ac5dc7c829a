"""The page of a lesson: pictures as files, panels alive, answers folded, Colab's cell gone."""

import base64

import nbformat
import pytest
from lesson_cells import FOLDER, code, tagged

from cranio_nb.teaching.site import lesson_page as module
from cranio_nb.teaching.site.axes import Axis
from cranio_nb.teaching.site.lesson_page import lesson_page
from cranio_nb.teaching.widgets.controls import Slider


def html_of(page):
    shown = [o.data for cell in code(page.notebook) for o in cell.outputs if "data" in o]
    return [data["text/html"] for data in shown if "text/html" in data]


def test_a_stored_picture_is_the_file_that_the_page_names(small, small_page):
    stored = next(cell for cell in code(small) if "black" in cell.source).outputs[0].data["image/png"]
    *_, figure = html_of(small_page)
    name = figure.split('src="../pictures/00_small/')[1].split('"')[0]
    assert small_page.files[name] == base64.b64decode(stored)
    assert 'alt="A black &lt;box&gt;." width="6" height="4"' in figure and "black, 6 x 4 px" in figure


def test_a_panel_and_a_scene_have_controls_and_all_their_pictures(small_page):
    panel, scene, _ = html_of(small_page)
    for page in (panel, scene):
        assert page.startswith('<div class="cranio-ahead"')
        names = set(part.split('"')[0] for part in page.split('"') if part.endswith(".webp"))
        assert names and {name.rpartition("/")[2] for name in names} <= set(small_page.files)
    assert '"turn"' in scene


def test_nothing_of_the_lesson_itself_is_changed(small, small_page):
    assert [cell.source for cell in small_page.notebook.cells] == [cell.source for cell in small.cells]
    assert any("image/png" in o.get("data", {}) for cell in code(small) for o in cell.outputs)


def test_answers_are_folded_and_the_cell_for_colab_is_left_out(small_page):
    assert [c.source[:3] for c in tagged(small_page.notebook, "hide-input")] == ["def"]
    (gone,) = tagged(small_page.notebook, "remove-cell")
    assert gone.source.startswith(module.COLAB)


def test_the_colab_cell_of_the_shipped_lessons_is_known():
    for path in sorted(FOLDER.glob("*.ipynb")):
        cells = nbformat.read(path, as_version=4).cells
        assert sum(cell.source.startswith(module.COLAB) for cell in cells) == 1, path.name


@pytest.mark.parametrize("name", ["04_deformable_model"])
def test_a_shipped_lesson_is_small_before_its_panels_are_touched(name, monkeypatch):
    still = Axis(Slider("step", "step", 0, 0, 0), (0,), 0)
    monkeypatch.setattr(module, "axes_of", lambda *given: (still,))
    page = lesson_page(nbformat.read(FOLDER / f"{name}.ipynb", as_version=4), "pictures")
    assert sum("cranio-ahead" in text for text in html_of(page)) == 1
    stored = sum(len(data) for file, data in page.files.items() if file.endswith(".png"))
    assert stored + len(nbformat.writes(page.notebook)) < 2_000_000
