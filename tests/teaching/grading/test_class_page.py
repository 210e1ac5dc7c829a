"""The page on the class: mistakes by cause, the most frequent first."""

from graded_class import CLASS, OFF, SIGN, hand_in

from cranio_nb.teaching.grading.class_page import class_page, mistakes


def test_mistakes_are_counted_by_cause_the_most_frequent_first():
    found = mistakes([*CLASS, hand_in("di", OFF)])
    assert [(m["name"], m["cause"], m["students"], m["out_of"]) for m in found] == [
        ("4.1", OFF, ["anna", "=bo()", "di"], 4),
        ("4.2", SIGN, ["=bo()", "<i>cy"], 3),
    ]


def test_a_class_without_mistakes_says_so():
    assert "None." in class_page([hand_in("anna", "Right")])
