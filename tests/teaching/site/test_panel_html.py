"""A panel on a page: all that its front needs to know, nothing that breaks the page."""

import json
import re
from html import unescape

import pytest

from cranio_nb.teaching.site.axes import axes_of
from cranio_nb.teaching.site.frames import draw_frames
from cranio_nb.teaching.site.panel_html import SCRIPTS, STYLES, panel_html, write_front


@pytest.fixture(scope="module")
def made(small_shown):
    panel = small_shown[0]
    frames = draw_frames(panel, axes_of(panel, "grey=70", 40))
    return panel, frames, panel_html(panel, frames, "panel-1", "pictures")


@pytest.fixture(scope="module")
def told(made):
    """What the script is told."""
    return json.loads(re.search(r'<script type="application/json">(.*?)</script>', made[2], re.S)[1])


def test_the_picture_its_caption_and_its_description_are_there_without_a_script(made):
    panel, frames, page = made
    src, alt = re.search(r'<img src="([^"]+)" alt="([^"]+)"', page).groups()
    assert src == f"pictures/{frames.names[frames.start]}"
    assert unescape(alt) == f"{panel.alt} {panel.view.line}"
    assert unescape(re.search(r"<figcaption>(.*?)</figcaption>", page)[1]) == panel.view.line


def test_each_setting_has_its_picture_and_its_caption(made, told):
    _, frames, _ = made
    n = len(told["panel"]["controls"][0]["stops"]) * 2 * 2
    assert len(told["pictures"]) == len(told["lines"]) == len(told["off"]) == len(told["tops"]) == n
    assert tuple(told["files"][i] for i in told["pictures"]) == frames.names


def test_the_front_is_told_of_the_controls_as_in_a_notebook(made, told):
    live = pytest.importorskip("cranio_nb.teaching.widgets.live", reason='the extra "lab" is not installed')
    panel, frames, _ = made
    for control, axis in zip(told["panel"]["controls"], frames.axes, strict=True):
        notebook = live.declared(panel.controls[control["name"]], slow=False)
        assert set(control["stops"]) <= set(notebook.pop("stops"))
        assert {name: control[name] for name in notebook} == notebook
        assert control["stops"] == list(axis.stops)
    assert told["panel"]["values"] == panel.values
    assert told["panel"]["presets"]["light"] == {"grey": 100}


def test_no_text_ends_the_script_or_the_html(made):
    text = re.search(r'<script type="application/json">(.*?)</script>', made[2], re.S)[1]
    assert "<" not in text and "<1>" in json.loads(text)["lines"][0]
    assert "\n\n" not in made[2]  # Markdown would go on behind it


def test_the_front_is_no_module_any_more(tmp_path):
    write_front(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {*SCRIPTS, *STYLES}
    for name in SCRIPTS:
        assert not re.search(r"^\s*(export|import)\b", (tmp_path / name).read_text(), re.M), name
