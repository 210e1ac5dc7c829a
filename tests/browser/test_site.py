"""The site of a small project, opened from disk with the network off: links, panels by keyboard, mouse and touch."""

import re
from pathlib import Path
from urllib.parse import unquote, urljoin, urlparse

import numpy as np
import pytest
from html_page import Page
from PIL import Image
from small_site import NAME, few_views, write_project

from cranio_nb.teaching.site import build, pages, slides

pytestmark = pytest.mark.filterwarnings("default")  # Sphinx and its extensions have warnings of their own


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """Its folder."""
    if any(build.find_spec(name) is None for name in build.NEEDS):
        pytest.skip('the extras "lab" and "site" are not installed')
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(pages, "API", {})
        few_views(patched)
        project = write_project(tmp_path_factory.mktemp("project"))
        return build.build_site(project, tmp_path_factory.mktemp("home") / "site").parent


@pytest.fixture
def address(site):
    return site.as_uri()


@pytest.fixture
def page(chromium, address):
    """The lesson's page; its console must stay silent."""
    context = chromium.new_context(offline=True, viewport={"width": 1366, "height": 768}, has_touch=True)
    opened = context.new_page()
    said = []
    opened.on("console", lambda message: said.append(message.text))
    opened.on("pageerror", lambda error: said.append(str(error)))
    opened.on("requestfailed", lambda request: said.append(request.url))
    opened.goto(f"{address}/lessons/{NAME}.html")
    yield opened
    context.close()
    assert said == []


def test_every_link_leads_to_a_file_of_the_site(site):
    found = sorted(site.rglob("*.html"))
    assert {"index.html", "lessons/00_small.html", "docs/how.html", "api/face.html"} <= {
        path.relative_to(site).as_posix() for path in found
    }
    for path in found:
        page = Page(path.read_text())
        links = [(tag, about[key]) for tag, about in page.tags for key in ("src", "href") if about.get(key)]
        for tag, link in links:
            if re.match(r"https?:|//", link):
                assert tag == "a", (path.name, link)  # nothing is loaded from there
            elif not link.startswith(("#", "data:", "javascript:")):
                assert (path.parent / link.split("#")[0].split("?")[0]).exists(), (path.name, link)


def test_each_page_has_one_title_and_parts_of_different_names(site):
    for path in site.rglob("*.html"):
        page = Page(path.read_text())
        assert len(page.all("h1")) == 1, path.name
        names = [tag.get("aria-label") for tag in page.all("aside")]
        assert all(names) and len(set(names)) == len(names), path.name


def test_no_style_and_no_script_fetches_from_elsewhere(site):
    for path in [*site.rglob("*.css"), *site.rglob("*.js")]:
        if path.name not in ("searchtools.js",):  # asks for summaries, which are turned off
            text = re.sub(r"/\*.*?\*/", "", path.read_text(), flags=re.S)
            assert not re.search(r"url\(['\"]?https?:|@import ['\"]?https?:|fetch\(['\"]http", text), path.name
    assert "SHOW_SEARCH_SUMMARY: false" in (site / "_static" / "documentation_options.js").read_text()


def test_the_lesson_has_its_panel_its_scene_its_formula_and_its_answer(site):
    page = Page((site / "lessons" / f"{NAME}.html").read_text())
    assert sum(tag.get("class") == "cranio-ahead" for tag in page.all("div")) == 2
    assert len(page.all("math")) == 1 and all(tag.get("alt") for tag in page.all("img"))
    assert {"Answer", "Show the answer"} <= {" ".join(words.split()) for words in page.words}
    assert "ZeroDivisionError" not in page.text and "On Colab" not in page.text


def test_words_of_lessons_docs_and_docstrings_are_found(site):
    index = (site / "searchindex.js").read_text()
    assert index.startswith("Search.setIndex(")  # a script, which a page opened from disk may load
    for word in ("whetston", "apex", "threshold"):
        assert f'"{word}"' in index or f",{word}:" in index or f"{{{word}:" in index, word


def panels(page):
    return page.locator(".cranio-ahead")


def shown(panel):
    """Caption, description and address of a panel's picture, once it is there."""
    picture = panel.locator("img")
    picture.evaluate("image => image.decode()")
    return panel.locator("figcaption").inner_text(), picture.get_attribute("alt"), picture.get_attribute("src")


def dragged(page, picture, start, end):
    """Drag a picture sideways, px from its left side; it is waited for until it no longer scrolls."""
    picture.hover(position={"x": start, "y": 50})
    box = picture.bounding_box()
    page.mouse.down()
    page.mouse.move(box["x"] + end, box["y"] + 50, steps=5)
    page.mouse.up()


