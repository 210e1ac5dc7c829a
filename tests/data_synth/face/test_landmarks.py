"""Landmarks: they move with the pose, and they lie where the picture shows them."""

import numpy as np
import pytest

from data_synth import Pose, face_case

POSES = [Pose(), Pose(25, -30, 70), Pose(nod_deg=180), Pose(roll_deg=90)]


def pick(case, field, point):
    index = np.linalg.solve(case.affine[:3, :3], point - case.affine[:3, 3]).round().astype(int)
    return field[tuple(index)]


@pytest.fixture(scope="module", params=POSES, ids=str)
def case(request):
    return face_case("tiny", 3, pose=request.param, reach="neck", noise=0.0)


def test_axes_are_the_poses(case):
    turn = Pose(**case.parameters["pose"]).rotation()
    marks = case.landmarks
    np.testing.assert_allclose(np.column_stack([marks.left, -marks.face, marks.up]), turn, atol=1e-12)


@pytest.fixture(scope="module")
def still():
    return face_case("tiny", 3, slice_mm=5.0).landmarks


def test_points_move_rigidly(case, still):
    turn = Pose(**case.parameters["pose"]).rotation()
    for name in ("top", "nasion", "chin", "foramen_magnum", "orbit_left", "ear_right", "mastoid_left"):
        moved = case.landmarks.centre + turn @ (getattr(still, name) - still.centre)
        np.testing.assert_allclose(getattr(case.landmarks, name), moved, atol=1e-9)


def test_the_picture_shows_them(case):
    marks = case.landmarks
    assert pick(case, case.bone, marks.top - 3 * marks.up)
    assert not pick(case, case.bone, marks.top + 3 * marks.up)
    assert pick(case, case.bone, marks.mastoid_left + 2.5 * marks.up)
    if case.parameters["pose"]["roll_deg"] != 90:  # there the image ends beside the head
        assert pick(case, case.bone, marks.chin)
    for point in (marks.foramen_magnum, marks.orbit_left, marks.orbit_right):
        assert not pick(case, case.bone, point)
    assert pick(case, case.hu, marks.top + 10 * marks.up) == -1000


def test_left_is_left(case):
    marks = case.landmarks
    for name in ("orbit", "ear", "mastoid"):
        across = getattr(marks, f"{name}_left") - getattr(marks, f"{name}_right")
        assert across @ marks.left == pytest.approx(np.linalg.norm(across)) and across @ marks.left > 60


def test_they_can_be_written_down(case):
    record = case.landmarks.as_dict()
    assert record["top"] == case.landmarks.top.tolist()
    assert all(len(value) == 3 for value in record.values())
