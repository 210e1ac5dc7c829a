"""The report page: complete by itself, readable without seeing, and safe against what others wrote."""

import dataclasses
import datetime

import pytest
from html_page import Page, assert_pictures_have_words, assert_self_contained, assert_structured_for_reading_aloud

from cranio_nb.evaluation.paper_tables import PAPER_BALLOONS, balloon_ranges
from cranio_nb.output import design_page, design_pictures
from cranio_nb.output.design_pictures import N_SLICES
from cranio_nb.pipeline.run import RunResult
from cranio_nb.readers import Finding


def page_of(result) -> str:
    case, made = result.case, result.prosthesis
    surface = design_pictures.surface_shots(case, design_pictures.skull_views(case), made)
    shots = design_pictures.patch_shots(case, made) | surface | design_page.measure_shots(result)
    return design_page.report_page(result, shots)


@pytest.fixture(scope="module")
def html(result) -> str:
    return page_of(result)


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
    views, cuts, maps_and_scale, errors = 3, 3, 3, 2
    assert_pictures_have_words(page, views + cuts + N_SLICES + maps_and_scale + errors)


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
    page = Page(page_of(bare))
    views, cuts = 3, 3
    assert (
        len(page.all("img")) == views + cuts
        and "known truth" not in page.text
        and "balloons in numbers" not in page.text
    )


def test_markup_in_findings_is_shown_not_run(bare):
    evil = Finding("Evil", "warning", "<script>alert('x')</script>&\"")
    text = page_of(dataclasses.replace(bare, findings=(evil,)))
    assert "<script" not in text and "&lt;script&gt;" in text
    assert "<script>alert('x')</script>&\"" in Page(text).text


def test_two_reports_can_be_told_apart(page, result, bare):
    digests = result.case.digests
    assert set(digests) == {"scan", "truth"} and all(digest in page.text for digest in digests.values())
    label = f"Case {digests['scan'][:4]}-{digests['scan'][4:8]}, {result.finished:%Y-%m-%d %H:%M} UTC."
    assert label in page.text
    later = dataclasses.replace(bare, finished=result.finished + datetime.timedelta(days=1))
    assert label not in Page(page_of(later)).text


def test_the_largest_errors_stand_where_they_are(page, result):
    for side, distances in result.truth.distances.items():
        assert f"Largest {side} error {distances.max():.2f} mm" in page.text
        assert f"{side.capitalize()} side, seen from" in page.text and f"ring at {distances.max():.2f} mm" in page.text


def test_no_slice_is_distrusted_without_a_reason(page, result):
    n = len(result.prosthesis.record["slices"])
    assert f"Slices with crossed curves 0 of {n}" in page.text and "Do not trust" not in page.text


def test_crossed_curves_are_counted_shown_and_not_trusted(crossed):
    sliced = crossed.prosthesis.working[0]
    n_crossed, n = sum(len(s.crossings) > 0 for s in sliced.slices), len(sliced.slices)
    page = Page(page_of(crossed))
    assert n_crossed == 2 and f"Slices with crossed curves {n_crossed} of {n}" in page.text
    assert f"Do not trust every slice: in {n_crossed} of {n}" in page.text
    assert f"Curves cross in {n_crossed}." in page.text
    assert page.text.count("curves cross: do not trust the shape here") >= 1
    assert page.source.count("curves cross</td>") == n_crossed
