"""Failures by reason, and a picture of their skulls."""

import pytest
from studies import columns, unreadable

pytest.importorskip("pyarrow", reason="the extra `study` is not installed")

from cranio_nb.study.cases import phantom_cases
from cranio_nb.study.failures import failure_shots, reasons, warned

(CASE,) = phantom_cases(["burr_hole"], [0], size="tiny")


def test_are_counted_by_reason_the_most_frequent_first():
    ends = ["done", "refused", "broken", "broken"]
    found = reasons(columns(4, status=ends, code=["", "A", "B", "B"], case=["w", "x", "y", "z"], message=list("1234")))
    assert [(r.code, r.status, r.runs, r.cases, r.message) for r in found] == [
        ("B", "broken", 2, ("y", "z"), "3"),
        ("A", "refused", 1, ("x",), "2"),
    ]
    assert reasons(columns(2)) == []


def test_warnings_are_counted_once_for_a_case_that_of_most_cases_first():
    # the last run of x came to nothing, before it was known what its scan warns of
    said = [*['["B: One of x."]'] * 2, "", '["A: One.", "B: One of y: here."]', ""]
    found = warned(columns(5, warnings=said, case=["x", "x", "x", "y", "z"]))
    assert [(one.code, one.message, one.cases) for one in found] == [
        ("B", "One of x.", ("x", "y")),
        ("A", "One.", ("y",)),
    ]


def test_are_shown_where_the_case_can_be_read():
    rows = columns(2, status="broken", code=["A", "B"], case=[CASE.name, "gone"])
    (shot,) = failure_shots(reasons(rows), [CASE, unreadable()])
    assert CASE.name in shot.alt and shot.caption == f"{CASE.name}: A"
    assert failure_shots(reasons(rows), [CASE], most=0) == []
