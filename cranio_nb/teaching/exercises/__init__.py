"""The exercises of the lessons: the cases each is tried on, the answer, how answers are compared, typical mistakes."""

from .curves import CURVES
from .image import IMAGE
from .measure import MEASURE
from .plates import PLATES
from .rivals import RIVALS
from .solid import SOLID
from .task import Exercise

_ALL = {**IMAGE, **CURVES, **SOLID, **MEASURE, **RIVALS, **PLATES}
EXERCISES: dict[str, Exercise] = dict(sorted(_ALL.items(), key=lambda pair: [int(n) for n in pair[0].split(".")]))
"""By number, lesson by lesson."""

__all__ = ["EXERCISES", "Exercise"]
