"""Openings with a verdict, without a skull."""

import numpy as np

from cranio_nb.opening import Opening
from cranio_nb.vault.opening_choice import JudgedOpening
from cranio_nb.vault.verdict import Verdict
from cranio_nb.volume import Volume

VERDICTS = {
    "cut": Verdict(False, 0.9, "It is plain."),
    "doubtful": Verdict(False, 0.4, "It is in doubt."),
    "natural": Verdict(True, 0.9, "It is an orbit."),
}


def opening(number, kind, room_mm=20.0):
    """A small sheet at the left of a head's centre."""
    sheet = np.zeros((12, 12, 12), bool)
    sheet[4:8, 3:9, 10] = True
    mm = np.array([[0, 0, 1, 0], [0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1.0]])
    return JudgedOpening(number, Opening(Volume(sheet, mm), np.array([1.0, 5.5, 5.5])), VERDICTS[kind], room_mm)
