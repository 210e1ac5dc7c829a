"""Slides: each text in its place, panels alive, answers left out, nothing fetched from elsewhere."""

import re

import nbformat
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lesson_cells import FOLDER
from small_site import ANSWER, FIGURE, NAME, few_views, write_project

from cranio_nb.errors import InputRefused
from cranio_nb.teaching.site import slides


@given(
    st.lists(
        st.sampled_from(["## Two", " ".join(60 * ["word"]), "- a\n- b", "<details>\n\nin\n\n</details>"]), min_size=1
    )
)
def test_splitting_loses_no_text(blocks):
    parts = slides.split_text("\n\n".join(blocks))
    assert "\n\n".join(parts) == "\n\n".join(block.strip() for block in blocks)
    assert all(part.count("<details>") == part.count("</details>") for part in parts)
    assert all("## " not in part[1:] or part.startswith("## ") for part in parts)


def test_no_text_of_a_lesson_is_much_longer_than_a_slide():
    for path in sorted(FOLDER.glob("*.ipynb")):
        for cell in nbformat.read(path, as_version=4).cells:
            if cell.cell_type == "markdown":
                for part in slides.split_text(cell.source):
                    assert len(re.sub(r"<details>.*", "", part, flags=re.S)) < 1600, (path.name, part[:80])


def test_formulas_are_drawn_by_the_browser():
    pytest.importorskip("docutils", reason='the extra "site" is not installed')
    text = slides.with_mathml("so $k$ and $$\\frac{a}{b}$$ cost 3 \\$ each")
    assert text.count("<math") == 2 and text.count('display="block"') == 1 and "3 \\$ each" in text


def test_a_lesson_becomes_slides_that_need_nothing_else(tmp_path, monkeypatch):
    pytest.importorskip("sphinx_revealjs", reason='the extra "site" is not installed')
    few_views(monkeypatch)
    folder = write_project(tmp_path) / "notebooks"
    page = slides.write_slides(folder / f"{NAME}.ipynb", tmp_path / "talk")
    text = page.read_text()
    for address in re.findall(r'(?:src|href)="([^"#][^"]*)"', text):
        assert (page.parent / address).is_file(), address
    assert text.count('class="cranio-ahead"') == 2 and text.count("<section") >= 4
    # a picture has the slide for itself, and answers are for the class to find
    assert "A black &lt;box&gt;." in text and "zeros" in FIGURE and "zeros" not in text
    assert "twice" in ANSWER and "twice" not in text and "<math" in text


def test_a_notebook_that_is_not_there_is_refused(tmp_path):
    pytest.importorskip("sphinx_revealjs", reason='the extra "site" is not installed')
    with pytest.raises(InputRefused, match="no notebook 04_x"):
        slides.write_slides(tmp_path / "04_x.ipynb", tmp_path / "talk")
