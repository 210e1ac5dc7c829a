"""A head with a face: skull base, face, jaw, neck and soft parts about a closed-form braincase."""

from .devices import AROUND
from .faced import face_case
from .landmarks import Landmarks
from .pose import Pose

__all__ = ["AROUND", "Landmarks", "Pose", "face_case"]
