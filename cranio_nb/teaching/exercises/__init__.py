"""The exercises, a module for each lesson: the cases each is tried on, the answer, how two answers are compared."""

from . import (
    ct,
    deformable_model,
    evaluation,
    feature_extraction,
    paper_tables,
    prosthesis_volume,
    rivals,
    segmentation,
    surface_reconstruction,
    three_d,
    tour,
    tuning_lab,
)
from .task import Exercise

_LESSONS = (
    tour,
    ct,
    segmentation,
    feature_extraction,
    deformable_model,
    prosthesis_volume,
    surface_reconstruction,
    evaluation,
    rivals,
    three_d,
    paper_tables,
    tuning_lab,
)

EXERCISES: dict[str, Exercise] = {number: task for lesson in _LESSONS for number, task in lesson.EXERCISES.items()}
"""By number, lesson by lesson."""

LESSONS = tuple(f"{at:02d}_{lesson.__name__.rpartition('.')[2]}" for at, lesson in enumerate(_LESSONS))
"""Names of the lessons, which are those of their notebooks."""

__all__ = ["EXERCISES", "LESSONS", "Exercise"]
