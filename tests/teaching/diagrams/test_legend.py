"""The legend: one mark for each meaning, no two alike."""

from cranio_nb.drawing.figures import Figure
from cranio_nb.teaching.diagrams import legend
from cranio_nb.teaching.diagrams.legend import MEANINGS, key_row


def test_no_two_meanings_are_drawn_alike():
    assert len({(kind, colour) for _, kind, colour in MEANINGS}) == len(MEANINGS)


def test_every_meaning_is_told_to_those_who_cannot_see_it():
    drawn = legend()
    assert all(meaning in drawn.alt for meaning, *_ in MEANINGS) and drawn.line == f"{len(MEANINGS)} marks"


def test_a_row_holds_its_meanings_side_by_side():
    figure = Figure(figsize=(8.8, 2.0))
    key_row(figure, 2.0, ("outer side; the prosthesis", "end of the gap"))
    (ax,) = figure.axes
    first, second = sorted(ax.texts, key=lambda text: text.get_position()[0])
    assert (first.get_text(), second.get_text()) == ("outer side", "end of the gap")
    figure.canvas.draw()
    assert first.get_window_extent().x1 < second.get_window_extent().x0
