"""The legend: one mark for each meaning, no two alike."""

from cranio_nb.teaching.diagrams import legend
from cranio_nb.teaching.diagrams.legend import MEANINGS


def test_no_two_meanings_are_drawn_alike():
    assert len({(kind, colour) for _, kind, colour in MEANINGS}) == len(MEANINGS)


def test_every_meaning_is_told_to_those_who_cannot_see_it():
    drawn = legend()
    assert all(meaning in drawn.alt for meaning, *_ in MEANINGS) and drawn.line == f"{len(MEANINGS)} marks"
