"""The stages under sliders: one panel for each, with a picture that follows and a static twin of it.

In a live notebook a panel has controls; anywhere else, and when ``CRANIO_NB_MODE`` says static, it is one picture
with alternative text and one line of text that is the same on every run. Lengths on controls are in mm, angles in
degrees, attenuation in HU; the balloon's own frame is px, as in the paper.
"""

from ...drawing.front_end import mode
from .bone import ct_viewer, threshold
from .controls import View
from .gap import features
from .inflation import balloon
from .panel import Panel
from .plates import bent_plate, elastic_sheet
from .rivals import guiding_points, symmetry_plane
from .solid import evaluation, surface
from .stack import patch
from .tuning import Tuner, tuner

__all__ = [
    "Panel",
    "Tuner",
    "View",
    "balloon",
    "bent_plate",
    "ct_viewer",
    "elastic_sheet",
    "evaluation",
    "features",
    "guiding_points",
    "mode",
    "patch",
    "surface",
    "symmetry_plane",
    "threshold",
    "tuner",
]
