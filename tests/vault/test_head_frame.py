"""How heads lie, against heads with a face whose axes are known."""

from functools import cache

import numpy as np
import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.stages.segmentation import segment
from cranio_nb.vault.head_frame import SURE, find_head_frame, head_or_grid_axes
from cranio_nb.vault.orientation import head_axes
from cranio_nb.volume import Volume
from data_synth import Pose, face_case, phantom_case

POSES = {
    "straight": Pose(),
    "nodded": Pose(nod_deg=30),
    "chin up": Pose(nod_deg=-30),
    "rolled": Pose(roll_deg=30),
    "turned": Pose(turn_deg=135),
    "on the side": Pose(roll_deg=90),
    "upside down": Pose(nod_deg=180),
    "all at once": Pose(20, -25, 70),
}


@cache
def case(pose, holes=0):
    return face_case("tiny", 3, holes=holes, pose=POSES[pose])


def apart(a, b):
    """Degrees between two unit vectors."""
    return np.degrees(np.arccos(np.clip(a @ b, -1, 1)))


@pytest.mark.parametrize(("pose", "holes"), [*((pose, 0) for pose in POSES), ("all at once", 2)])
def test_top_face_and_left_are_found_however_the_head_lies(pose, holes):
    one = case(pose, holes)
    frame = find_head_frame(segment(Volume(one.hu, one.affine)))
    assert frame.confidence >= SURE
    assert apart(frame.axes[2], one.landmarks.up) < 20
    assert apart(-frame.axes[1], one.landmarks.face) < 20
    assert apart(frame.axes[0], one.landmarks.left) < 6
    np.testing.assert_allclose(frame.axes @ frame.axes.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(frame.axes) > 0


def test_the_header_turns_the_frame_along_and_changes_nothing_else():
    one = case("straight")
    bone = segment(Volume(one.hu, one.affine))
    turn = np.eye(4)
    turn[:3, :3] = POSES["all at once"].rotation()
    there = find_head_frame(Volume(bone.voxels, turn @ bone.affine))
    here = find_head_frame(bone)
    np.testing.assert_allclose(there.axes, here.axes @ turn[:3, :3].T, atol=1e-6)
    np.testing.assert_allclose(there.centre, turn[:3, :3] @ here.centre, atol=1e-5)
    assert there.confidence == pytest.approx(here.confidence)


def test_a_dome_without_a_face_keeps_the_axes_of_its_scan():
    one = phantom_case("tiny", "unilateral", 0)
    bone = Volume(one.bone, one.affine)
    frame = find_head_frame(bone)
    assert frame.confidence == 0
    np.testing.assert_array_equal(frame.trusted_axes, head_axes(bone))


def test_a_dome_whose_base_is_at_the_end_called_top_is_turned_over():
    one = phantom_case("tiny", "unilateral", 0)
    frame = find_head_frame(Volume(one.bone[::-1].copy(), one.affine))
    assert frame.tilt_deg == pytest.approx(180)
    assert frame.confidence >= SURE


def test_without_a_cavity_there_is_no_frame():
    slab = Volume(np.ones((20, 20, 20), bool), np.diag([3.0, 3, 3, 1]))
    with pytest.raises(InputRefused):
        find_head_frame(slab)
    np.testing.assert_array_equal(head_or_grid_axes(slab), head_axes(slab))
