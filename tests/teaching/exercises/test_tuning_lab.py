"""Typical wrong answers of lesson 11 get the hint that helps."""

from lesson_answers import hint_tests
from wrong_answers.tuning_lab import WRONG

from cranio_nb.teaching.exercises.tuning_lab import EXERCISES

test_every_exercise_has_wrong_answers, test_a_wrong_answer_is_told_its_cause = hint_tests(WRONG, EXERCISES)
