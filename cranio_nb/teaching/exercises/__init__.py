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
)

EXERCISES: dict[str, Exercise] = {number: task for lesson in _LESSONS for number, task in lesson.EXERCISES.items()}
"""By number, lesson by lesson."""

__all__ = ["EXERCISES", "Exercise"]
