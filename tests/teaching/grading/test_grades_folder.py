"""The table and the pages are written together; nothing in them is taken for code."""

import csv

from graded_class import CLASS, OFF

from cranio_nb.teaching.exercises import EXERCISES
from cranio_nb.teaching.grading.grades_folder import grades_csv, write_grades


def test_the_table_has_a_line_for_each_exercise_and_no_formulas():
    rows = list(csv.DictReader(grades_csv(CLASS).splitlines()))
    assert [row["student"] for row in rows] == ["anna", "anna", "'=bo()", "'=bo()", "<i>cy", "<i>cy"]
    assert [(row["exercise"], row["points"], row["mistake"]) for row in rows[:2]] == [
        ("4.1", "1", OFF),
        ("4.2", "3", ""),
    ]
    assert [row["remark"] for row in rows] == ["", "", "It died.", "It died.", "", ""]


def test_the_pages_are_written_together_and_hold_the_students_own_words_as_text(tmp_path):
    write_grades(CLASS, tmp_path / "out")
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
