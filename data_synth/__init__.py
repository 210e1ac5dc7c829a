"""Synthetic heads and virtual craniectomies with known truth.

It shares no code with the package it tests. `python -m data_synth --help` writes cases to disk.
"""

from .case import Case
from .cut import cut_case
from .defect import DEFECTS, DefectSpec
from .face import AROUND, Landmarks, Pose, face_case
from .head import HeadShape
from .heads import HEADS, head_case
from .phantom import SIZES, leaning, phantom_case, scan
from .series import ORIENTATIONS, SYNTAXES, write_dicom
from .truth import Gap, SliceTruth

__all__ = [
    "AROUND",
    "DEFECTS",
    "HEADS",
    "ORIENTATIONS",
    "SIZES",
    "SYNTAXES",
    "Case",
    "DefectSpec",
    "Gap",
    "HeadShape",
    "Landmarks",
    "Pose",
    "SliceTruth",
    "cut_case",
    "face_case",
    "head_case",
    "leaning",
    "phantom_case",
    "scan",
    "write_dicom",
]
