"""The page says what the rows say, and shows it."""

import pytest
from studies import columns, two_options

pytest.importorskip("pyarrow", reason="the extra `study` is not installed")

from cranio_nb.study.best import target_of
from cranio_nb.study.failures import reasons
from cranio_nb.study.page import study_page
from cranio_nb.study.parts import by_contender, contender_part


def page_of(rows, missing=None):
    parts = [contender_part(own, target_of(rows)) for own in by_contender(rows)]
    return study_page(rows, parts, reasons(rows), missing=missing)


def test_says_it_all_and_needs_no_other_file():
    page = page_of(two_options(), missing=4)
    assert page.count("<img") == 2 and "http" not in page
    assert "19 runs on 4 cases" in page and "18 done, 1 failed" in page and "<dd>4</dd>" in page
    assert "Oops" in page and "It went wrong." in page and "best-slicewise.json" in page
    assert "&lt;case3&gt;" in page and "<case3>" not in page


def test_what_the_scans_warn_of_is_said_before_what_failed():
    rows = columns(2, dice=[0.5, 0.6], case=["a", "b"], warnings=["[]", '["ThickSlices: The slices are 5 mm apart."]'])
    page = page_of(rows)
    assert page.index("The slices are 5 mm apart.") < page.index("What failed")
    assert "What to check" not in page_of(columns(2, dice=[0.5, 0.6], case=["a", "b"]))


def test_a_study_without_parameters_or_values_has_a_page():
    assert "no run has a value" in page_of(columns(1, status="broken", code="Oops"))
    assert "Nothing failed" in page_of(columns(2, dice=[0.5, 0.6], case=["a", "b"]))
