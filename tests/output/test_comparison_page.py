"""The page of a comparison: complete by itself, each method seen alike, all distances on one scale."""

import pytest
from html_page import Page, assert_pictures_have_words, assert_self_contained, assert_structured_for_reading_aloud
from stand_ins import STAND_INS

from cranio_nb.drawing import figures
from cranio_nb.output import comparison_page


@pytest.fixture(scope="module")
def page(found):
    return Page(comparison_page.comparison_page(found))


def test_is_self_contained(page):
    assert_self_contained(page)


def test_every_picture_is_a_png_with_words_of_its_own(page):
    assert_pictures_have_words(page, 2 * 3 + 2 + 1 + 2 * 2)  # views with the truth, cuts, scale, maps


def test_is_structured_for_reading_aloud(page):
    assert_structured_for_reading_aloud(page)


def test_has_a_row_for_each_and_shows_markup_as_words(page):
    html, text = page.source, page.text
    assert all(text.count(name) >= 2 for name in STAND_INS) and "not for clinical use" in text
    assert "The other side <is> open, too." in text and "<is>" not in html and "secret" not in html


def test_all_maps_and_the_bar_have_the_scale_of_the_comparison(found, monkeypatch):
    tops = []
    scale = figures.colour_scale
    for module in (figures.axes, figures.views):
        monkeypatch.setattr(module, "colour_scale", lambda top: tops.append(top) or scale(top))
    comparison_page.comparison_page(found)
    assert len(tops) == 5 and set(tops) == {found.top}


def test_all_pictures_of_a_view_are_seen_from_one_side(found, monkeypatch):
    seen = []
    draw = figures.view_figure
    monkeypatch.setattr(figures, "view_figure", lambda view, mesh: seen.append(view) or draw(view, mesh))
    comparison_page.comparison_page(found)
    assert len(seen) == 6 and len(set(seen[:3])) == 1 and len(set(seen[3:])) == 1 and seen[0].px_mm == seen[3].px_mm


def test_without_a_truth(blind):
    page = Page(comparison_page.comparison_page(blind))
    assert len(page.all("img")) == 2 * 2 + 2 + 1 + 2
    # what the slices hide, openings, the rule by which they were judged, what was measured, how far the patches agree
    assert len(page.all("table")) == 5 and "the surface of moved" in " ".join(page.words)
