"""Remarks on how the head lies and on the slices."""

import numpy as np
import pytest
from judged_openings import opening

from cranio_nb.vault.head_frame import HeadFrame
from cranio_nb.vault.remarks import opening_remarks, orientation_remarks, thickness_remarks


def frame(axes, confidence=1.0):
    return HeadFrame(np.zeros(3), np.asarray(axes, float), np.eye(3), confidence, 0.4, 2.0, "Reason.")


def test_a_head_as_its_scan_says_needs_no_word():
    assert orientation_remarks(frame(np.eye(3))) == ()


@pytest.mark.parametrize(
    ("axes", "confidence", "code"),
    [
        (np.diag([1, -1, -1]), 1.0, "HeadUpsideDown"),
        ([[0, 0, -1], [0, 1, 0], [1, 0, 0]], 1.0, "HeadLiesAside"),
        (np.diag([-1, -1, 1]), 1.0, "FaceElsewhere"),
        (np.eye(3), 0.2, "HeadAxesUnsure"),
    ],
)
def test_what_disagrees_is_said(axes, confidence, code):
    (found,) = orientation_remarks(frame(axes, confidence))
    assert found.code == code


@pytest.mark.parametrize(("slice_mm", "n"), [(0.5, 0), (2.5, 0), (3.0, 1), (5.0, 1)])
def test_thick_slices_are_named(slice_mm, n):
    assert len(thickness_remarks(slice_mm)) == n


def test_what_is_left_open_in_doubt_or_closed_against_the_verdict_is_said():
    closed, left = (opening(1, "cut"), opening(2, "natural")), (opening(3, "doubtful"), opening(4, "natural"))
    doubtful, chosen = opening_remarks(closed, left)
    assert (doubtful.code, doubtful.severity) == ("DoubtfulOpening", "warning")
    assert "opening 3" in doubtful.message and "--opening 3" in doubtful.message
    assert "confidence 0.40" in doubtful.message and "It is in doubt." in doubtful.message
    assert doubtful.values["number"] == 3 and doubtful.values["place"] == "left"
    assert (chosen.code, chosen.severity) == ("ChosenOpening", "warning") and "opening 2" in chosen.message
    (cut,) = opening_remarks(closed[1:1], (opening(5, "cut"),))
    assert (cut.code, cut.severity) == ("CutLeftOpen", "info") and "opening 5" in cut.message


def test_closing_near_the_edge_of_the_image_is_a_warning():
    far, near = opening(1, "cut"), opening(2, "cut", room_mm=0.5)
    (said,) = opening_remarks((far, near), ())
    assert said.code == "OpeningAtEdge" and said.severity == "warning" and said.values["number"] == 2
