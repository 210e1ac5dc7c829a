"""Poses: rotations with known images, in a known order."""

import numpy as np
import pytest

from data_synth.face.pose import Pose, rigid

FACE, LEFT, UP = np.array([0.0, -1, 0]), np.array([1.0, 0, 0]), np.array([0.0, 0, 1])


@pytest.mark.parametrize(
    ("pose", "vector", "image"),
    [
        (Pose(nod_deg=90), UP, FACE),  # the top comes to the front
        (Pose(nod_deg=90), FACE, -UP),  # the face looks down
        (Pose(roll_deg=90), UP, LEFT),
        (Pose(turn_deg=90), FACE, LEFT),
        (Pose(nod_deg=180), UP, -UP),
        (Pose(nod_deg=90, turn_deg=90), UP, LEFT),  # first nodded, then turned
        (Pose(roll_deg=90, turn_deg=90), UP, -FACE),
    ],
)
def test_axes_go_where_the_words_say(pose, vector, image):
    np.testing.assert_allclose(pose.rotation() @ vector, image, atol=1e-12)


def test_rotations_keep_lengths_and_hands():
    turn = Pose(17.0, -40.0, 250.0).rotation()
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(turn) == pytest.approx(1)


def test_a_rigid_motion_leaves_its_centre():
    centre = np.array([3.0, -20.0, 100.0])
    matrix = rigid(Pose(10, 20, 30).rotation(), centre)
    np.testing.assert_allclose(matrix @ [*centre, 1], [*centre, 1], atol=1e-12)
    np.testing.assert_allclose(matrix[:3, :3], Pose(10, 20, 30).rotation())
