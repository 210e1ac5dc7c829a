"""The report page: complete by itself, readable without seeing, and safe against what others wrote."""

import dataclasses

import pytest
from html_page import Page, assert_pictures_have_words, assert_self_contained, assert_structured_for_reading_aloud

from cranio_nb.evaluation.paper_tables import PAPER_BALLOONS, balloon_ranges
from cranio_nb.output import design_page
from cranio_nb.output.design_pictures import N_SLICES
from cranio_nb.pipeline.preparation import prepare
from cranio_nb.pipeline.run import RunResult, run_design
from cranio_nb.readers import Finding
from data_synth import phantom_case
from data_synth.files import write_case


@pytest.fixture(scope="module")
def result(tmp_path_factory) -> RunResult:
    folder = tmp_path_factory.mktemp("case")
    write_case(folder, phantom_case("tiny", "unilateral", 0))
    return run_design(prepare(folder / "ct", truth=folder / "truth.nii.gz"), preset="paper")


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


def test_page_is_self_contained(page):
    assert_self_contained(page)


def test_every_picture_is_a_png_with_words(page):
    assert_pictures_have_words(page, 3 + N_SLICES + 3)


def test_page_is_structured_for_reading_aloud(page):
    assert_structured_for_reading_aloud(page)


def test_page_says_what_it_is(page, result):
    assert "not for clinical use" in page.text and "LPS" in page.text
    assert f"{result.truth.score.dice:.3f}" in page.text and f"{result.truth.score.hd95:.2f}" in page.text


def test_tables_are_beside_the_papers(page, result):
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
