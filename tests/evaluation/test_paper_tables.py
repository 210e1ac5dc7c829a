"""Rows of numbers: which slices are shown, places in words, sizes of openings."""

import pytest

from cranio_nb.evaluation.paper_tables import measure_opening, place, telling_slices


def test_slices_shown_are_spread_and_hold_each_kind():
    statuses = ["hull", "hull", *["balloon"] * 20, "carried", *["balloon"] * 5, "skipped"]
    chosen = telling_slices(statuses, 6)
    assert chosen == sorted(set(chosen)) and len(chosen) == 6
    assert {statuses[i] for i in chosen} == {"hull", "balloon", "carried", "skipped"}
    assert telling_slices(["balloon"] * 3, 6) == [0, 1, 2]
    assert telling_slices([], 6) == []
    assert telling_slices(["balloon"] * 60, 6) == [5, 15, 25, 35, 45, 55]


def test_words_for_places_are_the_patients():
    assert place([1, 0, 0]) == "left" and place([-0.7, -0.7, 0]) == "right, front"
    assert place([0, 0.6, 0.8]) == "back, top"


def test_opening_is_measured(openings):
    (opening,) = openings()
    one = measure_opening(opening)
    assert one.place.startswith("left") and opening.planes == (one.planes[0], one.planes[1] + 1)
    assert one.centre == pytest.approx(tuple(opening.centre))
    assert one.direction == pytest.approx(tuple(opening.direction))
