"""The paper's ten figures, with all their parts, drawn from what the pipeline computed on any head.

Each function has the number of the figure; what the paper shows in it is the first line of its description.
"""

from .balloons import figure_4, figure_5
from .bone import figure_1, figure_2, figure_3
from .patches import figure_6, figure_7
from .surfaces import DistanceMap, figure_8, figure_9, figure_10

__all__ = [
    "DistanceMap",
    "figure_1",
    "figure_2",
    "figure_3",
    "figure_4",
    "figure_5",
    "figure_6",
    "figure_7",
    "figure_8",
    "figure_9",
    "figure_10",
]
