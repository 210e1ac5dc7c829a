"""Comparing answers: 0 for the right one, inf for what cannot be compared."""

import dataclasses

import numpy as np
import pytest

from cranio_nb.teaching.exercises import EXERCISES
from cranio_nb.teaching.exercises.task import Exercise, degrees_apart, different_bools, small_head


@pytest.mark.parametrize("name", EXERCISES)
def test_the_right_answer_to_every_case_has_no_error(name):
    task = EXERCISES[name]
    assert len(task.cases()) == 3 and len(task.hints) == 3
    assert all(task.answer.error(task.right(*case), task.right(*case)) <= 1e-9 for case in task.cases())


def test_an_exercise_is_made_by_keyword_and_stays_as_it_is():
    task = EXERCISES["4.1"]
    with pytest.raises(TypeError):
        Exercise(*(getattr(task, field.name) for field in dataclasses.fields(task)))
    with pytest.raises(dataclasses.FrozenInstanceError):
        task.praise = "well done"


@pytest.mark.parametrize("turn", [0.0, 12.5, 60.0, 90.0])
def test_degrees_between_directions_do_not_depend_on_sign_and_length(turn):
    a, b = np.radians([33.0, 33.0 + turn])
    first, second = 3 * np.array([np.cos(a), np.sin(a)]), -0.2 * np.array([np.cos(b), np.sin(b)])
    assert degrees_apart(first, second) == pytest.approx(turn, abs=1e-6)
    assert degrees_apart([0, 0], first) == degrees_apart([1, 2, 3], first) == np.inf


def test_pixels_that_differ_are_counted_in_masks_only():
    mask = np.random.default_rng(0).random((20, 30)) > 0.5
    other = mask.copy()
    other[3, :7] ^= True
    assert different_bools(other, mask) == 7
    assert different_bools(other[1:], mask) == different_bools(other.astype(float), mask) == np.inf
    assert different_bools(other, mask) == 7 and different_bools(other.astype(int), mask) == np.inf


def test_the_head_of_the_exercises_cannot_be_changed():
    with pytest.raises(ValueError, match="read-only"):
        small_head().bone[0] = True
