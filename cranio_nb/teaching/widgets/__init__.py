"""The stages under sliders: one panel for each, with a picture that follows and a static twin of it.

In a live notebook a panel has controls; anywhere else, and when ``CRANIO_NB_MODE`` says static, it is one picture
with alternative text and one line of text that is the same on every run. Lengths on controls are in mm, angles in
degrees, attenuation in HU; the balloon's own frame is px, as in the paper.
"""

from ...drawing.front_end import mode
from .controls import View
from .ct import ct_viewer
from .deformable_model import balloon
from .evaluation import distances
from .feature_extraction import features
from .panel import Panel
from .prosthesis_volume import patch
from .rivals import guiding_points, symmetry_plane
from .segmentation import threshold
from .surface_reconstruction import surface
from .three_d import bent_plate, elastic_sheet
from .tuning import Tuner, tuner

__all__ = [
    "Panel",
    "Tuner",
    "View",
    "balloon",
    "bent_plate",
    "ct_viewer",
    "distances",
    "elastic_sheet",
    "features",
    "guiding_points",
    "mode",
    "patch",
    "surface",
    "symmetry_plane",
    "threshold",
    "tuner",
]
