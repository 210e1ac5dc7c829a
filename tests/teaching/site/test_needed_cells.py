"""Panels and scenes of a lesson: found all, made by running what they need and nothing else."""

import ast
import os

import nbformat
import pytest
from lesson_cells import FOLDER, NAMES, code
from small_site import lesson

from cranio_nb.drawing.scene3d import Scene
from cranio_nb.errors import InputRefused
from cranio_nb.teaching.site.needed_cells import needed, shown_by
from cranio_nb.teaching.widgets import Panel


def trees(*texts):
    return [ast.parse(text) for text in texts]


def test_panels_and_scenes_are_found_though_a_cell_between_cannot_run(small, small_shown):
    panel, scene = small_shown
    assert isinstance(panel, Panel) and isinstance(scene, Scene)
    assert panel.view.line == "grey 50, a narrow bar at the left of it <1>"
    assert any(cell.source == "1 / 0" for cell in small.cells)


def test_what_changes_an_object_is_needed_by_what_reads_it():
    cells = trees("a = []", "b = []", "a[0] = 1", "b.x = 2", "def f():\n    return a", "f()")
    assert needed(cells, [5]) == {0, 2, 4, 5}


def test_a_name_given_anew_hides_what_came_before():
    assert needed(trees("a = slow()", "a = 1", "a"), [2]) == {1, 2}
    assert needed(trees("import numpy as np", "a = 1", "a = a + np.e", "a"), [3]) == {0, 1, 2, 3}


def test_a_notebook_that_says_something_else_is_refused():
    stale = lesson()
    next(cell for cell in code(stale) if cell.outputs).outputs[0].data["text/plain"] = "grey 60"
    with pytest.raises(InputRefused, match="'grey 60' where its panel says 'grey 50"):
        shown_by(stale.cells)


def test_the_mode_is_as_it_was(small, monkeypatch):
    monkeypatch.setenv("CRANIO_NB_MODE", "auto")
    shown_by(small.cells[:6])
    assert os.environ["CRANIO_NB_MODE"] == "auto"
    monkeypatch.delenv("CRANIO_NB_MODE")
    shown_by(small.cells[:6])
    assert "CRANIO_NB_MODE" not in os.environ


@pytest.mark.parametrize("name", [name for name in NAMES if name[:2] == "05"])
def test_each_panel_of_a_lesson_is_found(name):
    cells = nbformat.read(FOLDER / f"{name}.ipynb", as_version=4).cells
    shown = shown_by(cells)
    made = [cell.id for cell in code(nbformat.v4.new_notebook(cells=cells)) if "widgets." in cell.source]
    assert set(shown) and set(shown) <= set(made)
    # each cell whose picture has the description of a panel is one
    alts = {panel.alt for panel in shown.values()}
    pictures = [(c.id, o.metadata["image/png"]["alt"]) for c in cells for o in c.get("outputs", []) if has_png(o)]
    assert {place for place, alt in pictures if alt in alts} == set(shown)


def has_png(output):
    return "image/png" in output.get("data", {})
