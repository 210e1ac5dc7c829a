"""Typical wrong answers of lesson 05 get the hint that helps."""

from lesson_answers import hint_tests
from wrong_answers.prosthesis_volume import WRONG

from cranio_nb.teaching.exercises.prosthesis_volume import EXERCISES

test_every_exercise_has_wrong_answers, test_a_wrong_answer_is_told_its_cause = hint_tests(WRONG, EXERCISES)
