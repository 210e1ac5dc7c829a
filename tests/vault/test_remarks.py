"""Remarks on how the head lies and on the slices."""

import numpy as np
import pytest

from cranio_nb.vault.head_frame import HeadFrame
from cranio_nb.vault.remarks import orientation_remarks, thickness_remarks


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
