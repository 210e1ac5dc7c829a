"""Drawn diagrams of the lessons: each is computed from what the lesson works on, so it is as right as the code.

All are 8 inches wide and speak one language: colours and sizes of `drawing.palette`, marks as `legend` shows them.
"""

from .chord import Gap, chord_at_rest, chord_frame
from .fans import slice_fans
from .forces import snaxel_forces
from .legend import legend
from .pipeline import pipeline
from .plate import plate_map
from .rays import ray_fan
from .sets import boundary_sets

__all__ = [
    "Gap",
    "boundary_sets",
    "chord_at_rest",
    "chord_frame",
    "legend",
    "pipeline",
    "plate_map",
    "ray_fan",
    "slice_fans",
    "snaxel_forces",
]