def grey_of(page, address):
    """Level of grey at the right end of a picture of the page."""
    file = Path(unquote(urlparse(urljoin(page.url, address)).path))
    return int(np.asarray(Image.open(file).convert("RGB"))[30, 80, 0])


def test_a_slider_moves_picture_caption_and_description_by_keyboard(page):
    panel = panels(page).first
    slider = panel.get_by_role("slider", name="grey of it (levels)", exact=True)
    assert slider.get_attribute("aria-valuetext") == "50 levels"
    slider.focus()
    for key, level in (("ArrowRight", 60), ("End", 100), ("Home", 0)):
        page.keyboard.press(key)
        caption, alt, address = shown(panel)
        assert caption == f"grey {level}, a narrow bar at the left of it <1>"
        assert alt == f"A blue bar on grey <box>. {caption}" and grey_of(page, address) == level
        assert slider.get_attribute("aria-valuetext") == f"{level} levels"


def test_the_picture_is_dragged_by_mouse(page):
    panel = panels(page).first
    picture = panel.locator("img")
    dragged(page, picture, 5, picture.bounding_box()["width"] - 5)
    caption, _, address = shown(panel)
    assert caption.startswith("grey 100,") and grey_of(page, address) == 100


def test_words_switches_typed_numbers_and_presets_move_it_too(page):
    panel = panels(page).first
    panel.get_by_role("combobox", name="side").select_option("right")
    panel.get_by_role("checkbox", name="wide bar").check()
    panel.get_by_role("textbox", name="grey of it (levels), typed").fill("68")
    page.keyboard.press("Enter")
    assert shown(panel)[0] == "grey 70, a wide bar at the right of it <1>"
    panel.get_by_role("button", name="light").tap()
    assert shown(panel)[0] == "grey 100, a wide bar at the right of it <1>"
    panel.get_by_role("button", name="as at the start").tap()
    assert shown(panel)[0] == "grey 50, a narrow bar at the left of it <1>"


def test_a_film_plays_to_its_end(page):
    panel = panels(page).first
    panel.get_by_role("combobox", name="pace").select_option("20 steps a second")
    panel.get_by_role("button", name="play").click()
    panel.get_by_text("grey 100,").wait_for(timeout=20_000)
    panel.get_by_role("button", name="play").wait_for()


def test_a_scene_turns_without_an_end(page):
    scene = panels(page).nth(1)
    turn = scene.get_by_role("slider").first
    start = shown(scene)
    turn.focus()
    page.keyboard.press("ArrowLeft")
    assert shown(scene)[2] != start[2] and "A tetrahedron." in shown(scene)[1]
    page.keyboard.press("Home")  # -180 degrees; dragged further, it goes on from the other end
    dragged(page, scene.locator("img"), 100, 115)
    assert "from 165 degrees" in shown(scene)[0]


def test_the_search_finds_a_word_of_the_docs(page, address):
    page.goto(f"{address}/search.html?q=whetstone")
    page.get_by_role("link", name="How to sharpen").last.wait_for()
    assert page.locator("ul.search li").count() == 1


def test_without_scripts_the_picture_and_its_caption_are_there(chromium, address):
    context = chromium.new_context(offline=True, java_script_enabled=False)
    plain = context.new_page()
    plain.goto(f"{address}/lessons/{NAME}.html")
    first = plain.locator(".cranio-ahead").first
    assert first.locator("figcaption").inner_text() == "grey 50, a narrow bar at the left of it <1>"
    assert first.locator("img").count() == 1
    context.close()


def test_slides_turn_by_keys_and_their_panel_moves(chromium, tmp_path, monkeypatch):
    if build.find_spec("sphinx_revealjs") is None:
        pytest.skip('the extra "site" is not installed')
    few_views(monkeypatch)
    notebook = write_project(tmp_path) / "notebooks" / f"{NAME}.ipynb"
    context = chromium.new_context(offline=True, viewport={"width": 1366, "height": 768})
    talk = context.new_page()
    said = []
    talk.on("console", lambda message: said.append(message.text))
    talk.on("pageerror", lambda error: said.append(str(error)))
    talk.goto(slides.write_slides(notebook, tmp_path / "talk").as_uri())
    slider = talk.get_by_role("slider", name="grey of it (levels)", exact=True)
    talk.keyboard.press("ArrowRight")
    talk.keyboard.press("ArrowDown")  # from a section's text to its panel
    slider.focus()
    talk.keyboard.press("End")  # moves the slider, and turns no slide
    assert shown(panels(talk).first)[0] == "grey 100, a narrow bar at the left of it <1>"
    assert slider.is_visible()
    context.close()
    assert said == []
