"""The table and the pages: every exercise once, the most frequent mistake first, nothing that is taken for code."""

import csv

from cranio_nb.teaching.exercises import EXERCISES
from cranio_nb.teaching.grading import pages
from cranio_nb.teaching.grading.marks import HandIn
from cranio_nb.teaching.verdict import Verdict

OFF, SIGN = "N counts the steps between snaxels: N = n - 1.", "The sign is turned."


def hand_in(student, *messages, remark=""):
    verdicts = tuple(
        Verdict(f"4.{at}", 3 if words == "Right" else at, 3, words, "Case 1: yours 2, mine 3 px.")
        for at, words in enumerate(messages, start=1)
    )
    return HandIn(student, "04_deformable_model", verdicts, remark, tuple("<b>k</b>" for _ in messages))


CLASS = [
    hand_in("anna", OFF, "Right"),
    hand_in("=bo()", OFF, SIGN, remark="It died."),
    hand_in("<i>cy", "Right", SIGN),
]


def test_the_table_has_a_line_for_each_exercise_and_no_formulas():
    rows = list(csv.DictReader(pages.grades_csv(CLASS).splitlines()))
    assert [row["student"] for row in rows] == ["anna", "anna", "'=bo()", "'=bo()", "<i>cy", "<i>cy"]
    assert [(row["exercise"], row["points"], row["mistake"]) for row in rows[:2]] == [
        ("4.1", "1", OFF),
        ("4.2", "3", ""),
    ]
    assert [row["remark"] for row in rows] == ["", "", "It died.", "It died.", "", ""]


def test_mistakes_are_counted_by_cause_the_most_frequent_first():
    found = pages.mistakes([*CLASS, hand_in("di", OFF)])
    assert [(m["name"], m["cause"], m["students"], m["out_of"]) for m in found] == [
        ("4.1", OFF, ["anna", "=bo()", "di"], 4),
        ("4.2", SIGN, ["=bo()", "<i>cy"], 3),
    ]


def test_the_pages_are_written_together_and_hold_the_students_own_words_as_text(tmp_path):
    pages.write_grades(CLASS, tmp_path / "out")
    names = sorted(path.name for path in (tmp_path / "out" / "feedback").iterdir())
    assert len(names) == 3 and "anna_04_deformable_model.html" in names
    everything = [path.read_text() for path in (tmp_path / "out").rglob("*.html")]
    assert len(everything) == 4
    for text in everything:
        assert "<i>cy" not in text and "<b>k" not in text and "one scan" not in text
    page = (tmp_path / "out" / "feedback" / "anna_04_deformable_model.html").read_text()
    for words in (OFF, "yours 2, mine 3 px", EXERCISES["4.1"].hints[2], "&lt;b&gt;k&lt;/b&gt;", "4 of 6 points"):
        assert words.replace("'", "&#39;") in page, words
    assert EXERCISES["4.2"].hints[0].replace("'", "&#39;") not in page


def test_a_class_without_mistakes_says_so():
    assert "None." in pages.class_page([hand_in("anna", "Right")])
