"""A panel on a page: every control named, all that the script needs, nothing that breaks the page."""

import json
import re
from html import unescape

import pytest

from cranio_nb.teaching.site.axes import axes_of
from cranio_nb.teaching.site.frames import draw_frames
from cranio_nb.teaching.site.panel_html import panel_html


@pytest.fixture(scope="module")
def made(small_shown):
    panel = small_shown[0]
    frames = draw_frames(panel, axes_of(panel, "grey=70", 40))
    return panel, frames, panel_html(panel, frames, "panel-1", "pictures")


def test_each_control_has_a_name_and_the_value_it_shows(made):
    _, _, page = made
    ids = re.findall(r'<(?:input|select)[^>]* id="([^"]+)"', page)
    assert len(ids) == 2 and all(f'<label for="{one}">' in page for one in ids)
    assert re.search(r'<label><input type="checkbox"[^>]*> wide bar</label>', page)
    assert re.search(r'type="range"[^>]*aria-valuetext="50 levels"', page) and ">50 levels</output>" in page
    assert '<button type="button" data-play="0" aria-label="Play: grey of it">Play</button>' in page


def test_the_picture_its_caption_and_its_description_are_there_before_any_script_runs(made):
    panel, frames, page = made
    src, alt = re.search(r'<img src="([^"]+)" alt="([^"]+)"', page).groups()
    assert src == f"pictures/{frames.names[frames.start]}"
    assert unescape(alt) == f"{panel.alt} {panel.view.line}"
    caption = re.search(r"<figcaption[^>]*aria-live=\"polite\">(.*?)</figcaption>", page)[1]
    assert unescape(caption) == panel.view.line


def test_the_script_is_told_every_setting(made):
    _, frames, page = made
    text = re.search(r'<script type="application/json">(.*?)</script>', page, re.S)[1]
    data = json.loads(text)
    lengths = [len(axis["texts"]) for axis in data["axes"]]
    assert len(data["pictures"]) == len(data["lines"]) == len(data["off"]) == lengths[0] * 2 * 2
    assert tuple(data["files"][i] for i in data["pictures"]) == frames.names
    assert "70 levels" in data["axes"][0]["texts"]
    assert "<" not in text and "\n\n" not in page  # a text may not end the script, nor an empty line the HTML


def test_a_preset_goes_to_its_values_and_keeps_the_rest(made):
    _, frames, page = made
    places = json.loads(unescape(re.search(r'data-preset="([^"]+)"', page)[1]))
    assert frames.axes[0].stops[places["0"]] == 250 and set(places) == {"0"}
