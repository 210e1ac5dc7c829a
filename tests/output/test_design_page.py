"""The report page: complete by itself, readable without seeing, and safe against what others wrote."""

import base64
import dataclasses
import re
from html.parser import HTMLParser

import pytest

from cranio_nb.evaluation.paper_tables import PAPER_BALLOONS, balloon_ranges
from cranio_nb.output import design_page
from cranio_nb.pipeline.run import RunResult, run_design
from cranio_nb.readers import Finding
from data_synth import phantom_case
from data_synth.files import write_case


class Page(HTMLParser):
    """Tags with their attributes, and the text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.words: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attrs for name, attrs in self.tags if name == tag]


@pytest.fixture(scope="module")
def result(tmp_path_factory) -> RunResult:
    folder = tmp_path_factory.mktemp("case")
    write_case(folder, phantom_case("tiny", "unilateral", 0))
    return run_design(folder / "ct", truth=folder / "truth.nii.gz", preset="paper")


@pytest.fixture(scope="module")
def html(result) -> str:
    return design_page.report_page(result)


@pytest.fixture(scope="module")
def page(html) -> Page:
    return Page(html)


@pytest.fixture(scope="module")
def bare(result) -> RunResult:
    """A run with neither slices nor a truth, as of a method without slices."""
    made = dataclasses.replace(result.prosthesis, working=(), record={})
    return dataclasses.replace(result, truth=None, prosthesis=made)


def test_page_is_self_contained(html, page):
    text = re.sub(r"base64,[A-Za-z0-9+/=]+", "", html)
    assert not re.search(r"https?:|//|url\(|@import|<script|<link|<iframe|<object|\shref=|\son\w+=", text)
    assert all(attrs["src"].startswith("data:image/png;base64,") for attrs in page.all("img"))
    assert not page.all("a") and not page.all("script")


def test_every_picture_is_a_png_with_words(page):
    pictures = page.all("img")
    assert len(pictures) == 3 + design_page.N_SLICES + 3
    for attrs in pictures:
        assert base64.b64decode(attrs["src"].split(",")[1]).startswith(b"\x89PNG")
        assert len(attrs["alt"]) > 60
    assert len({attrs["alt"] for attrs in pictures}) == len(pictures)
    assert all("mm" in attrs["alt"] for attrs in pictures)


def test_page_is_structured_for_reading_aloud(page):
    assert page.all("html")[0]["lang"] == "en" and len(page.all("h1")) == 1
    ids = {attrs["id"] for _, attrs in page.tags if "id" in attrs}
    assert {attrs["aria-labelledby"] for attrs in page.all("section")} <= ids
    assert all("scope" in attrs for attrs in page.all("th"))


def test_page_says_what_it_is(page, result):
    assert "not for clinical use" in page.text and "LPS" in page.text
    assert f"{result.truth.score.dice:.3f}" in page.text and f"{result.truth.score.hd95:.2f}" in page.text


def test_tables_stand_beside_the_papers(page, result):
    found = balloon_ranges(result.prosthesis.record["slices"])
    for side, n in (("outer", 1), ("inner", 2)):
        low, high = found[side]["theta0"]
        paper_low, paper_high = PAPER_BALLOONS[side]["theta0"]
        row = f"Table {n}: {side} balloon Parameter Min Max Paper min Paper max θ₀ (degrees) "
        assert row + f"{low:.0f} {high:.0f} {paper_low:.0f} {paper_high:.0f}" in page.text
    assert "Paper: You et al. (voxels)" in page.text and "3.09" in page.text


def test_own_defaults_are_not_set_beside_the_paper(result):
    own = dataclasses.replace(result, preset="default")
    assert not any(table["paper"] or len(row) > 3 for table in design_page.balloon_tables(own) for row in table["rows"])
    assert list(design_page.distance_table(own)) == ["Outer (voxels)", "Inner (voxels)", "Outer (mm)", "Inner (mm)"]


def test_page_without_truth_or_slices(bare):
    page = Page(design_page.report_page(bare))
    assert len(page.all("img")) == 3 and "known truth" not in page.text and "balloons in numbers" not in page.text


def test_markup_in_findings_is_shown_not_run(bare):
    evil = Finding("Evil", "warning", "<script>alert('x')</script>&\"")
    text = design_page.report_page(dataclasses.replace(bare, findings=(evil,)))
    assert "<script" not in text and "&lt;script&gt;" in text
    assert "<script>alert('x')</script>&\"" in Page(text).text


@pytest.mark.parametrize(("value", "text"), [(None, "-"), (3, "3"), (2.5, "2.50"), (True, "True"), ("x", "x")])
def test_numbers_read_well(value, text):
    assert design_page.number(value) == text
