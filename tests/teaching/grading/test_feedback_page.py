"""A student's page: hints for what is wrong only, and a remark where the notebook did not run to its end."""

from graded_class import OFF, hand_in

from cranio_nb.teaching.grading.feedback_page import feedback_name, feedback_page


def test_hints_are_given_for_what_is_wrong_only():
    assert feedback_page(hand_in("anna", OFF, "Right")).count("<summary>Hints</summary>") == 1
    assert "Hints" not in feedback_page(hand_in("anna", "Right", "Right"))


def test_a_remark_stands_at_the_top():
    page = feedback_page(hand_in("anna", OFF, remark="It died."))
    assert 0 < page.index("It died.") < page.index(OFF)


def test_a_file_that_has_the_students_name_is_not_named_twice():
    one = hand_in("04_deformable_model", OFF)
    assert feedback_name(one) == "04_deformable_model.html"
