"""The exercises of the lessons: the cases each is tried on, the answer, how answers are compared, typical mistakes."""

from .curves import CURVES
from .image import IMAGE
from .measure import MEASURE
from .solid import SOLID
from .task import Exercise

EXERCISES: dict[str, Exercise] = {**IMAGE, **CURVES, **SOLID, **MEASURE}
"""By number, lesson by lesson."""

__all__ = ["EXERCISES", "Exercise"]
